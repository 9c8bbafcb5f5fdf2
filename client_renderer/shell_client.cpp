#include "client_renderer/shell_client.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "client_renderer/hidden_layer.h"
#include "core/camera_picture.h"
#include "core/check.h"

namespace lw {
namespace {

constexpr std::size_t kMostShells = 4;
// The distances around the viewer are taken from six small pictures of everything.
constexpr int kProbePx = 64;
// Of the budget: the view is drawn less finely where it would take more.
constexpr double kMostForTheView = 0.93;
// Tiles hold what an eye that moves by so much may see; what it sees beyond, the server reports. At 2.8 m, as far as
// shells overlap in `city`, hardly anything hides anything, and a tile took more than the budget.
constexpr double kTileReveal_m = 0.5;
// Of the nearest shell's reach: so far the head walks before its ranges are thought over.
constexpr double kReconsiderRanges = 0.5;
// Of the budget: outer tiles that would take more are drawn less densely, and with fewer samples.
constexpr double kMostForATile = 0.5;
constexpr double kEnoughOfTheBudget = 0.95;  // costs vary: this much of it is planned with

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
      view_{display, source},
      drawn_tiles_(kMostShells * static_cast<std::size_t>(tiles_.count())),
      costs_{1 + drawn_tiles_.size()},
      main_view_{settings.clock} {}

// What an item is.

ShellItem& ShellClient::tile(std::size_t item) {
    LW_CHECK(item != kView, "the view is no tile");
    return drawn_tiles_[item - 1];
}

const ShellItem& ShellClient::item(std::size_t item) const {
    return item == kView ? view_.newest() : drawn_tiles_[item - 1];
}

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
    if (item == kView) return view_.camera();
    const ShellTiles& tiles = shell_of(item) > 0 && outer_dense_ ? outer_tiles_ : tiles_;
    return tiles.camera(tile_of(item), moment.shown_middle.position_m);
}

int ShellClient::samples_of(std::size_t item) const {
    return shell_of(item) == 0 ? source_.samples_per_axis : outer_samples_;
}

// What items cost, and how finely outer ones are drawn.

double ShellClient::expected_ms(std::size_t item) const {
    return item == kView ? view_.expected_ms() : costs_.expected_ms(item, guessed_cost_ms(item));
}

double ShellClient::guessed_cost_ms(std::size_t item) const {
    const double share = tiles_.display_pixels() / pixel_count(display_);
    return main_view_.modelled_ms(camera_of(item, {}), samples_of(item), share);
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
    view_.outdate();
    for (std::size_t i = 0; i < drawn_tiles_.size(); ++i) {
        drawn_tiles_[i].outdated = true;
        if (1 + i >= item_count()) drawn_tiles_[i] = {};
    }
}

// After a walk through half of the nearest shell, from what the items hold: no picture is drawn for it.
void ShellClient::reconsider_ranges(const ShellMoment& moment) {
    const double walked_m = glm::distance(moment.shown_middle.position_m, ranges_from_);
    if (walked_m < kReconsiderRanges * ranges_[0].farthest_m) return;
    std::vector<double> distances_m;
    for (std::size_t i = kView + 1; i < item_count(); ++i) {
        const std::vector<double>& seen_m = item(i).statistics.ray_m;
        distances_m.insert(distances_m.end(), seen_m.begin(), seen_m.end());
    }
    set_ranges(distances_m, moment);
}

double ShellClient::budget_ms(const ShellMoment& moment) const {
    if (settings_.budget_ms) return *settings_.budget_ms;
    if (moment.main_view_ms) return *moment.main_view_ms;
    return main_view_.expected_ms(moment.source, source_.samples_per_axis);
}

// What is expected of an item.

void ShellClient::judge_visibility(std::size_t item, const ShellMoment& moment, ItemOutlook& outlook) const {
    const glm::dvec3 forward = moment.shown_middle.orientation * glm::dvec3{0.0, 0.0, -1.0};
    if (item == kView) {
        outlook.visible_share = 1.0;
        return;
    }
    const Camera views[] = {at_pose(display_, moment.shown_from), at_pose(display_, moment.shown_middle),
                            at_pose(display_, moment.shown_until)};
    const Camera view = view_.whole();
    const bool nearest_shell = shell_of(item) == 0;
    int visible = 0;
    double least_cosine_angle = -1.0;
    for (const glm::dvec3& direction : tiles_.probes(tile_of(item))) {
        const bool seen =
            std::any_of(std::begin(views), std::end(views), [&](const Camera& c) { return sees(c, direction); });
        // The nearest shell's tiles stand in where its view ends, the others where it has nothing.
        const bool shown_by_view =
            nearest_shell ? sees(view, direction) : view_.depth_at(direction).value_or(0.0F) > 0.0F;
        if (!seen || shown_by_view) continue;
        ++visible;
        least_cosine_angle = std::max(least_cosine_angle, glm::dot(direction, forward));
    }
    outlook.visible_share = static_cast<double>(visible) / static_cast<double>(tiles_.probes(0).size());
    if (visible == 0) least_cosine_angle = glm::dot(tiles_.middle(tile_of(item)), forward);
    outlook.off_axis_rad = std::acos(std::clamp(least_cosine_angle, -1.0, 1.0));
}

// Of the view's two sides the one that is more wrong.
ItemOutlook ShellClient::outlook(std::size_t index, const ShellMoment& moment) const {
    const ItemOutlook newest = outlook_of(item(index), index, moment);
    if (index != kView || !view_.has_two_sides()) return newest;
    const ItemOutlook other = outlook_of(view_.other_side(), index, moment);
    const auto error_px = [&](const ItemOutlook& side) { return predicted_error(side, settings_.weights).sum(); };
    return error_px(other) > error_px(newest) ? other : newest;
}

// `item` as it was drawn: item(index), or the view's other side.
ItemOutlook ShellClient::outlook_of(const ShellItem& item, std::size_t index, const ShellMoment& moment) const {
    ItemOutlook outlook;
    outlook.display_px = index == kView ? pixel_count(display_) : tiles_.display_pixels();
    if (index == kView && view_.has_two_sides()) outlook.display_px *= 0.5;
    judge_visibility(index, moment, outlook);
    outlook.is_view = index == kView;
    outlook.drawn = item.is_valid();
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
    if (index == kView) outlook.beyond_edge_share = view_.share_beyond();
    // Where the item holds nothing it cannot be wrong.
    const double filled = drawn.filled_px / pixel_count(item.layer->camera);
    outlook.display_px *= filled;
    if (filled > 0.0 && index == kView) outlook.beyond_edge_share /= std::max(filled, 0.25);
    return outlook;
}

// Drawing.

std::shared_ptr<Layer> ShellClient::draw_layer(std::size_t index, const ShellMoment& moment) {
    std::shared_ptr<Layer> layer = pool_.acquire();
    layer->name = name_of(index);
    layer->camera = camera_of(index, moment);
    layer->pose_sampled = moment.pose_sampled;
    layer->scene_time_s = moment.scene_time_s;
    renderer_.set_reveal_margin(std::max(moment.head_motion_m, index == kView ? 0.0 : kTileReveal_m));
    layer->empty_pixels =
        renderer_.draw_part(layer->camera, layer->scene_time_s, samples_of(index), part_of(index), layer->cpu());
    add(counters_, renderer_.counters());
    return layer;
}

double ShellClient::draw_item(std::size_t index, const ShellMoment& moment) {
    const TimePoint begin = settings_.clock != nullptr ? settings_.clock->now() : TimePoint{};
    const std::shared_ptr<Layer> layer = draw_layer(index, moment);
    const double samples_per_px = samples_of(index) * samples_of(index);
    ViewCosts::Drawn drawn;
    drawn.triangles = static_cast<double>(renderer_.counters().triangles_drawn);
    drawn.samples = pixel_count(layer->camera) * samples_per_px;
    renderer_.mover_placements(layer->scene_time_s, layer->movers);
    ShellItem& item = index == kView ? view_.begin(*layer) : tile(index);
    item.statistics = statistics_of(*layer);
    layer->content = {static_cast<std::uint32_t>(index), static_cast<std::uint16_t>(shell_of(index)),
                      item.statistics.mover_px == 0.0, item.statistics.nearest_depth, item.statistics.nearest_ray_m};
    drawn.covered = item.statistics.surface_px * samples_per_px;
    if (index == kView && view_.with_hidden()) {
        item.hidden = draw_hidden(*layer, moment);
        drawn.hidden_triangles = static_cast<double>(renderer_.counters().triangles_drawn);
        drawn.hidden_covered =
            (pixel_count(item.hidden->camera) - static_cast<double>(item.hidden->empty_pixels)) * samples_per_px;
    }
    double cost_ms = ViewCosts::modelled_ms(drawn);
    if (settings_.clock != nullptr) cost_ms = to_ms(settings_.clock->now() - begin);
    if (prepare_) prepare_(layer);
    item.set_layer(layer, moment.now_s);
    if (index == kView) {
        view_.learn(drawn, cost_ms);
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
    add(counters_, renderer_.counters());
    if (prepare_) prepare_(hidden);
    return hidden;
}

void ShellClient::warm_up(const ShellMoment& moment) {
    view_.plan_warm_up(moment);
    main_view_.learn(renderer_, view_.camera(), moment.scene_time_s, source_.samples_per_axis);
    view_.start_costs(main_view_.triangles(), main_view_.covered_share());
    set_ranges(distances_around(moment), moment);
    choose_outer_quality(budget_ms(moment));
    for (std::size_t item = 0; item < item_count(); ++item) (void)draw_item(item, moment);
}

void ShellClient::take(const HoleFeedback& feedback) {
    if (feedback.display_frames == 0) return;
    for (std::size_t i = 0; i < item_count(); ++i) {
        const double holes_px = i < feedback.holes_px.size() ? feedback.holes_px[i] : 0.0;
        (i == kView ? view_.newest() : tile(i)).count_holes(holes_px, feedback.display_frames);
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
    view_.look_ahead(moment, ranges_.front().farthest_m);
    std::vector<DrawCandidate> candidates(item_count());
    std::vector<PredictedError> errors(item_count());
    const auto judge = [&](std::size_t i) {
        const ItemOutlook item = outlook(i, moment);
        errors[i] = predicted_error(item, settings_.weights);
        // What nobody sees may wait.
        const double waiting_s = item.visible_share > 0.0 ? item.age_s : 0.0;
        candidates[i] = {i, errors[i].sum() * error_weight(item, settings_.weights), expected_ms(i), waiting_s};
    };
    for (std::size_t i = kView + 1; i < item_count(); ++i) judge(i);
    savings_.save(record.budget_ms);
    const double for_tiles_ms = savings_.needed_ms(std::span{candidates}.subspan(kView + 1), budget);
    view_.plan_within(std::min(kMostForTheView * record.budget_ms, budget.budget_ms - for_tiles_ms));
    judge(kView);
    for (const DrawCandidate& candidate : candidates) record.all_ms += candidate.cost_ms;
    for (const DrawCandidate& candidate : candidates) {
        record.invalid += candidate.priority >= budget.least_error_px ? 1 : 0;
    }
    for (const std::size_t index : choose_items(candidates, budget)) {
        // What was drawn may have cost more than expected.
        const bool fits = record.spent_ms + candidates[index].cost_ms <= record.budget_ms;
        if (!record.draws.empty() && !fits) continue;
        const double age_s = item(index).layer != nullptr ? moment.now_s - item(index).drawn_s : 0.0;
        const double cost_ms = draw_item(index, moment);
        record.spent_ms += cost_ms;
        if (index != kView) savings_.spend(cost_ms);
        record.draws.push_back({static_cast<std::uint32_t>(index), name_of(index), errors[index].reason(),
                                candidates[index].priority, cost_ms, age_s});
    }
    records_.push_back(std::move(record));
    return layers();
}

// Tiles of the nearest shell stand in for the view past its edge, and where it sees nothing; drawn from elsewhere they
// may show that whichever way they look. The server leaves out what is not in view.
std::vector<std::shared_ptr<const Layer>> ShellClient::layers() const {
    std::vector<std::shared_ptr<const Layer>> layers = view_.layers();
    const std::size_t first_outer = 1 + static_cast<std::size_t>(tiles_.count());
    const auto append = [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const ShellItem& tile = item(i);
            if (tile.layer != nullptr && tile.statistics.filled_px > 0.0) layers.push_back(tile.layer);
        }
    };
    append(first_outer, item_count());
    append(1, std::min(first_outer, item_count()));
    return layers;
}

}  // namespace lw
