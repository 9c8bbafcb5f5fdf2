// What a client of shells draws and leaves alone, without GL: its renderer is a room of two spheres around the origin.
#include "client_renderer/shell_client.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

/// Surfaces at 2 m in the lower half of the world, at 40 m above; a mover at 1.5 m where `mover_at` says.
class TwoSpheres final : public SceneRenderer {
public:
    std::optional<glm::dvec3> mover_at;
    double below_m = 2.0;
    double above_m = 40.0;
    std::vector<ScenePart> parts;

    void draw(const Camera& camera, double /*scene_time_s*/, CpuPixels& pixels) override { fill(camera, {}, pixels); }
    void draw_resolved(const Camera& camera, double scene_time_s, int /*samples*/, CpuPixels& pixels) override {
        draw(camera, scene_time_s, pixels);
    }
    std::uint64_t draw_part(const Camera& camera, double /*scene_time_s*/, int /*samples*/, const ScenePart& part,
                            CpuPixels& pixels) override {
        parts.push_back(part);
        fill(camera, part, pixels);
        return empty_what_is_not_in(part, pixels);
    }
    TexturePixels draw_to_textures(const Camera& /*camera*/, double /*scene_time_s*/, int /*samples*/) override {
        return {};
    }
    void draw_supersampled(const Camera& /*camera*/, double /*scene_time_s*/, int /*samples*/,
                           ColourImage& /*colour*/) override {}
    void mover_placements(double /*scene_time_s*/, std::vector<ObjectTransform>& transforms) override {
        transforms.clear();
        if (mover_at) transforms.push_back({1, glm::dmat4{1.0}});
    }
    [[nodiscard]] const DrawCounters& counters() const override { return counters_; }

private:
    void fill(const Camera& camera, const ScenePart& part, CpuPixels& pixels) {
        pixels.colour = ColourImage{camera.size_px};
        pixels.depth = DepthImage{camera.size_px, 0.0F};
        pixels.object_id = ObjectIdImage{camera.size_px, 0};
        for (int y = 0; y < camera.size_px.y; ++y) {
            for (int x = 0; x < camera.size_px.x; ++x) {
                const glm::dvec3 h =
                    glm::dvec3{source_eye_from_source_px(camera).matrix * glm::dvec4{x + 0.5, y + 0.5, 1.0, 0.0}};
                const glm::dvec3 direction = glm::normalize(camera.world_from_eye.orientation * h);
                const bool on_mover = mover_at && part.movers && glm::dot(direction, *mover_at) > 0.99;
                const double ray_m = on_mover ? 1.5 : direction.y < 0.0 ? below_m : above_m;
                const bool inside = on_mover || (ray_m >= part.nearest_m && ray_m < part.farthest_m);
                if (!inside || part.behind != nullptr) continue;
                pixels.depth.at(x, y) = static_cast<float>(camera.near_m * glm::length(h) / ray_m);
                pixels.object_id.at(x, y) = on_mover ? 1 : 0;
            }
        }
    }

    DrawCounters counters_{10, 10, 1000, 1};
};

class ShellClientTest : public ::testing::Test {
protected:
    static constexpr int kSidePx = 64;

    ShellClientTest() {
        settings_.on = true;
        settings_.shells = 2;
        settings_.tiles_per_side = 2;
        settings_.budget_ms = 4.0;
    }

    ShellMoment moment(double now_s, const glm::dvec3& position_m = {}, double turn_rad = 0.0) const {
        ShellMoment at;
        at.now_s = now_s;
        const Pose head{position_m, glm::angleAxis(turn_rad, glm::dvec3{0.0, 1.0, 0.0})};
        at.shown_from = at.shown_middle = at.shown_until = head;
        at.source = display_;
        return at;
    }
    ShellClient client() { return {renderer_, display_, {}, settings_, {}}; }

    Camera display_ = test::plain_camera({kSidePx, kSidePx});
    ShellSettings settings_;
    TwoSpheres renderer_;
};

TEST_F(ShellClientTest, TheWarmUpDrawsEverythingOnce) {
    ShellClient shells = client();
    shells.warm_up(moment(0.0));
    EXPECT_EQ(shells.ranges().size(), 2U);
    EXPECT_EQ(renderer_.parts.size(), 1U + 2U * 24U);
    EXPECT_TRUE(renderer_.parts.front().movers);
    EXPECT_FALSE(renderer_.parts.front().sky);
    EXPECT_FALSE(renderer_.parts.back().movers);
    EXPECT_TRUE(renderer_.parts.back().sky);
}

TEST_F(ShellClientTest, StandingStillNothingIsDrawnAndLayersStayTheSameObjects) {
    ShellClient shells = client();
    const auto first = shells.draw(moment(0.0));
    renderer_.parts.clear();
    for (int frame = 1; frame < 100; ++frame) {
        const auto layers = shells.draw(moment(0.1 * frame));
        EXPECT_EQ(layers, first) << "carried over without a copy";
    }
    EXPECT_TRUE(renderer_.parts.empty());
    EXPECT_EQ(shells.records().back().invalid, 0U);
}

TEST_F(ShellClientTest, AMoverHasOnlyItsOwnItemsDrawn) {
    renderer_.mover_at = glm::dvec3{0.0, 0.0, -1.0};
    ShellClient shells = client();
    (void)shells.draw(moment(0.0));
    double spent_ms = 0.0;
    double all_ms = 0.0;
    std::set<std::string> drawn;
    for (int frame = 1; frame < 40; ++frame) {
        (void)shells.draw(moment(0.1 * frame));
        for (const ShellDraw& draw : shells.records().back().draws) drawn.insert(draw.name);
        spent_ms += shells.records().back().spent_ms;
        all_ms += shells.records().back().all_ms;
    }
    EXPECT_EQ(drawn, std::set<std::string>{"view"});
    EXPECT_GT(spent_ms, 0.0);
    EXPECT_LT(spent_ms, 0.15 * all_ms);
}

TEST_F(ShellClientTest, AWalkerKeepsTheBudgetAndNothingInViewStarves) {
    settings_.max_age_s = 2.0;
    ShellClient shells = client();
    for (int frame = 0; frame < 100; ++frame) (void)shells.draw(moment(0.1 * frame, {0.0, 0.0, -0.1 * frame}));
    int over = 0;
    std::set<std::string> drawn;
    for (const ShellFrameRecord& record : shells.records()) {
        over += record.spent_ms > record.budget_ms ? 1 : 0;
        for (const ShellDraw& draw : record.draws) {
            drawn.insert(draw.name);
            if (draw.name == "view") {
                EXPECT_LT(draw.age_s, 1.0);
            }
        }
    }
    EXPECT_LE(over, 5) << "of 100 frames";
    EXPECT_TRUE(drawn.contains("view"));
    EXPECT_TRUE(drawn.contains("shell1-tile00")) << "straight ahead, beyond the cut";
}

TEST_F(ShellClientTest, WhatTheServerCouldNotExplainIsDrawn) {
    ShellClient shells = client();
    (void)shells.draw(moment(0.0));
    HoleFeedback feedback;
    feedback.display_frames = 3;
    const std::uint32_t item = 1 + 24;  // the first tile of the outer shell: ahead, upper left
    feedback.add(item, 900);
    shells.take(feedback);
    (void)shells.draw(moment(0.1));
    ASSERT_EQ(shells.records().back().draws.size(), 1U);
    EXPECT_EQ(shells.records().back().draws.front().item, item);
    EXPECT_STREQ(shells.records().back().draws.front().reason, "holes");
    (void)shells.draw(moment(0.2));
    EXPECT_TRUE(shells.records().back().draws.empty()) << "drawn anew, its old holes are forgotten";
    settings_.hole_feedback = false;
    ShellClient deaf = client();
    (void)deaf.draw(moment(0.0));
    deaf.take(feedback);
    (void)deaf.draw(moment(0.1));
    EXPECT_TRUE(deaf.records().back().draws.empty());
}

TEST_F(ShellClientTest, RangesFollowWhatIsAroundAfterAWalkAndNotBefore) {
    settings_.budget_ms = 1000.0;
    ShellClient shells = client();
    (void)shells.draw(moment(0.0));
    const double cut_m = shells.ranges().front().farthest_m;
    // What the items hold says how far everything is; a cut moves only for more than a factor of 2.
    renderer_.below_m = renderer_.above_m = 4.2 * cut_m;
    for (int frame = 1; frame < 30; ++frame) (void)shells.draw(moment(0.1 * frame, {0.0, 0.0, 0.01 * frame}));
    EXPECT_EQ(shells.ranges().front().farthest_m, cut_m) << "stood nearly still";
    bool outdated = false;
    for (int frame = 30; frame < 300; ++frame) {
        (void)shells.draw(moment(0.1 * frame, {0.0, 0.0, 0.1 * frame}));
        outdated = outdated || shells.ranges().front().farthest_m > 2.0 * cut_m;
    }
    EXPECT_TRUE(outdated);
}

TEST_F(ShellClientTest, ATurnThatWidensTheGuardBandKeepsTheBudget) {
    settings_.budget_ms.reset();
    ShellClient shells = client();
    for (int frame = 0; frame < 40; ++frame) {
        ShellMoment at = moment(0.1 * frame, {0.0, 0.0, -0.1 * frame}, 0.05 * frame);
        at.source = with_guard_band(display_, frame % 10 < 5 ? 0.0 : 0.17);
        (void)shells.draw(at);
    }
    for (std::size_t frame = 1; frame < shells.records().size(); ++frame) {
        const ShellFrameRecord& record = shells.records()[frame];
        EXPECT_LE(record.spent_ms, record.budget_ms) << "frame " << frame;
    }
}

TEST_F(ShellClientTest, TheViewHoldsWhatTheHeadIsExpectedToTurnTo) {
    settings_.budget_ms = 20.0;
    ShellClient shells = client();
    (void)shells.draw(moment(0.0));
    ShellMoment at = moment(0.1, {0.01, 0.0, 0.0});
    at.shown_until.orientation = glm::angleAxis(0.2, glm::dvec3{0.0, 1.0, 0.0});
    const Camera view = shells.draw(at).front()->camera;
    EXPECT_LE(view.fov.left, std::tan(std::atan(display_.fov.left) - 0.2) + 1e-6);
    EXPECT_EQ(view.fov.right, display_.fov.right);
}

// Alone the view would be so dense that nothing else fits.
TEST_F(ShellClientTest, AViewLeavesRoomForATileThatIsWorthMore) {
    settings_.budget_ms = 3.0;
    settings_.samples_per_axis = 1;
    ShellClient shells = client();
    (void)shells.draw(moment(0.0));
    HoleFeedback feedback;
    feedback.display_frames = 1;
    feedback.add(1 + 24, 4000);
    shells.take(feedback);
    (void)shells.draw(moment(0.1, {0.05, 0.0, 0.0}));
    std::set<std::string> drawn;
    for (const ShellDraw& draw : shells.records().back().draws) drawn.insert(draw.name);
    EXPECT_TRUE(drawn.contains("view"));
    EXPECT_TRUE(drawn.contains("shell1-tile00"));
    EXPECT_LE(shells.records().back().spent_ms, 3.0);
}

TEST_F(ShellClientTest, WhileTheHeadIsCalmTheSidesOfTheViewAreDrawnInTurn) {
    settings_.budget_ms = 1.8;  // too little for all of the view as densely as can be
    ShellClient shells = client();
    std::vector<std::string> drawn;
    for (int frame = 0; frame < 6; ++frame) {
        const auto layers = shells.draw(moment(0.1 * frame, {0.02 * frame, 0.0, 0.0}));
        drawn.push_back(layers[0]->name);
        if (frame < 3) continue;
        EXPECT_NE(layers[0]->name, layers[1]->name);
        EXPECT_EQ(layers[1]->name, drawn[static_cast<std::size_t>(frame) - 1]) << "the other side is that of before";
        EXPECT_GT(layers[0]->camera.size_px.y, kSidePx) << "half of the view, and denser for it";
        EXPECT_LT(layers[0]->camera.size_px.x, layers[0]->camera.size_px.y);
    }
    const std::vector<std::string> last{drawn.end() - 3, drawn.end()};
    EXPECT_EQ(last, (std::vector<std::string>{"view-left", "view-right", "view-left"}));
    const auto turned = shells.draw(moment(0.6, {0.12, 0.0, 0.0}, 0.5));
    EXPECT_EQ(turned[0]->name, "view") << "the older side does not show where the head looks now";
    for (std::size_t i = 1; i < shells.records().size(); ++i) {
        EXPECT_LE(shells.records()[i].spent_ms, shells.records()[i].budget_ms);
    }
}

TEST_F(ShellClientTest, EqualCallsGiveEqualSchedules) {
    std::vector<std::vector<std::uint32_t>> items(2);
    for (auto& run : items) {
        ShellClient shells = client();
        for (int frame = 0; frame < 20; ++frame) (void)shells.draw(moment(0.1 * frame, {0.05 * frame, 0.0, 0.0}));
        for (const ShellFrameRecord& record : shells.records()) {
            for (const ShellDraw& draw : record.draws) run.push_back(draw.item);
        }
    }
    EXPECT_EQ(items[0], items[1]);
}

}  // namespace
}  // namespace lw
