/// The ladder for the methods that run on GL: identity, the double-precision kernel, reference, bad pixels, textures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/reprojection.h"
#include "gl/program.h"
#include "shaders/warp_blocks.h"
#include "tests/support/gl_test.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

std::string test_name_of(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

class ParametrisedGlTest : public GlTest, public ::testing::WithParamInterface<std::string> {};

/// Methods that return a still source bit for bit.
class GlExactMethod : public ParametrisedGlTest {};
/// Every GL method.
class GlMethod : public ParametrisedGlTest {};

// "Gl" first: the label of a case goes by the beginning of its name.
INSTANTIATE_TEST_SUITE_P(Gl, GlExactMethod, ::testing::Values("points:size_px=1", "points:size_px=0", "compute"),
                         test_name_of);
INSTANTIATE_TEST_SUITE_P(Gl, GlMethod,
                         ::testing::Values("points:size_px=1", "points:size_px=0", "points", "mesh", "compute",
                                           "inverse-gl", "surface-gl"),
                         test_name_of);

DisplayFrame warped(const std::string& method, const Layer& layer, const WarpTarget& target) {
    return warp_once(method, layer, target);
}

TEST_P(GlExactMethod, ZeroMotionReturnsTheSourceBitForBit) {
    const AnalyticScene scene = AnalyticScene::street();
    Camera camera = moved(street_camera({96, 64}), {0.3, 0.1, -0.2}, 12.0, -5.0, 2.0);
    camera.fov = {-1.1, 0.9, -0.6, 0.7};
    const Layer layer = scene.draw(camera, 0.25);
    const DisplayFrame frame = warped(GetParam(), layer, {camera, layer.movers});
    EXPECT_TRUE(shows_source_exactly("gl-identity-" + GetParam(), frame, layer.cpu()));
}

TEST_P(GlExactMethod, ZeroMotionHoldsForEverySize) {
    for (const glm::ivec2& size_px : {glm::ivec2{1, 1}, glm::ivec2{3, 5}, glm::ivec2{17, 2}, glm::ivec2{1024, 16}}) {
        const Camera camera = street_camera(size_px);
        const Layer layer = noise_layer(camera);
        const DisplayFrame frame = warped(GetParam(), layer, {camera, {}});
        EXPECT_TRUE(shows_source_exactly("gl-sizes", frame, layer.cpu())) << size_px.x << "x" << size_px.y;
    }
}

TEST_P(GlMethod, AMethodCanBeUsedAgainWithOtherSizes) {
    const auto method = method_named(GetParam());
    DisplayFrame frame;
    for (const glm::ivec2& size_px : {glm::ivec2{40, 30}, glm::ivec2{8, 8}, glm::ivec2{64, 16}}) {
        const Camera camera = street_camera(size_px);
        method->warp(noise_layer(camera), {camera, {}}, frame);
        EXPECT_EQ(frame.colour.size_px(), size_px);
        EXPECT_THAT(frame.coverage.pixels(), ::testing::Each(Coverage::reached));
    }
}

TEST_P(GlMethod, DepthOfAPlaneIsThatOfTheTarget) {
    const AnalyticScene scene = AnalyticScene::wall(3.0, 0.3);
    const Camera source = street_camera({96, 96});
    const Camera target = moved(source, {0.1, 0.05, -0.2}, 2.0, 1.0);
    const DisplayFrame frame = warped(GetParam(), scene.draw(source, 0.0), {target, {}});
    const DepthImage truth = scene.truth_depth(target, 0.0);
    for (std::size_t i = 0; i < truth.pixels().size(); ++i) {
        if (frame.coverage.pixels()[i] != Coverage::reached) continue;
        // A place off by up to 1 px (a point of 2 px) on a plane whose depth changes by 0.7 % per pixel at most.
        ASSERT_NEAR(frame.depth.pixels()[i], truth.pixels()[i], 0.01 * truth.pixels()[i]) << i;
    }
}

TEST_P(GlMethod, TheBackgroundTurnsAndNeverMoves) {
    const AnalyticScene sky;
    const Camera camera = street_camera({48, 48});
    const Layer layer = sky.draw(camera, 0.0);
    const DisplayFrame frame = warped(GetParam(), layer, {moved(camera, {3.0, 1.0, -5.0}, 0.0), {}});
    // Points of 2 px show a neighbour's colour: the sky changes by at most 6 levels per pixel here.
    EXPECT_TRUE(images_agree("gl-sky", frame.colour, layer.cpu().colour, GetParam() == "points" ? 6 : 0));
    EXPECT_THAT(frame.depth.pixels(), ::testing::Each(0.0F));
}

TEST_P(GlMethod, SamplesNearerThanTheNearPlaneAreSkipped) {
    const Camera source = street_camera({32, 32});
    const Layer layer = indexed_layer(source, 0.05F);  // a wall 1 m away; near is 5 cm
    const auto reached = [&](double forward_m) {
        const DisplayFrame frame = warped(GetParam(), layer, {moved(source, {0.0, 0.0, -forward_m}, 0.0), {}});
        return std::count(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::reached);
    };
    EXPECT_GT(reached(0.3), 0);
    // A fixed-point search does not converge under more than twofold magnification.
    if (GetParam() != "inverse-gl") {
        EXPECT_GT(reached(0.94), 0);
    }
    EXPECT_EQ(reached(0.96), 0);
    EXPECT_EQ(reached(1.5), 0);  // behind the eye
}

TEST_P(GlMethod, BadPixelsAreCountedAndSkipped) {
    const Camera camera = street_camera({16, 16});
    Layer layer = indexed_layer(camera, 0.05F);
    layer.movers = {{3, glm::dmat4{1.0}}, {5, glm::dmat4{0.0}}};  // 5 has no inverse: no usable placement
    layer.cpu().depth.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
    layer.cpu().depth.at(2, 1) = std::numeric_limits<float>::infinity();
    layer.cpu().depth.at(3, 1) = -0.01F;
    layer.cpu().depth.at(4, 1) = 1.01F;
    layer.cpu().object_id.at(5, 1) = 4;
    layer.cpu().object_id.at(6, 1) = 5;
    layer.cpu().object_id.at(7, 1) = 65535;
    layer.cpu().object_id.at(8, 1) = 3;
    const auto method = method_named(GetParam());
    DisplayFrame frame;
    for (int repeat = 0; repeat < 2; ++repeat) {  // counters are those of the last warp, not a sum
        method->warp(layer, {camera, {}}, frame);
        EXPECT_EQ(method->counters().bad_depth, 4U);
        EXPECT_EQ(method->counters().unknown_object, 3U);
    }
    EXPECT_EQ(frame.coverage.at(8, 1), Coverage::reached);
}

TEST_P(GlMethod, NothingInViewLeavesHoles) {
    const Camera source = street_camera({64, 64});
    const Layer layer = AnalyticScene::street().draw(source, 0.0);
    const DisplayFrame frame = warped(GetParam(), layer, {moved(source, {0.0, 0.0, 0.0}, 180.0), {}});
    EXPECT_THAT(frame.coverage.pixels(), ::testing::Each(Coverage::hole));
}

TEST_P(GlMethod, TexturesGiveTheSamePictureAsCpuPixels) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({80, 60});
    const Camera target = moved(source, {0.05, 0.0, -0.1}, 2.0);
    Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.05);
    const DisplayFrame from_cpu = warped(GetParam(), layer, {target, movers});

    TexturePixels textures{gl::Texture{source.size_px, GL_SRGB8_ALPHA8}, gl::Texture{source.size_px, GL_R32F},
                           gl::Texture{source.size_px, GL_R16UI}, gl::Fence{}};
    textures.colour.upload(GL_RGBA, GL_UNSIGNED_BYTE, layer.cpu().colour.pixels().data());
    textures.depth.upload(GL_RED, GL_FLOAT, layer.cpu().depth.pixels().data());
    textures.object_id.upload(GL_RED_INTEGER, GL_UNSIGNED_SHORT, layer.cpu().object_id.pixels().data());
    layer.pixels = std::move(textures);
    const DisplayFrame from_textures = warped(GetParam(), layer, {target, movers});
    EXPECT_EQ(from_textures.colour, from_cpu.colour);
    EXPECT_EQ(from_textures.depth, from_cpu.depth);
    EXPECT_EQ(from_textures.coverage, from_cpu.coverage);
}

// The plain double-precision model of `points`: every source pixel within half a point of a target pixel's centre may
// be what it shows, and the nearest of them is. Places are rounded to float and to the rasteriser's 1/256 px grid, so
// what lies within kSlackPx of a border may fall on either side.
class PointModel {
public:
    static constexpr double kSlackPx = 1.0 / 256.0 + 1e-3;

    PointModel(const Layer& layer, const WarpTarget& target, double size_px)
        : certain_(target.camera.size_px, -1.0F), possible_(target.camera.size_px, -1.0F) {
        ReprojectionTable table;
        table.build(layer.camera, target.camera, layer.movers, target.movers);
        for (int y = 0; y < layer.camera.size_px.y; ++y) {
            for (int x = 0; x < layer.camera.size_px.x; ++x) {
                const auto* matrix = table.find(layer.cpu().object_id.at(x, y));
                const auto placed = reproject(*matrix, {x + 0.5, y + 0.5}, layer.cpu().depth.at(x, y));
                if (!placed || placed->depth > 1.0) continue;
                cover(placed->position_px, placed->depth, 0.5 * size_px - kSlackPx, certain_);
                cover(placed->position_px, placed->depth, 0.5 * size_px + kSlackPx, possible_);
            }
        }
    }

    /// The pixel shows a depth between the nearest that must cover it and the nearest that can.
    [[nodiscard]] bool allows(int x, int y, Coverage coverage, float depth) const {
        if (coverage == Coverage::hole) return certain_.at(x, y) < 0.0F;
        constexpr float kRounding = 1e-5F;  // float, relative
        return depth <= possible_.at(x, y) * (1.0F + kRounding) && depth >= certain_.at(x, y) * (1.0F - kRounding);
    }

private:
    static void cover(const glm::dvec2& centre_px, double depth, double half_px, Image<float>& nearest) {
        const auto first = [](double from_px, int size) {
            return std::clamp(static_cast<int>(std::ceil(from_px - 0.5)), 0, size);
        };
        if (centre_px.x < 0.0 || centre_px.y < 0.0 || centre_px.x > nearest.width() || centre_px.y > nearest.height()) {
            return;  // GL drops a point whose centre is out of view
        }
        for (int y = first(centre_px.y - half_px, nearest.height()); y < first(centre_px.y + half_px, nearest.height());
             ++y) {
            for (int x = first(centre_px.x - half_px, nearest.width());
                 x < first(centre_px.x + half_px, nearest.width()); ++x) {
                nearest.at(x, y) = std::max(nearest.at(x, y), static_cast<float>(depth));
            }
        }
    }

    Image<float> certain_;
    Image<float> possible_;
};

class GlPointsModel : public GlTest, public ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Gl, GlPointsModel, ::testing::Values(1, 2, 3));

TEST_P(GlPointsModel, AgreesWithThePlainModel) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.06, 0.02, -0.05}, 3.0, -1.0, 1.0);
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    const WarpTarget warp_target{target, movers};
    const DisplayFrame frame = warped(fmt::format("points:size_px={}", GetParam()), layer, warp_target);
    const PointModel model{layer, warp_target, static_cast<double>(GetParam())};
    int wrong = 0;
    for (int y = 1; y + 1 < target.size_px.y; ++y) {  // borders: drivers differ in dropping points centred just outside
        for (int x = 1; x + 1 < target.size_px.x; ++x) {
            if (!model.allows(x, y, frame.coverage.at(x, y), frame.depth.at(x, y))) ++wrong;
        }
    }
    EXPECT_EQ(wrong, 0);
}

class GlMesh : public GlTest {};

TEST_F(GlMesh, ZeroMotionReturnsTheSource) {
    for (const glm::ivec2& size_px : {glm::ivec2{1, 1}, glm::ivec2{3, 5}, glm::ivec2{96, 64}, glm::ivec2{1024, 16}}) {
        const Camera camera = street_camera(size_px);
        const Layer layer = noise_layer(camera);
        const DisplayFrame frame = warped("mesh", layer, {camera, {}});
        EXPECT_EQ(frame.colour, layer.cpu().colour);
        EXPECT_THAT(frame.coverage.pixels(), ::testing::Each(Coverage::reached));
        for (std::size_t i = 0; i < frame.depth.pixels().size(); ++i) {
            // The rasteriser interpolates depth in float: slopes of up to 1 per pixel over 1024 px leave 1024 * 2^-24
            // for each of the two terms, and as much again for where they start.
            ASSERT_NEAR(frame.depth.pixels()[i], layer.cpu().depth.pixels()[i], 2.5e-4) << i;
        }
    }
}

TEST_F(GlMesh, APlaneIsSampledWhereItIs) {
    const AnalyticScene scene = AnalyticScene::wall(2.0, 0.1);
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.05, -0.03, -0.4}, 3.0, 1.0);
    const DisplayFrame frame = warped("mesh", scene.draw(source, 0.0), {target, {}});
    const ColourImage truth = scene.truth(target, 0.0, 1);
    // Bilinear between samples of waves of 0.5 m (20 px and more): the second difference is below 3 levels; drivers
    // filter with 8 bits of fraction: another level.
    EXPECT_TRUE(images_agree("gl-mesh-plane", frame.colour, truth, 4));
}

TEST_F(GlMesh, EdgesStretchIntoSheetsInsteadOfHoles) {
    Camera source = street_camera({64, 32});
    Layer layer = indexed_layer(source, 0.01F);
    for (int y = 0; y < 32; ++y) {
        for (int x = 24; x < 40; ++x) layer.cpu().depth.at(x, y) = 0.05F;
    }
    const DisplayFrame frame = warped("mesh", layer, {moved(source, {0.4, 0.0, 0.0}, 0.0), {}});
    // Only the strip of the wall that came into view on the right is missing: 1.3 px.
    for (int x = 0; x < 62; ++x) EXPECT_EQ(frame.coverage.at(x, 16), Coverage::reached) << x;
    EXPECT_EQ(frame.coverage.at(63, 16), Coverage::hole);
}

TEST_F(GlMesh, TrianglesOfABadPixelAreLeftOut) {
    const Camera camera = street_camera({16, 16});
    Layer layer = indexed_layer(camera, 0.05F);
    layer.cpu().depth.at(8, 8) = std::numeric_limits<float>::quiet_NaN();
    const DisplayFrame frame = warped("mesh", layer, {camera, {}});
    EXPECT_EQ(frame.coverage.at(8, 8), Coverage::hole);
    EXPECT_EQ(std::count(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::hole), 1);
}

class GlCompute : public GlTest {};

TEST_F(GlCompute, AgreesWithReference) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Camera target = moved(source, {0.06, 0.02, -0.05}, 3.0, -1.0, 1.0);
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    const DisplayFrame compute = warped("compute", layer, {target, movers});
    const DisplayFrame reference = warped("reference", layer, {target, movers});
    // Float places are off by up to 1e-4 px, and the key is cut to 32 bits: of 5e4 pixels about 100 lie that near to a
    // pixel's edge or to a step of the winner rule.
    EXPECT_TRUE(images_agree("gl-compute-reference", compute.colour, reference.colour, 0, 4e-3));
}

TEST_F(GlCompute, TwoRunsGiveTheSamePicture) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Camera target = moved(source, {0.2, 0.0, -0.3}, 5.0);
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame first = warped("compute", layer, {target, {}});
    const DisplayFrame second = warped("compute", layer, {target, {}});
    EXPECT_EQ(first.colour, second.colour);
    EXPECT_EQ(first.depth, second.depth);
}

class GlInverse : public GlTest {};

TEST_F(GlInverse, AgreesWithTheCpu) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Camera target = moved(source, {0.06, 0.02, -0.05}, 3.0, -1.0, 1.0);
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    for (const char* settings : {"", ":steps=1", ":steps=6"}) {
        const DisplayFrame gl = warped(std::string{"inverse-gl"} + settings, layer, {target, movers});
        const DisplayFrame cpu = warped(std::string{"inverse"} + settings, layer, {target, movers});
        // The same steps in float, in another order: a level by rounding, and pixels of edges where the search jumps
        // between two surfaces.
        EXPECT_TRUE(images_agree("gl-inverse-cpu", gl.colour, cpu.colour, 1, 5e-3)) << settings;
    }
}

class GlSurface : public GlTest {};

TEST_F(GlSurface, AgreesWithTheCpu) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    for (const Camera& target :
         {source, moved(source, {0.06, 0.02, -0.05}, 3.0, -1.0, 1.0), moved(source, {0.3, 0.0, -0.6}, 8.0)}) {
        const DisplayFrame gl = warped("surface-gl", layer, {target, movers});
        const DisplayFrame cpu = warped("surface", layer, {target, movers});
        // Filtering with 8 bits of fraction: two levels; and where a border between pieces passes a pixel's centre
        // within the rounding of its place, another piece may win.
        EXPECT_TRUE(images_agree("gl-surface-cpu", gl.colour, cpu.colour, 2, 5e-4));
        std::size_t differ = 0;
        for (std::size_t i = 0; i < gl.coverage.pixels().size(); ++i) {
            if (gl.coverage.pixels()[i] != cpu.coverage.pixels()[i]) ++differ;
        }
        EXPECT_LE(differ, gl.coverage.pixels().size() / 2000);
    }
}

TEST_F(GlSurface, TwoRunsGiveTheSamePicture) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Camera target = moved(source, {0.2, 0.0, -0.3}, 5.0);
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame first = warped("surface-gl", layer, {target, {}});
    const DisplayFrame second = warped("surface-gl", layer, {target, {}});
    EXPECT_EQ(first.colour, second.colour);
    EXPECT_EQ(first.depth, second.depth);
}

class GlPoints : public GlTest {};

TEST_F(GlPoints, AdaptiveSizeLeavesNoCracksUnderMagnification) {
    const AnalyticScene scene = AnalyticScene::wall(2.0, 0.4);
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.0, 0.0, -0.6}, 3.0);
    const Layer layer = scene.draw(source, 0.0);
    const auto holes = [&](const std::string& method) {
        const DisplayFrame frame = warped(method, layer, {target, {}});
        int count = 0;
        // Inside the picture: GL drops a point whose centre lies outside, also one that reaches in.
        for (int y = 1; y + 1 < frame.coverage.height(); ++y) {
            const auto row = frame.coverage.row(y);
            count += static_cast<int>(std::count(row.begin() + 1, row.end() - 1, Coverage::hole));
        }
        return count;
    };
    EXPECT_GT(holes("points:size_px=1"), 1000);
    EXPECT_EQ(holes("points:size_px=0"), 0);
}

TEST_F(GlPoints, AMoverLandsWhereItsOwnTransformLeads) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({192, 192});
    const double age_s = 0.05;
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(age_s);
    const DisplayFrame points = warped("points:size_px=0", layer, {source, movers});
    const DisplayFrame reference = warped("reference", layer, {source, movers});
    // Square points instead of fitted rectangles differ along edges and on slants.
    EXPECT_TRUE(images_agree("gl-points-movers", points.colour, reference.colour, 8, 0.05));
}

TEST_F(GlPoints, BlockLayoutIsTheSameInBothLanguages) {
    const auto program = gl::Program::create({"warp/points.vert", "warp/points.frag"});
    ASSERT_TRUE(program.ok()) << program.error().message();
    const auto property = [&](const char* variable, GLenum name) {
        const GLuint index = glGetProgramResourceIndex(program->id(), GL_BUFFER_VARIABLE, variable);
        EXPECT_NE(index, GL_INVALID_INDEX) << variable;
        GLint value = -1;
        glGetProgramResourceiv(program->id(), GL_BUFFER_VARIABLE, index, 1, &name, 1, nullptr, &value);
        return static_cast<std::size_t>(value);
    };
    EXPECT_EQ(property("objects[0].x", GL_OFFSET), offsetof(glsl::WarpObject, x));
    EXPECT_EQ(property("objects[0].y", GL_OFFSET), offsetof(glsl::WarpObject, y));
    EXPECT_EQ(property("objects[0].one", GL_OFFSET), offsetof(glsl::WarpObject, one));
    EXPECT_EQ(property("objects[0].z", GL_OFFSET), offsetof(glsl::WarpObject, z));
    EXPECT_EQ(property("objects[0].x", GL_TOP_LEVEL_ARRAY_STRIDE), sizeof(glsl::WarpObject));
}

TEST_F(GlPoints, RefusesSizesItCannotDraw) {
    for (const char* specification : {"points:size_px=0.5", "points:size_px=-1", "points:size_px=9"}) {
        EXPECT_FALSE(make_warp_method(specification).ok()) << specification;
    }
}

}  // namespace
}  // namespace lw::test
