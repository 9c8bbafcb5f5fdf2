#pragma once
/// The view of a client of shells: the nearest shell where the head looks. What it is shown from, how it will be drawn
/// next, and what that will cost. While the head is calm its two sides are drawn in turn (view_sides.h), so that it is
/// shown from two pictures.

#include <memory>
#include <optional>
#include <vector>

#include "client_renderer/shell_item.h"
#include "client_renderer/shell_moment.h"
#include "client_renderer/source_camera.h"
#include "client_renderer/view_extent.h"
#include "client_renderer/view_plan.h"
#include "client_renderer/view_sides.h"

namespace lw {

/// A frame calls look_ahead(), plan_within(), and where the view is drawn begin() and learn(), in this order. One
/// thread.
class ShellView {
public:
    /// @param display  as ShellClient has it
    ShellView(const Camera& display, const SourceSettings& source) : display_{display}, source_{source} {}

    /// One picture of everything was drawn: ViewCosts::start().
    void start_costs(double triangles, double covered_share) { costs_.start(triangles, covered_share); }

    // How it is drawn next.

    /// A coarse picture of all of it, around `moment`'s middle pose, whatever it costs.
    void plan_warm_up(const ShellMoment& moment);
    /// How far the view must reach, and which of its sides may be drawn alone.
    /// @param shell_end_m  where the nearest shell ends: what counts as near while no surface was seen, > 0
    void look_ahead(const ShellMoment& moment, double shell_end_m);
    /// The best plan that is expected to take at most so long, or the cheapest.
    void plan_within(double most_ms);

    /// As planned: what is drawn, a side or all of it.
    [[nodiscard]] Camera camera() const;
    /// As planned: both sides, in the display's pixels.
    [[nodiscard]] Camera whole() const { return whole_of(plan_); }
    [[nodiscard]] bool with_hidden() const { return plan_.hidden; }
    [[nodiscard]] double expected_ms() const;

    // What it is shown from.

    [[nodiscard]] const ShellItem& newest() const { return newest_; }
    [[nodiscard]] ShellItem& newest() { return newest_; }
    /// Its layer is null where newest() is the whole.
    [[nodiscard]] const ShellItem& other_side() const { return other_side_; }
    [[nodiscard]] bool has_two_sides() const { return other_side_.layer != nullptr; }
    /// The newest picture, then the other side, each with what it hides.
    [[nodiscard]] std::vector<std::shared_ptr<const Layer>> layers() const;
    /// The depth there, of the newest picture that looks there; nothing: none does.
    [[nodiscard]] std::optional<float> depth_at(const glm::dvec3& direction_world) const;
    /// Share of the display's pixels that will be past the edge of what it is shown from, at the looked-ahead moment.
    [[nodiscard]] double share_beyond() const;

    /// `layer` was drawn as planned: it gets the name of its side, and the other side is shown from what was newest.
    /// @return the item to fill: newest()
    ShellItem& begin(Layer& layer);
    /// What drawing newest() took. Its share is worked out here.
    void learn(ViewCosts::Drawn drawn, double cost_ms);
    /// It was drawn for ranges that are no longer.
    void outdate();

private:
    [[nodiscard]] Camera whole_of(const ViewPlan& plan) const;
    [[nodiscard]] Camera side_beside_newest(const Camera& whole, ViewSide side) const;
    [[nodiscard]] std::optional<double> known_coverage(const Camera& view) const;
    [[nodiscard]] double near_in_view_m(double shell_end_m) const;
    [[nodiscard]] bool older_side_will_do() const;
    [[nodiscard]] ViewSide least_open_side(const Camera& whole) const;

    Camera display_;
    SourceSettings source_;
    ViewCosts costs_;
    ShellMoment moment_;                   ///< it is planned for
    std::optional<double> first_frame_s_;  ///< the first that was looked ahead to
    ViewPlan plan_;
    ViewExtent extent_;
    double near_m_ = 1.0;                   ///< near_in_view_m()
    ViewSide next_side_ = ViewSide::whole;  ///< that may be drawn now; whole: none
    std::optional<double> whole_covered_;   ///< share of the view, and of next_side_, that will show a surface
    std::optional<double> side_covered_;
    ShellItem newest_;
    ShellItem other_side_;
    ViewSide side_ = ViewSide::whole;  ///< that newest_ is
};

}  // namespace lw
