#include "client_renderer/occlusion_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

ConvexSolid box_solid(const scene::Bounds& box) {
    ConvexSolid solid;
    for (int side = 0; side < 6; ++side) {
        glm::dvec3 normal{0.0};
        const bool upper = side % 2 == 1;
        normal[side / 2] = upper ? 1.0 : -1.0;
        solid.planes_world[static_cast<std::size_t>(side)] = {normal, upper ? box.max[side / 2] : -box.min[side / 2]};
    }
    return solid;
}

scene::Bounds box_at(const glm::dvec3& centre, const glm::dvec3& half_size) {
    return {centre - half_size, centre + half_size};
}

bool is_hidden(const OcclusionBuffer& buffer, const scene::Bounds& box) {
    BoxList boxes;
    boxes.resize(1);
    boxes.set(0, box);
    std::vector<std::uint32_t> seen;
    const std::uint32_t first = 0;
    const OcclusionBuffer::Split split = buffer.split(boxes, {&first, 1}, seen);
    EXPECT_EQ(seen.size() + split.hidden + split.between_samples, 1U);
    // One box at a time does not tell what falls between the samples.
    const bool hidden = buffer.hides(glm::vec3{box.min}, glm::vec3{box.max});
    EXPECT_TRUE(split.between_samples > 0 || hidden == (split.hidden == 1));
    return split.hidden == 1;
}

TEST(OcclusionBuffer, HidesWhatIsBehindAWall) {
    OcclusionBuffer buffer;
    buffer.begin(test::plain_camera({1024, 1024}));
    buffer.add(box_solid(box_at({0.0, 0.0, -5.5}, {2.0, 2.0, 0.5})));
    EXPECT_TRUE(is_hidden(buffer, box_at({0.0, 0.0, -10.0}, {3.5, 3.5, 1.0})));
    EXPECT_TRUE(is_hidden(buffer, box_at({0.0, 0.0, -5.5}, {1.0, 1.0, 0.4}))) << "inside the wall";
    EXPECT_FALSE(is_hidden(buffer, box_at({0.0, 0.0, -10.0}, {4.5, 1.0, 1.0}))) << "it looks out at both sides";
    EXPECT_FALSE(is_hidden(buffer, box_at({0.0, 0.0, -4.0}, {1.0, 1.0, 0.9}))) << "in front";
    EXPECT_FALSE(is_hidden(buffer, box_at({0.0, 0.0, -5.5}, {1.0, 1.0, 0.6}))) << "it looks out of the wall";
    EXPECT_FALSE(is_hidden(buffer, box_at({0.0, 0.0, 5.0}, {1.0, 1.0, 1.0}))) << "behind the eye";
    EXPECT_FALSE(is_hidden(buffer, box_at({0.0, 0.0, 0.0}, {9.0, 9.0, 9.0}))) << "around the eye";
}

TEST(OcclusionBuffer, PartsOfAPixelAddUp) {
    // The picture has 4 x 4 pixels per pixel of the buffer; at 10 m a pixel of the buffer is 10 / 128 m wide.
    const double pixel_m = 10.0 / 128.0;
    const auto wall = [&](double from_px, double to_px) {
        return scene::Bounds{{from_px * pixel_m, -1.0, -10.5}, {to_px * pixel_m, 1.0, -10.0}};
    };
    const auto behind = [&](double from_px, double to_px) {
        const double far = 2.0 * pixel_m;  // at 20 m
        return scene::Bounds{{from_px * far, -0.5, -20.5}, {to_px * far, 0.5, -20.0}};
    };
    OcclusionBuffer buffer;
    buffer.begin(test::plain_camera({1024, 1024}));
    buffer.add(box_solid(wall(0.1, 3.6)), wall(0.1, 3.6));
    EXPECT_TRUE(is_hidden(buffer, behind(0.6, 3.2))) << "two parts of the last pixel are covered";
    EXPECT_FALSE(is_hidden(buffer, behind(0.6, 3.7)));
    buffer.add(box_solid(wall(3.45, 5.0)), wall(3.45, 5.0));
    EXPECT_TRUE(is_hidden(buffer, behind(0.6, 4.4))) << "the pixel is covered by both together";
}

TEST(OcclusionBuffer, TellsWhatFallsBetweenTheSamples) {
    OcclusionBuffer buffer;
    buffer.begin(test::plain_camera({1024, 1024}));
    const double pixel_m = 10.0 / 512.0;  // of the picture, at 10 m
    BoxList boxes;
    boxes.resize(4);
    const auto upright = [&](double from_px, double to_px) {
        return scene::Bounds{{from_px * pixel_m, -1.0, -10.001}, {to_px * pixel_m, 1.0, -10.0}};
    };
    boxes.set(0, upright(3.6, 4.4));   // between the samples at 3.5 and 4.5
    boxes.set(1, upright(3.6, 4.49));  // so close that snapping may reach one
    boxes.set(2, upright(3.4, 3.6));
    boxes.set(3, {{-1e-3, -1.0, -0.1}, {1e-3, 1.0, 0.1}});  // around the eye
    const std::array<std::uint32_t, 4> all{0, 1, 2, 3};
    std::vector<std::uint32_t> seen;
    EXPECT_EQ(buffer.split(boxes, all, seen).between_samples, 1U);
    EXPECT_EQ(seen, (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(OcclusionBuffer, SolidsThatReachBehindTheEyeHide) {
    OcclusionBuffer buffer;
    buffer.begin(test::plain_camera({1024, 1024}));
    buffer.add(box_solid(box_at({6.0, 0.0, 0.0}, {5.0, 40.0, 50.0})));  // a wall along the street, from x = 1 on
    EXPECT_TRUE(is_hidden(buffer, box_at({14.0, 0.0, -20.0}, {1.0, 1.0, 1.0})));
    EXPECT_FALSE(is_hidden(buffer, box_at({-1.0, 0.0, -20.0}, {1.0, 1.0, 1.0})));
    EXPECT_FALSE(is_hidden(buffer, box_at({0.9, 0.0, -20.0}, {0.05, 1.0, 1.0})));
}

/// Independent of the buffer's arithmetic: does the segment from the eye to the point pass through the box?
bool segment_meets(const glm::dvec3& eye, const glm::dvec3& point, const scene::Bounds& box) {
    double enter = 0.0;
    double leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = point[axis] - eye[axis];
        if (std::abs(d) < 1e-12) {
            if (eye[axis] < box.min[axis] || eye[axis] > box.max[axis]) return false;
            continue;
        }
        double a = (box.min[axis] - eye[axis]) / d;
        double b = (box.max[axis] - eye[axis]) / d;
        if (a > b) std::swap(a, b);
        enter = std::max(enter, a);
        leave = std::min(leave, b);
    }
    return enter <= leave;
}

TEST(OcclusionBuffer, NeverHidesAPointThatASegmentReaches) {
    std::mt19937 random{11};
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    std::uint64_t hidden_count = 0;
    for (int round = 0; round < 60; ++round) {
        Camera camera = test::plain_camera({round % 2 == 0 ? 1024 : 300, 512});
        camera.world_from_eye.position_m = {unit(random), unit(random), unit(random)};
        camera.world_from_eye.orientation =
            glm::normalize(glm::dquat{unit(random), unit(random), unit(random), unit(random)});
        const glm::dvec3 eye = camera.world_from_eye.position_m;
        std::vector<scene::Bounds> walls;
        OcclusionBuffer buffer;
        buffer.begin(camera);
        for (int i = 0; i < 12; ++i) {
            const scene::Bounds wall =
                box_at(glm::dvec3{unit(random), unit(random), unit(random)} * 8.0,
                       glm::dvec3{1.1 + unit(random), 1.1 + unit(random), 1.1 + unit(random)} * 1.5);
            walls.push_back(wall);
            buffer.add(box_solid(wall), wall);
        }
        for (int i = 0; i < 400; ++i) {
            const scene::Bounds box = box_at(glm::dvec3{unit(random), unit(random), unit(random)} * 25.0,
                                             glm::dvec3{0.6 + 0.5 * unit(random)});
            if (!is_hidden(buffer, box)) continue;
            ++hidden_count;
            for (unsigned corner = 0; corner < 27; ++corner) {
                const glm::dvec3 place{corner % 3 * 0.5, corner / 3 % 3 * 0.5, corner / 9 * 0.5};
                const glm::dvec3 point = glm::mix(box.min, box.max, place);
                const glm::dvec3 in_eye = glm::inverse(camera.world_from_eye.orientation) * (point - eye);
                const double distance = -in_eye.z;
                if (in_eye.x < camera.fov.left * distance || in_eye.x > camera.fov.right * distance ||
                    std::abs(in_eye.y) > distance) {
                    continue;  // not in the picture
                }
                bool met = false;
                for (const scene::Bounds& wall : walls) met = met || segment_meets(eye, point, wall);
                ASSERT_TRUE(met) << "round " << round << " box " << i << " corner " << corner;
            }
        }
    }
    EXPECT_GT(hidden_count, 100U) << "too little was hidden to show anything";
}

}  // namespace
}  // namespace lw
