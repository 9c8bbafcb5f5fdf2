// What the view of a client of shells is shown from and how it is drawn next, with pictures made here.
#include "client_renderer/shell_view.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/camera_picture.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

constexpr double kShellEnd_m = 5.0;

class ShellViewTest : public ::testing::Test {
protected:
    ShellMoment moment(double now_s, const glm::dvec3& position_m = {}) const {
        ShellMoment at;
        at.now_s = now_s;
        at.shown_from.position_m = at.shown_middle.position_m = at.shown_until.position_m = position_m;
        return at;
    }
    /// A wall at `wall_m` all over the view as it is planned.
    std::shared_ptr<Layer> draw(double now_s, double wall_m = 2.0) {
        auto layer = std::make_shared<Layer>();
        layer->name = "view";
        layer->camera = view_.camera();
        const double depth = layer->camera.near_m / wall_m;
        layer->cpu().depth = DepthImage{layer->camera.size_px, static_cast<float>(depth)};
        ShellItem& item = view_.begin(*layer);
        item.statistics.ray_m = {wall_m};
        item.set_layer(layer, now_s);
        return layer;
    }
    /// The picture of the warm-up, and one frame after it.
    void draw_whole() {
        view_.start_costs(1000.0, 1.0);
        view_.plan_warm_up(moment(0.0));
        (void)draw(0.0);
        view_.look_ahead(moment(0.0), kShellEnd_m);  // the first frame, which draws nothing
        view_.look_ahead(moment(0.1), kShellEnd_m);
        view_.plan_within(0.0);
        (void)draw(0.1);
    }

    Camera display_ = test::plain_camera({64, 64});
    ShellView view_{display_, {}};
};

TEST_F(ShellViewTest, TheWarmUpIsAsDenseAsTheDisplay) {
    view_.plan_warm_up(moment(0.0, {1.0, 0.0, 0.0}));
    EXPECT_EQ(view_.camera(), at_pose(display_, Pose{{1.0, 0.0, 0.0}}));
    EXPECT_EQ(view_.camera(), view_.whole());
    EXPECT_FALSE(view_.with_hidden()) << "the source has one layer";
}

TEST_F(ShellViewTest, TakesTheBestPlanThatIsCheapEnoughOrTheCheapest) {
    draw_whole();
    view_.look_ahead(moment(0.2), kShellEnd_m);
    view_.plan_within(1e6);
    EXPECT_EQ(view_.camera().size_px, 2 * display_.size_px);
    const double best_ms = view_.expected_ms();
    view_.plan_within(0.9 * best_ms);
    EXPECT_LE(view_.expected_ms(), 0.9 * best_ms);
    view_.plan_within(0.0);
    EXPECT_EQ(view_.camera(), display_);
}

TEST_F(ShellViewTest, ASideIsShownBesideThePictureBeforeIt) {
    draw_whole();
    const double whole_ms = [&] {
        view_.look_ahead(moment(0.2), kShellEnd_m);
        view_.plan_within(1e6);
        return view_.expected_ms();
    }();
    EXPECT_FALSE(view_.has_two_sides());
    view_.plan_within(0.99 * whole_ms);  // the next plan in order is one side as dense as this
    const auto before = view_.newest().layer;
    const auto side = draw(0.2);
    EXPECT_TRUE(view_.has_two_sides());
    EXPECT_EQ(view_.layers(), (std::vector<std::shared_ptr<const Layer>>{side, before}));
    EXPECT_EQ(side->name, "view-right");
    EXPECT_LT(side->camera.size_px.x, side->camera.size_px.y);
    view_.look_ahead(moment(0.3), kShellEnd_m);
    view_.plan_within(0.99 * whole_ms);
    EXPECT_EQ(draw(0.3)->name, "view-left") << "not the one that was drawn last";
    view_.outdate();
    EXPECT_FALSE(view_.has_two_sides());
    EXPECT_FALSE(view_.newest().is_valid());
    view_.look_ahead(moment(0.4), kShellEnd_m);
    view_.plan_within(0.99 * whole_ms);
    EXPECT_EQ(draw(0.4)->name, "view") << "nothing that may be shown beside it";
}

TEST_F(ShellViewTest, AStepTooFarForAnOlderSideDrawsTheWhole) {
    draw_whole();
    // A tenth of the distance of what is near.
    for (const auto& [step_m, is_whole] : {std::pair{0.21, true}, std::pair{0.19, false}}) {
        view_.look_ahead(moment(0.2, {step_m, 0.0, 0.0}), kShellEnd_m);
        view_.plan_within(1e6);
        view_.plan_within(0.99 * view_.expected_ms());
        EXPECT_EQ(view_.camera().fov == view_.whole().fov, is_whole) << step_m;
    }
}

TEST_F(ShellViewTest, DepthsAreThoseOfTheNewestPictureThatLooksThere) {
    EXPECT_FALSE(view_.depth_at({0.0, 0.0, -1.0}).has_value()) << "no picture";
    draw_whole();
    EXPECT_FLOAT_EQ(*view_.depth_at({0.9, 0.0, -1.0}), static_cast<float>(display_.near_m / 2.0));
    EXPECT_FALSE(view_.depth_at({1.1, 0.0, -1.0}).has_value()) << "past its edge";
    EXPECT_EQ(view_.share_beyond(), 0.0);
    ShellMoment turned = moment(0.2);
    turned.shown_until.orientation = glm::angleAxis(1.6, glm::dvec3{0.0, 1.0, 0.0});
    view_.look_ahead(turned, kShellEnd_m);
    EXPECT_EQ(view_.share_beyond(), 0.5) << "all that is seen at the end";
}

}  // namespace
}  // namespace lw
