#include "client_renderer/shell_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/camera_picture.h"

namespace lw {
namespace {

// A part of the display is looked at by so many squared directions.
constexpr int kDisplayProbes = 8;
// What a view will cover is looked up in so many squared directions.
constexpr int kCoverageProbes = 24;
// One side of the view at a time: where what is near has shifted by no more since the other one was drawn, the head
// turns no farther while a frame is shown, and all of what will be seen but so much is on one of the two.
constexpr double kMostShift_tan = 0.1;
constexpr double kMostTurned_rad = 0.1;
constexpr double kMostLeftOpen = 0.04;
// Of what the view holds: so much counts as near.
constexpr double kNearShare = 0.1;

// Of two views at one pose, one of which holds the other.
double share_of(const Camera& part, const Camera& whole) {
    return (part.fov.right - part.fov.left) / (whole.fov.right - whole.fov.left);
}

}  // namespace

// How it is drawn next.

void ShellView::plan_warm_up(const ShellMoment& moment) {
    moment_ = moment;
    plan_ = {1.0, source_.layers == 2};
}

// Where sides are drawn, each is shown for two frames.
void ShellView::look_ahead(const ShellMoment& moment, double shell_end_m) {
    moment_ = moment;
    if (!first_frame_s_) first_frame_s_ = moment.now_s;
    near_m_ = near_in_view_m(shell_end_m);
    const Pose later = gone_on(moment.shown_from, moment.shown_until);
    const bool is_calm =
        glm::distance(moment.shown_middle.position_m, later.position_m) <= kMostShift_tan * near_m_ &&
        angle_between_rad(moment.shown_from.orientation, moment.shown_until.orientation) <= kMostTurned_rad;
    const Pose& until = is_calm ? later : moment.shown_until;
    extent_ = next_extent(display_, {moment.shown_middle, moment.shown_from, until, near_m_}, extent_);
    const Camera whole = whole_of({});
    next_side_ = is_calm && older_side_will_do() ? least_open_side(whole) : ViewSide::whole;
    // Of two wholes the one covers as much as the other.
    whole_covered_ = side_ != ViewSide::whole ? known_coverage(whole) : std::nullopt;
    if (next_side_ == ViewSide::whole) return;
    side_covered_ = known_coverage(side_beside_newest(whole, next_side_));
}

void ShellView::plan_within(double most_ms) {
    for (const ViewPlan& plan : view_plans()) {
        if (plan.hidden && source_.layers < 2) continue;
        if (plan.one_side && next_side_ == ViewSide::whole) continue;
        plan_ = plan;
        if (expected_ms() <= most_ms) return;
    }
}

Camera ShellView::whole_of(const ViewPlan& plan) const {
    return at_pose(extended(display_, extent_.scaled(plan.extent_share)), moment_.shown_middle);
}

Camera ShellView::camera() const {
    Camera camera = plan_.one_side ? side_beside_newest(whole(), next_side_) : whole();
    const double density = source_.density * plan_.density;
    camera.size_px = {std::lround(density * camera.size_px.x), std::lround(density * camera.size_px.y)};
    return camera;
}

Camera ShellView::side_beside_newest(const Camera& whole, ViewSide side) const {
    return side_of(whole, side, newest_.layer->camera, near_m_);
}

double ShellView::expected_ms() const {
    const Camera view = camera();
    ViewCosts::Planned planned{pixel_count(view) * source_.samples_per_axis * source_.samples_per_axis};
    planned.share = share_of(view, whole());
    planned.covered = plan_.one_side ? side_covered_ : whole_covered_;
    return costs_.expected_ms(plan_, planned);
}

// The share of a view that shows a surface, as far as the last pictures tell.
std::optional<double> ShellView::known_coverage(const Camera& view) const {
    int known = 0;
    int covered = 0;
    for (int y = 0; y < kCoverageProbes; ++y) {
        for (int x = 0; x < kCoverageProbes; ++x) {
            const auto depth = depth_at(direction_at(view, (x + 0.5) / kCoverageProbes, (y + 0.5) / kCoverageProbes));
            if (!depth) continue;
            ++known;
            covered += *depth > 0.0F ? 1 : 0;
        }
    }
    if (2 * known < kCoverageProbes * kCoverageProbes) return std::nullopt;
    return static_cast<double>(covered) / known;
}

// Beyond it lie nine tenths of what the last view held.
double ShellView::near_in_view_m(double shell_end_m) const {
    std::vector<double> seen_m = newest_.statistics.ray_m;
    const std::vector<double>& beside_m = other_side_.statistics.ray_m;
    seen_m.insert(seen_m.end(), beside_m.begin(), beside_m.end());
    if (seen_m.empty()) return shell_end_m;
    const auto at = seen_m.begin() + static_cast<std::ptrdiff_t>(kNearShare * static_cast<double>(seen_m.size()));
    std::nth_element(seen_m.begin(), at, seen_m.end());
    return *at;
}

// Whether the last picture may be shown for another frame. That of the warm-up is coarse.
bool ShellView::older_side_will_do() const {
    if (!newest_.is_valid() || newest_.drawn_s <= *first_frame_s_) return false;
    const Pose& drawn_from = newest_.layer->camera.world_from_eye;
    return glm::distance(moment_.shown_until.position_m, drawn_from.position_m) <= kMostShift_tan * near_m_;
}

// Not the one that was drawn last.
ViewSide ShellView::least_open_side(const Camera& whole) const {
    const Camera& other = newest_.layer->camera;
    const Pose shown[] = {moment_.shown_from, moment_.shown_middle, moment_.shown_until};
    ViewSide least = ViewSide::whole;
    double least_open = kMostLeftOpen;
    for (const ViewSide side : {ViewSide::left, ViewSide::right}) {
        if (side == side_) continue;
        const double open = share_left_open(whole, side_beside_newest(whole, side), other, display_, shown);
        if (open > least_open) continue;
        least_open = open;
        least = side;
    }
    return least;
}

// What it is shown from.

std::vector<std::shared_ptr<const Layer>> ShellView::layers() const {
    std::vector<std::shared_ptr<const Layer>> layers;
    for (const auto& layer : {newest_.layer, newest_.hidden, other_side_.layer, other_side_.hidden}) {
        if (layer != nullptr) layers.push_back(layer);
    }
    return layers;
}

std::optional<float> ShellView::depth_at(const glm::dvec3& direction_world) const {
    for (const Layer* view : {newest_.layer.get(), other_side_.layer.get()}) {
        if (view == nullptr || !sees(view->camera, direction_world)) continue;
        const glm::dvec3 ray = glm::conjugate(view->camera.world_from_eye.orientation) * direction_world;
        const FovTangents& fov = view->camera.fov;
        const glm::ivec2 size_px = view->camera.size_px;
        const int x = static_cast<int>((ray.x / -ray.z - fov.left) / (fov.right - fov.left) * size_px.x);
        const int y = static_cast<int>((fov.up - ray.y / -ray.z) / (fov.up - fov.down) * size_px.y);
        return view->cpu().depth.at(std::clamp(x, 0, size_px.x - 1), std::clamp(y, 0, size_px.y - 1));
    }
    return std::nullopt;
}

double ShellView::share_beyond() const {
    int beyond = 0;
    for (const Pose& pose : {moment_.shown_middle, moment_.shown_until}) {
        const Camera display = at_pose(display_, pose);
        for (int y = 0; y < kDisplayProbes; ++y) {
            for (int x = 0; x < kDisplayProbes; ++x) {
                const glm::dvec3 direction =
                    direction_at(display, (x + 0.5) / kDisplayProbes, (y + 0.5) / kDisplayProbes);
                beyond += depth_at(direction) ? 0 : 1;
            }
        }
    }
    return beyond / (2.0 * kDisplayProbes * kDisplayProbes);
}

ShellItem& ShellView::begin(Layer& layer) {
    other_side_ = plan_.one_side ? std::move(newest_) : ShellItem{};
    newest_ = {};
    side_ = plan_.one_side ? next_side_ : ViewSide::whole;
    if (side_ != ViewSide::whole) layer.name += side_ == ViewSide::left ? "-left" : "-right";
    return newest_;
}

void ShellView::learn(ViewCosts::Drawn drawn, double cost_ms) {
    drawn.share = share_of(newest_.layer->camera, whole());
    costs_.learn(drawn, cost_ms);
}

void ShellView::outdate() {
    newest_.outdated = true;
    other_side_ = {};
}

}  // namespace lw
