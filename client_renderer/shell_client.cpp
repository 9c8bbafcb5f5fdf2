#include "client_renderer/shell_client.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client_renderer/hidden_layer.h"
#include "core/check.h"

namespace lw {
namespace {

constexpr std::size_t kMostShells = 4;
// The distances around the viewer are taken from six small pictures of everything.
constexpr int kProbePx = 64;
// A part of the display is looked at by so many squared directions.
constexpr int kDisplayProbes = 8;
// What a view will cover is looked up in so many squared directions.
constexpr int kCoverageProbes = 24;
// One side of the view at a time: where what is near has shifted by no more since the other one was drawn, the head
// turns no farther while a frame is shown, and all of what will be seen but so much is on one of the two.
constexpr double kMostShift_tan = 0.1;
constexpr double kMostTurned_rad = 0.1;
constexpr double kMostLeftOpen = 0.04;
// Of the budget: the view is drawn less finely where it would take more, outer tiles with fewer samples. Tiles that are
// worth more than a denser view get so much of it at most.
constexpr double kMostForTheView = 0.93;
constexpr double kMostForTiles = 0.4;
// Of the budget: saved up in every frame for tiles that are worth less. With half of it tiles beside new ones grew so
// old that gaps opened between them (0.65 % of the pictures of both eyes on a walk through a room, now 0.45 %).
constexpr double kSavedForTiles = 0.10;
// What a denser view puts right: in `city` at 512x512 FLIP falls by 0.003 from density 1.5 to 2, as if 2000 pixels were
// no longer wrong, for 87 ms.
constexpr double kDenserView_px_per_ms = 25.0;
// Tiles hold what an eye that moves by so much may see; what it sees beyond, the server reports. At 2.8 m, as far as
// shells overlap in `city`, hardly anything hides anything, and a tile took more than the budget.
constexpr double kTileReveal_m = 0.5;
// Of what the view holds: so much counts as near.
constexpr double kNearShare = 0.1;
// Of the nearest shell's reach: so far the head walks before its ranges are thought over.
constexpr double kReconsiderRanges = 0.5;
constexpr double kMostForATile = 0.5;
constexpr double kEnoughOfTheBudget = 0.95;  // costs vary: this much of it is planned with

double pixel_count(const Camera& camera) { return static_cast<double>(camera.size_px.x) * camera.size_px.y; }

void add(DrawCounters& sum, const DrawCounters& drawn) {
    sum.objects_tested += drawn.objects_tested;
    sum.objects_drawn += drawn.objects_drawn;
    sum.triangles_drawn += drawn.triangles_drawn;
    sum.draw_calls += drawn.draw_calls;
    sum.objects_outside += drawn.objects_outside;
    sum.objects_behind_walls += drawn.objects_behind_walls;
    sum.objects_occluded += drawn.objects_occluded;
    sum.objects_too_small += drawn.objects_too_small;
    sum.objects_between_samples += drawn.objects_between_samples;
    sum.clusters_tested += drawn.clusters_tested;
    sum.clusters_outside += drawn.clusters_outside;
    sum.clusters_turned_away += drawn.clusters_turned_away;
    sum.clusters_occluded += drawn.clusters_occluded;
    sum.clusters_too_small += drawn.clusters_too_small;
    sum.clusters_between_samples += drawn.clusters_between_samples;
    sum.culling += drawn.culling;
}

// A direction of a camera's picture, x and y in [0, 1] from its upper left corner.
glm::dvec3 direction_at(const Camera& camera, double x, double y) {
    const FovTangents& fov = camera.fov;
    const glm::dvec3 ray{glm::mix(fov.left, fov.right, x), glm::mix(fov.up, fov.down, y), -1.0};
    return camera.world_from_eye.orientation * ray;
}

// Of two views at one pose, one of which holds the other.
double share_of(const Camera& part, const Camera& whole) {
    return (part.fov.right - part.fov.left) / (whole.fov.right - whole.fov.left);
}

double turned_rad(const Pose& from, const Pose& to) {
    return 2.0 * std::acos(std::min(std::abs(glm::dot(from.orientation, to.orientation)), 1.0));
}

Camera at_pose(Camera camera, const Pose& pose) {
    camera.world_from_eye = pose;
    return camera;
}

}  // namespace

ShellClient::ShellClient(SceneRenderer& renderer, const Camera& display, const SourceSettings& source,
                         const ShellSettings& settings, std::function<void(const std::shared_ptr<Layer>&)> prepare)
    : renderer_{renderer},
      display_{display},
      source_{source},
      settings_{settings},
      prepare_{std::move(prepare)},
      tiles_{display, 1.0, settings.tiles_per_side},
      outer_tiles_{display, settings.density, settings.tiles_per_side},
      items_(1 + kMostShells * static_cast<std::size_t>(tiles_.count())),
      costs_{items_.size()} {}

// What an item is.

std::size_t ShellClient::shell_of(std::size_t item) const {
    return item == kView ? 0 : (item - 1) / static_cast<std::size_t>(tiles_.count());
}

int ShellClient::tile_of(std::size_t item) const {
    LW_CHECK(item != kView, "the view is no tile");
    return static_cast<int>((item - 1) % static_cast<std::size_t>(tiles_.count()));
}

std::string ShellClient::name_of(std::size_t item) const {
    return item == kView ? "view" : fmt::format("shell{}-tile{:02}", shell_of(item), tile_of(item));
}

ScenePart ShellClient::part_of(std::size_t item) const {
    const std::size_t shell = shell_of(item);
    ScenePart part;
    part.nearest_m = ranges_[shell].nearest_m;
    part.farthest_m = ranges_[shell].farthest_m + ranges_[shell].overlap_m;
    // Movers belong to the nearest shell at any distance: it is the one that is drawn often, they never cross a
    // boundary, and what is drawn behind them stays whole.
    part.movers = shell == 0;
    part.sky = shell + 1 == ranges_.size();
    return part;
}

Camera ShellClient::camera_of(std::size_t item, const ShellMoment& moment) const {
    if (item == kView) return view_camera(plan_, moment);
    const ShellTiles& tiles = shell_of(item) > 0 && outer_dense_ ? outer_tiles_ : tiles_;
    return tiles.camera(tile_of(item), moment.shown_middle.position_m);
}

int ShellClient::samples_of(std::size_t item) const {
    return shell_of(item) == 0 ? source_.samples_per_axis : outer_samples_;
}

// What the view costs, and how finely everything is drawn.

// Both sides of it, in the display's pixels.
Camera ShellClient::whole_view(const ViewPlan& plan, const ShellMoment& moment) const {
    return at_pose(extended(display_, extent_.scaled(plan.extent_share)), moment.shown_middle);
}

Camera ShellClient::view_camera(const ViewPlan& plan, const ShellMoment& moment) const {
    Camera camera = whole_view(plan, moment);
    if (plan.one_side) camera = side_of(camera, next_side_, items_[kView].layer->camera, near_m_);
    const double density = source_.density * plan.density;
    camera.size_px = {std::lround(density * camera.size_px.x), std::lround(density * camera.size_px.y)};
    return camera;
}

double ShellClient::expected_view_ms(const ViewPlan& plan, const ShellMoment& moment) const {
    const Camera view = view_camera(plan, moment);
    ViewCosts::Planned planned{pixel_count(view) * source_.samples_per_axis * source_.samples_per_axis};
    planned.share = share_of(view, whole_view(plan, moment));
    planned.covered = plan.one_side ? side_covered_ : whole_covered_;
    return view_costs_.expected_ms(plan, planned);
}

// The share of a view that shows a surface, as far as the last pictures tell.
std::optional<double> ShellClient::known_coverage(const Camera& view) const {
    int known = 0;
    int covered = 0;
    for (int y = 0; y < kCoverageProbes; ++y) {
        for (int x = 0; x < kCoverageProbes; ++x) {
            const auto depth =
                seen_by_view(direction_at(view, (x + 0.5) / kCoverageProbes, (y + 0.5) / kCoverageProbes));
            if (!depth) continue;
            ++known;
            covered += *depth > 0.0F ? 1 : 0;
        }
    }
    if (2 * known < kCoverageProbes * kCoverageProbes) return std::nullopt;
    return static_cast<double>(covered) / known;
}

double ShellClient::expected_ms(std::size_t item, const ShellMoment& moment) const {
    return item == kView ? expected_view_ms(plan_, moment) : expected_tile_ms(item);
}

double ShellClient::expected_tile_ms(std::size_t item) const { return costs_.expected_ms(item, guessed_cost_ms(item)); }

// Beyond it lie nine tenths of what the last view held.
double ShellClient::near_in_view_m() const {
    std::vector<double> seen_m = items_[kView].statistics.ray_m;
    const std::vector<double>& beside_m = other_side_.statistics.ray_m;
    seen_m.insert(seen_m.end(), beside_m.begin(), beside_m.end());
    if (seen_m.empty()) return ranges_.front().farthest_m;
    const auto at = seen_m.begin() + static_cast<std::ptrdiff_t>(kNearShare * static_cast<double>(seen_m.size()));
    std::nth_element(seen_m.begin(), at, seen_m.end());
    return *at;
}

// Whether the last picture of the view may be shown for another frame. That of the warm-up is coarse.
bool ShellClient::older_side_will_do(const ShellMoment& moment) const {
    const Item& last = items_[kView];
    const bool is_of_warm_up = records_.empty() || last.drawn_s <= records_.front().now_s;
    if (is_of_warm_up || last.layer == nullptr || last.outdated) return false;
    const double moved_m = glm::distance(moment.shown_until.position_m, last.layer->camera.world_from_eye.position_m);
    return moved_m <= kMostShift_tan * near_m_;
}

// Where sides are drawn, each is shown for two frames.
void ShellClient::plan_extent(const ShellMoment& moment) {
    near_m_ = near_in_view_m();
    const Pose later = gone_on(moment.shown_from, moment.shown_until);
    const bool is_calm = glm::distance(moment.shown_middle.position_m, later.position_m) <= kMostShift_tan * near_m_ &&
                         turned_rad(moment.shown_from, moment.shown_until) <= kMostTurned_rad;
    const Pose& until = is_calm ? later : moment.shown_until;
    extent_ = next_extent(display_, {moment.shown_middle, moment.shown_from, until, near_m_}, extent_);
    const Camera whole = whole_view({}, moment);
    next_side_ = is_calm && older_side_will_do(moment) ? least_open_side(whole, moment) : ViewSide::whole;
    // Of two wholes the one covers as much as the other.
    whole_covered_ = side_ != ViewSide::whole ? known_coverage(whole) : std::nullopt;
    if (next_side_ == ViewSide::whole) return;
    side_covered_ = known_coverage(side_of(whole, next_side_, items_[kView].layer->camera, near_m_));
}

// Not the one that was drawn last.
ViewSide ShellClient::least_open_side(const Camera& whole, const ShellMoment& moment) const {
    const Camera& other = items_[kView].layer->camera;
    const Pose shown[] = {moment.shown_from, moment.shown_middle, moment.shown_until};
    ViewSide least = ViewSide::whole;
    double least_open = kMostLeftOpen;
    for (const ViewSide side : {ViewSide::left, ViewSide::right}) {
        if (side == side_) continue;
        const double open = share_left_open(whole, side_of(whole, side, other, near_m_), other, display_, shown);
        if (open > least_open) continue;
        least_open = open;
        least = side;
    }
    return least;
}

void ShellClient::plan_view(const ShellMoment& moment, double most_ms) {
    for (const ViewPlan& plan : view_plans()) {
        if (plan.hidden && source_.layers < 2) continue;
        if (plan.one_side && next_side_ == ViewSide::whole) continue;
        plan_ = plan;
        if (expected_view_ms(plan, moment) <= most_ms) return;
    }
}

// Those that are worth more than a denser view, and as many as were saved up for: a dense view would leave them
// nothing.
double ShellClient::needed_by_tiles_ms(std::span<const DrawCandidate> tiles, const BudgetSettings& budget) const {
    const double most_ms = kMostForTiles * budget.budget_ms;
    double urgent_ms = 0.0;
    for (const DrawCandidate& tile : tiles) {
        const bool fits = urgent_ms + tile.cost_ms <= most_ms;
        if (fits && tile.priority > kDenserView_px_per_ms * tile.cost_ms) urgent_ms += tile.cost_ms;
    }
    BudgetSettings saved = budget;
    saved.budget_ms = std::min(saved_for_tiles_ms_, most_ms);
    double saved_for_ms = 0.0;
    for (const std::size_t index : choose_items({tiles.begin(), tiles.end()}, saved)) {
        saved_for_ms += expected_tile_ms(index);
    }
    return std::max(urgent_ms, saved_for_ms);
}

void ShellClient::choose_outer_quality(double budget_ms) {
    outer_samples_ = settings_.samples_per_axis;
    outer_dense_ = true;
    const auto costs_too_much = [&] { return guessed_cost_ms(item_count() - 1) > kMostForATile * budget_ms; };
    if (costs_too_much()) outer_dense_ = false;
    while (outer_samples_ > 1 && costs_too_much()) outer_samples_ /= 2;
}

// Ranges and budget.

std::vector<double> ShellClient::distances_around(const ShellMoment& moment) {
    Camera small = display_;
    small.size_px = glm::ivec2{kProbePx};
    small.fov = {};
    const ShellTiles faces{small, 1.0, 1};
    std::vector<double> distances_m;
    for (int face = 0; face < faces.count(); ++face) {
        Layer layer;
        layer.camera = faces.camera(face, moment.shown_middle.position_m);
        renderer_.draw(layer.camera, moment.scene_time_s, layer.cpu());
        const std::vector<double> seen_m = statistics_of(layer).ray_m;
        distances_m.insert(distances_m.end(), seen_m.begin(), seen_m.end());
    }
    return distances_m;
}

void ShellClient::set_ranges(std::span<const double> distances_m, const ShellMoment& moment) {
    ranges_from_ = moment.shown_middle.position_m;
    ShellRangeSettings settings;
    settings.shells = settings_.shells;
    settings.pixels_per_tangent = display_.size_px.y / (display_.fov.up - display_.fov.down);
    const std::vector<ShellRange> wanted = shell_ranges(settings, distances_m);
    if (!ranges_outdated(ranges_, wanted)) return;
    ranges_ = wanted;
    for (std::size_t item = 0; item < items_.size(); ++item) {
        items_[item].outdated = true;
        if (item >= item_count()) items_[item] = {};
    }
    other_side_ = {};
}

// After a walk through half of the nearest shell, from what the items hold: no picture is drawn for it.
void ShellClient::reconsider_ranges(const ShellMoment& moment) {
    const double walked_m = glm::distance(moment.shown_middle.position_m, ranges_from_);
    if (walked_m < kReconsiderRanges * ranges_[0].farthest_m) return;
    std::vector<double> distances_m;
    for (std::size_t i = 1; i < item_count(); ++i) {
        const std::vector<double>& seen_m = items_[i].statistics.ray_m;
        distances_m.insert(distances_m.end(), seen_m.begin(), seen_m.end());
    }
    set_ranges(distances_m, moment);
}

void ShellClient::learn_main_view(const ShellMoment& moment) {
    Layer layer;
    layer.camera = camera_of(kView, moment);
    // The first draw of a size makes buffers.
    for (int i = 0; i < (settings_.clock != nullptr ? 2 : 1); ++i) {
        const TimePoint begin = settings_.clock != nullptr ? settings_.clock->now() : TimePoint{};
        renderer_.draw_resolved(layer.camera, moment.scene_time_s, source_.samples_per_axis, layer.cpu());
        if (settings_.clock != nullptr) {
            main_view_ms_per_pixel_ = to_ms(settings_.clock->now() - begin) / pixel_count(layer.camera);
        }
    }
    main_view_triangles_ = static_cast<double>(renderer_.counters().triangles_drawn);
    main_view_covered_ = statistics_of(layer).surface_px / pixel_count(layer.camera);
    view_costs_.start(main_view_triangles_, main_view_covered_);
}

double ShellClient::budget_ms(const ShellMoment& moment) const {
    if (settings_.budget_ms) return *settings_.budget_ms;
    if (moment.main_view_ms) return *moment.main_view_ms;
    if (settings_.clock != nullptr) return main_view_ms_per_pixel_ * pixel_count(moment.source);
    const double samples = pixel_count(moment.source) * source_.samples_per_axis * source_.samples_per_axis;
    return modelled_cost_ms(main_view_triangles_, samples, main_view_covered_ * samples);
}

// What is expected of an item.

// The depth there, of the newest picture that looks there.
std::optional<float> ShellClient::seen_by_view(const glm::dvec3& direction_world) const {
    for (const Layer* view : {items_[kView].layer.get(), other_side_.layer.get()}) {
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

void ShellClient::judge_visibility(std::size_t item, const ShellMoment& moment, ItemOutlook& outlook) const {
    const glm::dvec3 forward = moment.shown_middle.orientation * glm::dvec3{0.0, 0.0, -1.0};
    if (item == kView) {
        outlook.visible_share = 1.0;
        return;
    }
    const Camera views[] = {at_pose(display_, moment.shown_from), at_pose(display_, moment.shown_middle),
                            at_pose(display_, moment.shown_until)};
    const Camera view = whole_view(plan_, moment);
    const bool nearest_shell = shell_of(item) == 0;
    int visible = 0;
    double least_cosine_angle = -1.0;
    for (const glm::dvec3& direction : tiles_.probes(tile_of(item))) {
        const bool seen =
            std::any_of(std::begin(views), std::end(views), [&](const Camera& c) { return sees(c, direction); });
        // The nearest shell's tiles stand in where its view ends, the others where it has nothing.
        const bool shown_by_view =
            nearest_shell ? sees(view, direction) : seen_by_view(direction).value_or(0.0F) > 0.0F;
        if (!seen || shown_by_view) continue;
        ++visible;
        least_cosine_angle = std::max(least_cosine_angle, glm::dot(direction, forward));
    }
    outlook.visible_share = static_cast<double>(visible) / static_cast<double>(tiles_.probes(0).size());
    if (visible == 0) least_cosine_angle = glm::dot(tiles_.middle(tile_of(item)), forward);
    outlook.off_axis_rad = std::acos(std::clamp(least_cosine_angle, -1.0, 1.0));
}

double ShellClient::share_beyond_view(const ShellMoment& moment) const {
    int beyond = 0;
    for (const Pose& pose : {moment.shown_middle, moment.shown_until}) {
        const Camera display = at_pose(display_, pose);
        for (int y = 0; y < kDisplayProbes; ++y) {
            for (int x = 0; x < kDisplayProbes; ++x) {
                const glm::dvec3 direction =
                    direction_at(display, (x + 0.5) / kDisplayProbes, (y + 0.5) / kDisplayProbes);
                beyond += seen_by_view(direction) ? 0 : 1;
            }
        }
    }
    return beyond / (2.0 * kDisplayProbes * kDisplayProbes);
}

// Of the view's two sides the one that is more wrong.
PredictedError ShellClient::predicted(std::size_t index, const ShellMoment& moment, ItemOutlook& worst) const {
    worst = outlook(index, items_[index], moment);
    const PredictedError error = predicted_error(worst, settings_.weights);
    if (index != kView || other_side_.layer == nullptr) return error;
    const ItemOutlook other = outlook(index, other_side_, moment);
    const PredictedError other_error = predicted_error(other, settings_.weights);
    if (other_error.sum() <= error.sum()) return error;
    worst = other;
    return other_error;
}

// `item` as it was drawn: items_[index], or the view's other side.
ItemOutlook ShellClient::outlook(std::size_t index, const Item& item, const ShellMoment& moment) const {
    ItemOutlook outlook;
    outlook.display_px = index == kView ? pixel_count(display_) : tiles_.display_pixels();
    if (index == kView && other_side_.layer != nullptr) outlook.display_px *= 0.5;
    judge_visibility(index, moment, outlook);
    outlook.is_view = index == kView;
    outlook.drawn = item.layer != nullptr && !item.outdated;
    if (!outlook.drawn) return outlook;
    const LayerStatistics& drawn = item.statistics;
    const double display_px_per_px = outlook.display_px / pixel_count(item.layer->camera);
    const Pose& drawn_from = item.layer->camera.world_from_eye;
    outlook.eye_moved_m = std::max(glm::distance(moment.shown_middle.position_m, drawn_from.position_m),
                                   glm::distance(moment.shown_until.position_m, drawn_from.position_m));
    outlook.gap_px_per_m = drawn.gap_px_per_m * display_px_per_px;
    outlook.typical_m = drawn.typical_ray_m;
    outlook.mover_px = drawn.mover_px * display_px_per_px;
    outlook.age_s = moment.now_s - item.drawn_s;
    if (settings_.hole_feedback) outlook.measured_holes_px = item.holes_px;
    // The view is drawn from where the eye is, so the shell beyond it holds the overlap.
    const std::size_t shell = shell_of(index);
    if (index != kView && shell > 0) outlook.overlap_m = ranges_[shell - 1].overlap_m;
    if (index == kView) outlook.beyond_edge_share = share_beyond_view(moment);
    // Where the item holds nothing it cannot be wrong.
    const double filled = drawn.filled_px / pixel_count(item.layer->camera);
    outlook.display_px *= filled;
    if (filled > 0.0 && index == kView) outlook.beyond_edge_share /= std::max(filled, 0.25);
    return outlook;
}

double ShellClient::guessed_cost_ms(std::size_t item) const {
    const double share = tiles_.display_pixels() / pixel_count(display_);
    const double samples = pixel_count(camera_of(item, {})) * static_cast<double>(samples_of(item)) *
                           static_cast<double>(samples_of(item));
    return modelled_cost_ms(share * main_view_triangles_, samples, main_view_covered_ * samples);
}

// Drawing.

// Keeps what the other side is shown from, and says what share of the view `layer` is.
double ShellClient::begin_view(Layer& layer, const ShellMoment& moment) {
    other_side_ = plan_.one_side ? std::move(items_[kView]) : Item{};
    items_[kView] = {};
    side_ = plan_.one_side ? next_side_ : ViewSide::whole;
    if (side_ != ViewSide::whole) layer.name += side_ == ViewSide::left ? "-left" : "-right";
    return share_of(layer.camera, whole_view(plan_, moment));
}

double ShellClient::draw_item(std::size_t index, const ShellMoment& moment) {
    const TimePoint begin = settings_.clock != nullptr ? settings_.clock->now() : TimePoint{};
    std::shared_ptr<Layer> layer = pool_.acquire();
    layer->name = name_of(index);
    layer->camera = camera_of(index, moment);
    layer->pose_sampled = moment.pose_sampled;
    layer->scene_time_s = moment.scene_time_s;
    const ScenePart part = part_of(index);
    const int samples = samples_of(index);
    renderer_.set_reveal_margin(std::max(moment.head_motion_m, index == kView ? 0.0 : kTileReveal_m));
    layer->empty_pixels = renderer_.draw_part(layer->camera, layer->scene_time_s, samples, part, layer->cpu());
    add(counters_, renderer_.counters());
    ViewCosts::Drawn drawn;
    drawn.triangles = static_cast<double>(renderer_.counters().triangles_drawn);
    drawn.samples = pixel_count(layer->camera) * samples * samples;
    renderer_.mover_placements(layer->scene_time_s, layer->movers);
    Item& item = items_[index];
    if (index == kView) drawn.share = begin_view(*layer, moment);
    item.statistics = statistics_of(*layer);
    layer->content = {static_cast<std::uint32_t>(index), static_cast<std::uint16_t>(shell_of(index)),
                      item.statistics.mover_px == 0.0, item.statistics.nearest_depth, item.statistics.nearest_ray_m};
    drawn.covered = item.statistics.surface_px * samples * samples;
    if (index == kView && source_.layers == 2 && plan_.hidden) {
        const std::shared_ptr<Layer> hidden = draw_hidden(*layer, moment);
        add(counters_, renderer_.counters());
        drawn.hidden_triangles = static_cast<double>(renderer_.counters().triangles_drawn);
        drawn.hidden_covered =
            (pixel_count(hidden->camera) - static_cast<double>(hidden->empty_pixels)) * samples * samples;
        item.hidden = hidden;
    }
    double cost_ms = ViewCosts::modelled_ms(drawn);
    if (settings_.clock != nullptr) cost_ms = to_ms(settings_.clock->now() - begin);
    if (prepare_) prepare_(layer);
    item.layer = std::move(layer);
    item.drawn_s = moment.now_s;
    item.outdated = false;
    item.holes_px = 0.0;
    item.hole_frames = 0.0;
    if (index == kView) {
        view_costs_.learn(drawn, cost_ms);
    } else {
        costs_.learn(index, cost_ms);
    }
    return cost_ms;
}

std::shared_ptr<Layer> ShellClient::draw_hidden(const Layer& first, const ShellMoment& moment) {
    std::shared_ptr<Layer> hidden = pool_.acquire();
    draw_hidden_layer(renderer_, first, source_.samples_per_axis, moment.head_motion_m, *hidden, part_of(kView));
    hidden->content.item = kView;
    hidden->name = first.name + "-hidden";
    if (prepare_) prepare_(hidden);
    return hidden;
}

void ShellClient::warm_up(const ShellMoment& moment) {
    learn_main_view(moment);
    set_ranges(distances_around(moment), moment);
    choose_outer_quality(budget_ms(moment));
    plan_ = {1.0, source_.layers == 2};
    for (std::size_t item = 0; item < item_count(); ++item) (void)draw_item(item, moment);
}

void ShellClient::take(const HoleFeedback& feedback) {
    if (feedback.display_frames == 0) return;
    const double frames = feedback.display_frames;
    for (std::size_t i = 0; i < item_count(); ++i) {
        Item& item = items_[i];
        const double holes = i < feedback.holes_px.size() ? feedback.holes_px[i] : 0.0;
        item.holes_px = (item.holes_px * item.hole_frames + holes) / (item.hole_frames + frames);
        item.hole_frames += frames;
    }
}

std::vector<std::shared_ptr<const Layer>> ShellClient::draw(const ShellMoment& moment) {
    if (ranges_.empty()) warm_up(moment);
    reconsider_ranges(moment);
    counters_ = {};
    ShellFrameRecord record;
    record.now_s = moment.now_s;
    record.budget_ms = budget_ms(moment);
    BudgetSettings budget{kEnoughOfTheBudget * record.budget_ms};
    budget.max_age_s = settings_.max_age_s;
    plan_extent(moment);
    std::vector<DrawCandidate> candidates(item_count());
    std::vector<PredictedError> errors(item_count());
    const auto judge = [&](std::size_t i) {
        ItemOutlook item;
        errors[i] = predicted(i, moment, item);
        // What nobody sees may wait.
        const double waiting_s = item.visible_share > 0.0 ? item.age_s : 0.0;
        candidates[i] = {i, errors[i].sum() * error_weight(item, settings_.weights), expected_ms(i, moment), waiting_s};
    };
    for (std::size_t i = kView + 1; i < item_count(); ++i) judge(i);
    saved_for_tiles_ms_ =
        std::min(saved_for_tiles_ms_ + kSavedForTiles * record.budget_ms, kMostForTiles * record.budget_ms);
    const double for_tiles_ms = needed_by_tiles_ms(std::span{candidates}.subspan(kView + 1), budget);
    plan_view(moment, std::min(kMostForTheView * record.budget_ms, budget.budget_ms - for_tiles_ms));
    judge(kView);
    for (const DrawCandidate& candidate : candidates) record.all_ms += candidate.cost_ms;
    for (const DrawCandidate& candidate : candidates) {
        record.invalid += candidate.priority >= budget.least_error_px ? 1 : 0;
    }
    for (const std::size_t index : choose_items(candidates, budget)) {
        // What was drawn may have cost more than expected.
        const bool fits = record.spent_ms + candidates[index].cost_ms <= record.budget_ms;
        if (!record.draws.empty() && !fits) continue;
        const double age_s = items_[index].layer != nullptr ? moment.now_s - items_[index].drawn_s : 0.0;
        const double cost_ms = draw_item(index, moment);
        record.spent_ms += cost_ms;
        if (index != kView) saved_for_tiles_ms_ = std::max(saved_for_tiles_ms_ - cost_ms, 0.0);
        record.draws.push_back({static_cast<std::uint32_t>(index), name_of(index), errors[index].reason(),
                                candidates[index].priority, cost_ms, age_s});
    }
    records_.push_back(std::move(record));
    return layers();
}

// Tiles of the nearest shell stand in for the view past its edge, and where it sees nothing; drawn from elsewhere they
// may show that whichever way they look. The server leaves out what is not in view.
bool ShellClient::is_shown(std::size_t index) const {
    const Item& item = items_[index];
    return item.layer != nullptr && (index == kView || item.statistics.filled_px > 0.0);
}

std::vector<std::shared_ptr<const Layer>> ShellClient::layers() const {
    std::vector<std::shared_ptr<const Layer>> layers{items_[kView].layer};
    if (items_[kView].hidden != nullptr) layers.push_back(items_[kView].hidden);
    for (const auto& older : {other_side_.layer, other_side_.hidden}) {
        if (older != nullptr) layers.push_back(older);
    }
    const std::size_t first_outer = 1 + static_cast<std::size_t>(tiles_.count());
    const auto append = [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            if (is_shown(i)) layers.push_back(items_[i].layer);
        }
    };
    append(first_outer, item_count());
    append(1, std::min(first_outer, item_count()));
    return layers;
}

}  // namespace lw
