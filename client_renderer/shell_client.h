#pragma once
/// A client whose frames consist of shells: the scene in distance ranges around the viewer, each an image or more of
/// its own, drawn again only when it has become wrong (--shells). docs/shells.md explains it with a figure.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client_renderer/layer_pool.h"
#include "client_renderer/layer_statistics.h"
#include "client_renderer/scene_renderer.h"
#include "client_renderer/shell_budget.h"
#include "client_renderer/shell_priority.h"
#include "client_renderer/shell_ranges.h"
#include "client_renderer/shell_settings.h"
#include "client_renderer/shell_tiles.h"
#include "client_renderer/source_camera.h"
#include "client_renderer/view_extent.h"
#include "client_renderer/view_plan.h"
#include "client_renderer/view_sides.h"
#include "core/clock.h"
#include "frame_link/hole_feedback.h"

namespace lw {

/// When a frame is drawn, and for which poses.
struct ShellMoment {
    double now_s = 0.0;         ///< of the run's clock, when drawing begins
    double scene_time_s = 0.0;  ///< the movers are drawn at
    TimePoint pose_sampled;     ///< stamp of the newest head sample
    Pose shown_from;            ///< the eye, or the middle of two, as the head is predicted: at the beginning, in
    Pose shown_middle;          ///< the middle and at the end of the frame's life on the display
    Pose shown_until;
    Camera source;               ///< what one main view would be drawn with: size, field of view, near plane
    double head_motion_m = 0.0;  ///< reveal_margin_m(), and from the middle of two eyes to the farther one
    /// What drawing everything with `source` would cost, for a budget of `auto`; where it is not known, what it cost at
    /// the start counts.
    std::optional<double> main_view_ms = std::nullopt;
};

/// One item drawn: a row of the time line.
struct ShellDraw {
    std::uint32_t item = 0;
    std::string name;
    const char* reason = "";
    double error_px = 0.0;  ///< predicted, as weighted
    double cost_ms = 0.0;   ///< measured or modelled
    double age_s = 0.0;     ///< of what it replaces; 0 for a first draw
};

/// What one frame drew.
struct ShellFrameRecord {
    double now_s = 0.0;
    double budget_ms = 0.0;
    double spent_ms = 0.0;
    double all_ms = 0.0;        ///< what drawing every item that exists would cost
    std::uint32_t invalid = 0;  ///< items that were wrong
    std::vector<ShellDraw> draws;
};

/// Belongs to the renderer's thread. Equal calls in equal order give equal frames where costs are modelled.
class ShellClient {
public:
    /// @param display  what is seen at once: of two eyes the view that holds what both see (DrawnView::camera). Its
    ///                 pose is not looked at
    /// @param prepare  runs on every layer before it is first published; may be empty
    ShellClient(SceneRenderer& renderer, const Camera& display, const SourceSettings& source,
                const ShellSettings& settings, std::function<void(const std::shared_ptr<Layer>&)> prepare);

    /// Draws everything there is around `moment`'s middle pose, whatever it costs: what a viewer who has just put the
    /// display on waits for.
    void warm_up(const ShellMoment& moment);

    /// What the server reported since the last call.
    void take(const HoleFeedback& feedback);

    /// Draws what is worth it. The frame's layers, nearest shell first; those that were not drawn are the same objects
    /// as before.
    [[nodiscard]] std::vector<std::shared_ptr<const Layer>> draw(const ShellMoment& moment);

    [[nodiscard]] const std::vector<ShellFrameRecord>& records() const { return records_; }
    [[nodiscard]] std::span<const ShellRange> ranges() const { return ranges_; }
    /// Counters of all draws of the last frame, added up.
    [[nodiscard]] const DrawCounters& counters() const { return counters_; }

private:
    struct Item {
        std::shared_ptr<const Layer> layer;   ///< null: never drawn
        std::shared_ptr<const Layer> hidden;  ///< of the view, with --layers 2
        LayerStatistics statistics;
        double drawn_s = 0.0;
        bool outdated = false;  ///< drawn for ranges that are no longer
        double holes_px = 0.0;  ///< mean per display frame since it was drawn
        double hole_frames = 0.0;
    };
    static constexpr std::size_t kView = 0;

    [[nodiscard]] std::size_t item_count() const {
        return 1 + ranges_.size() * static_cast<std::size_t>(tiles_.count());
    }
    [[nodiscard]] std::size_t shell_of(std::size_t item) const;
    [[nodiscard]] int tile_of(std::size_t item) const;
    [[nodiscard]] std::string name_of(std::size_t item) const;
    [[nodiscard]] ScenePart part_of(std::size_t item) const;
    [[nodiscard]] Camera camera_of(std::size_t item, const ShellMoment& moment) const;
    [[nodiscard]] int samples_of(std::size_t item) const;

    [[nodiscard]] double near_in_view_m() const;
    [[nodiscard]] bool older_side_will_do(const ShellMoment& moment) const;
    [[nodiscard]] ViewSide least_open_side(const Camera& whole, const ShellMoment& moment) const;
    void plan_extent(const ShellMoment& moment);
    void plan_view(const ShellMoment& moment, double most_ms);
    [[nodiscard]] double needed_by_tiles_ms(std::span<const DrawCandidate> tiles, const BudgetSettings& budget) const;
    void choose_outer_quality(double budget_ms);
    [[nodiscard]] Camera whole_view(const ViewPlan& plan, const ShellMoment& moment) const;
    [[nodiscard]] Camera view_camera(const ViewPlan& plan, const ShellMoment& moment) const;
    [[nodiscard]] std::optional<double> known_coverage(const Camera& view) const;
    [[nodiscard]] double expected_view_ms(const ViewPlan& plan, const ShellMoment& moment) const;
    [[nodiscard]] double expected_ms(std::size_t item, const ShellMoment& moment) const;
    [[nodiscard]] double expected_tile_ms(std::size_t item) const;

    void set_ranges(std::span<const double> distances_m, const ShellMoment& moment);
    void reconsider_ranges(const ShellMoment& moment);
    void learn_main_view(const ShellMoment& moment);
    [[nodiscard]] double budget_ms(const ShellMoment& moment) const;
    [[nodiscard]] std::vector<double> distances_around(const ShellMoment& moment);

    [[nodiscard]] PredictedError predicted(std::size_t item, const ShellMoment& moment, ItemOutlook& outlook) const;
    [[nodiscard]] ItemOutlook outlook(std::size_t item, const Item& drawn, const ShellMoment& moment) const;
    void judge_visibility(std::size_t item, const ShellMoment& moment, ItemOutlook& outlook) const;
    [[nodiscard]] std::optional<float> seen_by_view(const glm::dvec3& direction_world) const;
    [[nodiscard]] double share_beyond_view(const ShellMoment& moment) const;
    [[nodiscard]] double guessed_cost_ms(std::size_t item) const;

    double begin_view(Layer& layer, const ShellMoment& moment);
    double draw_item(std::size_t item, const ShellMoment& moment);
    std::shared_ptr<Layer> draw_hidden(const Layer& first, const ShellMoment& moment);
    [[nodiscard]] bool is_shown(std::size_t item) const;
    /// The view, what it hides, the outer shells, and the nearest shell's tiles last: they fill what is left.
    [[nodiscard]] std::vector<std::shared_ptr<const Layer>> layers() const;

    SceneRenderer& renderer_;
    Camera display_;
    SourceSettings source_;
    ShellSettings settings_;
    std::function<void(const std::shared_ptr<Layer>&)> prepare_;
    ShellTiles tiles_;
    ShellTiles outer_tiles_;  ///< the same tiles as finely as the outer shells have them
    LayerPool pool_;
    std::vector<ShellRange> ranges_;
    glm::dvec3 ranges_from_{0.0};  ///< where the eye was when they were last thought over
    int outer_samples_ = 1;        ///< per axis
    bool outer_dense_ = true;      ///< whether outer tiles are those of outer_tiles_
    ViewExtent extent_;            ///< of the view being drawn
    ViewPlan plan_;                ///< of the same
    ViewCosts view_costs_;
    double saved_for_tiles_ms_ = 0.0;
    double near_m_ = 1.0;                   ///< near_in_view_m()
    ViewSide next_side_ = ViewSide::whole;  ///< that may be drawn now; whole: none
    std::optional<double> whole_covered_;   ///< share of the view, and of next_side_, that will show a surface
    std::optional<double> side_covered_;
    std::vector<Item> items_;
    Item other_side_;  ///< what the view's other side is shown from; null where items_[kView] is the whole
    ViewSide side_ = ViewSide::whole;  ///< that items_[kView] is
    CostBook costs_;
    double main_view_triangles_ = 0.0;     ///< of one view of everything, at the start
    double main_view_covered_ = 1.0;       ///< share of its pixels that show a surface
    double main_view_ms_per_pixel_ = 0.0;  ///< where costs are measured
    DrawCounters counters_;
    std::vector<ShellFrameRecord> records_;
};

}  // namespace lw
