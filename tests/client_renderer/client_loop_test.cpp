#include "client_renderer/client_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace lw {
namespace {

/// A renderer without GL that takes a given time of a virtual clock and notes what it was asked for.
class FakeRenderer final : public SceneRenderer {
public:
    FakeRenderer(VirtualClock& clock, Duration cost) : clock_{clock}, cost_{cost} {}

    void draw(const Camera& camera, double scene_time_s, CpuPixels& pixels) override {
        cameras.push_back(camera);
        times_s.push_back(scene_time_s);
        pixels.colour.resize(camera.size_px);
        pixels.depth.resize(camera.size_px);
        pixels.object_id.resize(camera.size_px);
        clock_.advance(cost_);
        if (on_draw) on_draw();
    }
    void draw_resolved(const Camera& camera, double scene_time_s, int samples_per_axis, CpuPixels& pixels) override {
        samples.push_back(samples_per_axis);
        draw(camera, scene_time_s, pixels);
    }
    std::uint64_t draw_part(const Camera& camera, double scene_time_s, int samples_per_axis, const ScenePart& part,
                            CpuPixels& pixels) override {
        parts.push_back(part);
        draw_resolved(camera, scene_time_s, samples_per_axis, pixels);
        return 0;
    }
    TexturePixels draw_to_textures(const Camera& /*camera*/, double /*scene_time_s*/,
                                   int /*samples_per_axis*/) override {
        return {};
    }
    void draw_supersampled(const Camera& /*camera*/, double /*scene_time_s*/, int /*samples_per_axis*/,
                           ColourImage& /*colour*/) override {}
    void mover_placements(double scene_time_s, std::vector<ObjectTransform>& transforms) override {
        transforms = {{1, glm::dmat4{scene_time_s}}};
    }
    [[nodiscard]] const DrawCounters& counters() const override { return counters_; }

    std::vector<Camera> cameras;
    std::vector<double> times_s;
    std::vector<int> samples;
    std::vector<ScenePart> parts;
    std::function<void()> on_draw;

private:
    VirtualClock& clock_;
    Duration cost_;
    DrawCounters counters_{7, 5, 3, 1};
};

/// A head that moves along x at 1 m/s, sampled every millisecond.
class SteadyHead final : public ForeseeingHeadPoseFeed {
public:
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        const auto newest = now.time_since_epoch() / std::chrono::milliseconds{1};
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const TimePoint time{std::chrono::milliseconds{newest - static_cast<std::int64_t>(i)}};
            samples[i] = {time, pose_at(time), static_cast<std::uint64_t>(newest) + 1 - i};
        }
        return samples.size();
    }
    [[nodiscard]] Pose pose_at(TimePoint time) const override {
        return {{seconds_of(time), 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    }
};

class ClientLoopTest : public testing::Test {
protected:
    ClientLoopTest() { clock_.advance(from_seconds(10.0)); }

    std::unique_ptr<ClientLoop> make(ClientSettings settings, const char* predictor = "oracle",
                                     PrepareLayer prepare = {}) {
        settings.camera.size_px = {8, 4};
        auto made = make_predictor(predictor);
        EXPECT_TRUE(made.ok());
        return std::make_unique<ClientLoop>(renderer_, clock_, head_, exchange_, std::move(*made), std::move(prepare),
                                            settings);
    }

    VirtualClock clock_;
    FakeRenderer renderer_{clock_, from_ms(80.0)};
    SteadyHead head_;
    FrameExchange exchange_;
};

TEST_F(ClientLoopTest, PublishesACompleteFrame) {
    auto loop = make({}, "none", [&](Layer& layer) {
        EXPECT_EQ(layer.cpu().colour.size_px(), glm::ivec2(8, 4));
        clock_.advance(from_ms(2.0));
    });
    loop->draw_and_publish();
    const RenderedFrame* frame = exchange_.latest();
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->index, 1U);
    ASSERT_EQ(frame->layers.size(), 1U);
    const Layer& layer = *frame->layers[0];
    EXPECT_EQ(layer.name, "main");
    EXPECT_EQ(layer.camera.size_px, glm::ivec2(8, 4));
    EXPECT_EQ(layer.cpu().depth.size_px(), glm::ivec2(8, 4));
    EXPECT_EQ(layer.pose_sampled, at_seconds(10.0));
    ASSERT_EQ(layer.movers.size(), 1U);
    EXPECT_EQ(layer.movers[0].world_from_object[0][0], layer.scene_time_s);

    EXPECT_EQ(frame->times.pose_sampled, at_seconds(10.0));
    EXPECT_EQ(frame->times.render_begin, at_seconds(10.0));
    EXPECT_EQ(frame->times.render_end, at_seconds(10.08));
    EXPECT_EQ(frame->times.published, at_seconds(10.082)) << "after the prepare step";
    ASSERT_EQ(loop->records().size(), 1U);
    EXPECT_EQ(loop->records()[0].times.published, frame->times.published);
    EXPECT_EQ(loop->records()[0].counters.objects_drawn, 5U);
}

TEST_F(ClientLoopTest, ViewsOfBothEyesAreDrawnFromOneHeadPose) {
    Camera display;
    display.size_px = {8, 4};
    const StereoRig rig = mirrored_rig(0.06, FovTangents{});
    ClientSettings settings;
    settings.views = *stereo_views(display, rig, StereoMode::two_renders);
    auto loop = make(settings);
    for (int i = 0; i < 3; ++i) loop->draw_and_publish();
    const RenderedFrame* frame = exchange_.latest();
    ASSERT_EQ(frame->layers.size(), 2U);
    const Layer& left = *frame->layers[0];
    const Layer& right = *frame->layers[1];
    EXPECT_EQ(left.for_eye, Eye::left);
    EXPECT_EQ(right.for_eye, Eye::right);
    // The head moves at 1 m/s while the left eye is drawn; both eyes are where they were for one of its poses.
    const glm::dvec3 between = right.camera.world_from_eye.position_m - left.camera.world_from_eye.position_m;
    EXPECT_NEAR(between.x, 0.06, 1e-12);
    EXPECT_EQ(left.pose_sampled, right.pose_sampled);
    EXPECT_EQ(left.scene_time_s, right.scene_time_s);
}

TEST_F(ClientLoopTest, ShellsForTwoEyesAreDrawnFromBetweenThem) {
    Camera display;
    display.size_px = {8, 4};
    // Eyes in front of the head's origin: what lies between them does too.
    StereoRig rig = mirrored_rig(0.06, FovTangents{});
    for (EyeView& eye : rig.eyes) eye.head_from_eye.position_m.z = -0.1;
    ClientSettings settings;
    settings.views = *stereo_views(display, rig, StereoMode::one_render);
    settings.shells.on = true;
    settings.shells.shells = 2;
    settings.shells.tiles_per_side = 1;
    auto loop = make(settings, "none");
    loop->draw_and_publish();
    const RenderedFrame* frame = exchange_.latest();
    ASSERT_NE(frame, nullptr);
    const Camera& view = frame->layers.front()->camera;
    EXPECT_FALSE(frame->layers.front()->for_eye) << "both eyes look at it";
    EXPECT_NEAR(view.world_from_eye.position_m.z, -0.1, 1e-12);
    const FovTangents& seen = settings.views.front().camera.fov;
    EXPECT_LE(view.fov.left, seen.left);
    EXPECT_GE(view.fov.right, seen.right);
}

TEST_F(ClientLoopTest, DrawsForTheMiddleOfTheFramesDisplayLife) {
    auto loop = make({});
    for (int i = 0; i < 12; ++i) loop->draw_and_publish();
    // Every frame takes 80 ms: drawn from 10.88 to 10.96, it is shown until 11.04, and in the middle of that at 11.00.
    EXPECT_NEAR(renderer_.times_s.back(), 11.0, 1e-6);
    EXPECT_NEAR(renderer_.cameras.back().world_from_eye.position_m.x, 11.0, 1e-6);
    // Nothing is known before the first frame: it is drawn for the moment it begins.
    EXPECT_NEAR(renderer_.times_s.front(), 10.0, 1e-6);
}

TEST_F(ClientLoopTest, AtAGivenRateFramesLiveLonger) {
    ClientSettings settings;
    settings.max_hz = 5.0;
    auto loop = make(settings);
    renderer_.on_draw = [&, frames = 0]() mutable {
        if (++frames == 12) loop->request_stop();
    };
    loop->run();
    ASSERT_EQ(loop->records().size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(loop->records()[i].times.render_begin, at_seconds(10.0 + 0.2 * static_cast<double>(i)));
    }
    // Begun at 12.2, published at 12.28, shown until 12.48. The smoothed period began with the 80 ms that were all that
    // was known of the first frame: of that error (2/3)^10 of 120 ms are left, 2 ms; half of it counts.
    EXPECT_NEAR(renderer_.times_s.back(), 12.38, 0.0015);
}

TEST_F(ClientLoopTest, TheSampledPoseIsTheNewestOne) {
    ClientSettings settings;
    settings.predict_source_pose = false;
    auto loop = make(settings, "constant-velocity");
    for (int i = 0; i < 3; ++i) loop->draw_and_publish();
    for (int i = 0; i < 3; ++i) {
        const double begin_s = 10.0 + 0.08 * i;
        EXPECT_NEAR(renderer_.times_s[static_cast<std::size_t>(i)], begin_s, 1e-9);
        EXPECT_NEAR(renderer_.cameras[static_cast<std::size_t>(i)].world_from_eye.position_m.x, begin_s, 1e-6);
    }
}

TEST_F(ClientLoopTest, ARendererThatThrowsEndsItAndItsLastFrameStays) {
    auto loop = make({});
    renderer_.on_draw = [&] {
        if (renderer_.cameras.size() == 4) throw std::runtime_error{"out of memory"};
    };
    loop->run();
    EXPECT_EQ(loop->failure(), "out of memory");
    EXPECT_EQ(loop->records().size(), 3u);
    ASSERT_NE(exchange_.latest(), nullptr);
    EXPECT_EQ(exchange_.latest()->index, 3u);
}

TEST_F(ClientLoopTest, FrozenItDrawsNothingUntilItMayGoOn) {
    auto loop = make({});
    loop->set_frozen(true);
    loop->request_stop();
    loop->run();
    EXPECT_TRUE(loop->records().empty());
    EXPECT_TRUE(loop->failure().empty());
}

TEST_F(ClientLoopTest, ItsRateCanBeChangedOnTheWay) {
    auto loop = make({});
    loop->set_max_hz(5.0);
    renderer_.on_draw = [&] {
        if (renderer_.cameras.size() == 4) loop->request_stop();
    };
    loop->run();
    for (std::size_t i = 1; i < loop->records().size(); ++i) {
        EXPECT_EQ(loop->records()[i].times.published - loop->records()[i - 1].times.published, from_ms(200.0));
    }
}

TEST_F(ClientLoopTest, DrawsTheSourceThatWasAskedFor) {
    ClientSettings settings;
    settings.source = {2, 1.5, 0.1};
    auto loop = make(settings);
    loop->draw_and_publish();
    settings.camera.size_px = {8, 4};
    const Camera expected = source_camera(settings.camera, 1.5, 0.1);
    EXPECT_EQ(renderer_.cameras.back().size_px, expected.size_px);
    EXPECT_EQ(renderer_.cameras.back().fov, expected.fov);
    EXPECT_EQ(renderer_.samples.back(), 2);
    EXPECT_EQ(exchange_.latest()->layers[0]->camera, renderer_.cameras.back());
}

TEST_F(ClientLoopTest, ALateFrameDoesNotHurryTheNextOnes) {
    ClientSettings settings;
    settings.max_hz = 10.0;
    auto loop = make(settings);
    renderer_.on_draw = [&, frames = 0]() mutable {
        ++frames;
        if (frames == 2) clock_.advance(from_ms(300.0));
        if (frames == 5) loop->request_stop();
    };
    loop->run();
    std::vector<double> begins_ms;
    for (const ClientFrameRecord& record : loop->records()) {
        begins_ms.push_back(to_ms(record.times.render_begin - at_seconds(10.0)));
    }
    EXPECT_EQ(begins_ms, (std::vector<double>{0.0, 100.0, 480.0, 580.0, 680.0}));
}

TEST_F(ClientLoopTest, UsesPixelMemoryAgain) {
    auto loop = make({});
    std::vector<const void*> buffers;
    for (int i = 0; i < 20; ++i) {
        loop->draw_and_publish();
        buffers.push_back(exchange_.latest()->layers[0]->cpu().colour.pixels().data());
    }
    std::ranges::sort(buffers);
    const auto unique_end = std::ranges::unique(buffers).begin();
    // Three frames may be alive in the exchange while a fourth is drawn.
    EXPECT_LE(unique_end - buffers.begin(), 4);
}

TEST(LayerPool, LayersOutliveTheirPool) {
    std::shared_ptr<Layer> layer;
    {
        LayerPool pool;
        layer = pool.acquire();
        auto other = pool.acquire();
        other->prepared.emplace_back("method", std::make_shared<PreparedLayer>());
        other.reset();
        EXPECT_EQ(pool.free_count(), 1U);
        EXPECT_TRUE(pool.acquire()->prepared.empty());
    }
    layer->cpu().colour.resize({4, 4});
    layer.reset();
}

TEST(LayerPool, TexturesAreNotKept) {
    LayerPool pool;
    auto layer = pool.acquire();
    layer->pixels = TexturePixels{};
    layer.reset();
    EXPECT_EQ(pool.free_count(), 0U);
}

}  // namespace
}  // namespace lw
