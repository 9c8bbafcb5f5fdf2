#include "warp_server/layer_composition.h"

#include <algorithm>
#include <array>

#include "core/camera_picture.h"
#include "core/check.h"
#include "warp_server/held_depths.h"
#include "warp_server/methods/depth_rows.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/stepped_warp.h"

namespace lw {
namespace {

// Two pictures of one surface, taken from different places, differ in depth by what a pixel covers. Things that lie
// closer together than this hardly shift against each other.
constexpr float kSameSurface = 0.005F;

// Of the target's pixels: fewer are left to the fill rather than to an old tile, which costs as many patches as it has.
constexpr double kWorthATile = 0.002;

constexpr std::array<Rgba8, 4> kShellColours{{{230, 60, 50}, {60, 180, 75}, {50, 110, 230}, {230, 190, 40}}};

Rgba8 mixed(Rgba8 a, Rgba8 b) {
    const auto half = [](int x, int y) { return static_cast<std::uint8_t>((x + y) / 2); };
    return {half(a.r, b.r), half(a.g, b.g), half(a.b, b.b), a.a};
}

Rgba8 colour_of(const Layer& layer) { return kShellColours[layer.content.shell % kShellColours.size()]; }

bool is_beside_view(const Layer& layer, const Layer& view) {
    return layer.content.shell == 0 && layer.content.item != view.content.item;
}

bool is_side_of(const Layer& layer, const Layer& view) {
    return &layer != &view && layer.content.shell == 0 && layer.content.item == view.content.item;
}

// A view that covers the corners covers all between them.
bool covers_all(const ViewCover& cover, const Camera& target) {
    const glm::ivec2 last = target.size_px - 1;
    return cover.covers(0, 0) && cover.covers(last.x, 0) && cover.covers(0, last.y) && cover.covers(last.x, last.y);
}

// What lies behind the view comes before the next shell, and older tiles come last.
float depth_share_of(const Layer& layer, const Layer& view) {
    const bool is_view = &layer == &view;
    const float rank = is_beside_view(layer, view) ? 4.0F : static_cast<float>(layer.content.shell) + 1.0F;
    return is_view ? 1.0F : 1.0F - 0.5F * kSameSurface * rank;
}

StackedLayer stacked(const Layer& layer, const Layer& view, const Camera& target) {
    const bool is_view = &layer == &view;
    const PixelRect reach = is_view ? PixelRect{{0, 0}, target.size_px} : reach_of(layer, target);
    return {&layer, depth_share_of(layer, view), reach, nearest_target_depth(layer, target)};
}

// Pixels that hold nothing are not bad.
WarpCounters without_empty(WarpCounters counters, const Layer& layer) {
    counters.bad_depth -= std::min(counters.bad_depth, layer.empty_pixels);
    return counters;
}

// Pixels of the tile's reach that show nothing, or something behind it where the view does not look.
std::size_t missing_for(const StackedLayer& tile, std::span<const ViewedRow> rows, const DepthImage& shown) {
    std::size_t missing = 0;
    const PixelRect& reach = tile.reach;
    for (int y = reach.first_px.y; y < reach.end_px.y; ++y) {
        const ViewedRow& viewed = rows[static_cast<std::size_t>(y)];
        const float* depths = shown.row(y).data();
        const int first = std::clamp(viewed.first, reach.first_px.x, reach.end_px.x);
        const int end = std::clamp(viewed.end, first, reach.end_px.x);
        const auto count = [&](int from, int until, float depth) {
            return from < until ? count_below(depths + from, static_cast<std::size_t>(until - from), depth) : 0;
        };
        if (viewed.holes > 0) missing += count(first, end, 0.0F);
        missing += count(reach.first_px.x, first, tile.nearest_depth) + count(end, reach.end_px.x, tile.nearest_depth);
    }
    return missing;
}

void merge_nearest(const DisplayFrame& layer, glm::ivec2 at_px, DisplayFrame& into) {
    for (int y = 0; y < layer.depth.height(); ++y) {
        const std::span<const Coverage> coverage = layer.coverage.row(y);
        const std::span<const float> depth = layer.depth.row(y);
        const std::span<const Rgba8> colour = layer.colour.row(y);
        const auto first = static_cast<std::size_t>(at_px.x);
        const std::span<Coverage> into_coverage = into.coverage.row(at_px.y + y).subspan(first, coverage.size());
        const std::span<float> into_depth = into.depth.row(at_px.y + y).subspan(first, depth.size());
        const std::span<Rgba8> into_colour = into.colour.row(at_px.y + y).subspan(first, colour.size());
        for (std::size_t x = 0; x < coverage.size(); ++x) {
            if (coverage[x] != Coverage::reached) continue;
            const bool hidden =
                into_coverage[x] == Coverage::reached && into_depth[x] >= depth[x] * (1.0F - kSameSurface);
            if (hidden) continue;
            into_colour[x] = colour[x];
            into_depth[x] = depth[x];
            into_coverage[x] = Coverage::reached;
        }
    }
}

}  // namespace

// What was drawn of the view in other frames and is still shown; hidden layers cover no more than what they lie behind.
void LayerComposition::find_sides(std::span<const Layer* const> layers) {
    sides_.clear();
    for (const Layer* layer : layers) {
        if (is_side_of(*layer, *layers.front())) sides_.push_back(layer);
    }
}

const ViewCover& LayerComposition::cover_of(const Layer& view, const Camera& target) {
    cover_.clear();
    cover_.add(view.camera, target);
    for (const Layer* side : sides_) {
        if (!(side->camera == view.camera)) cover_.add(side->camera, target);
    }
    return cover_;
}

WarpCounters LayerComposition::show(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                                    DisplayFrame& into) {
    find_sides(layers);
    const WarpCounters counters = show_found(method, layers, target, into);
    sides_.clear();
    return counters;
}

WarpCounters LayerComposition::show_found(WarpMethod& method, std::span<const Layer* const> layers,
                                          const WarpTarget& target, DisplayFrame& into) {
    const Layer& view = *layers.front();
    WarpCounters counters;
    if (layers.size() > 1 && method.can_stack() && !false_colours_) {
        show_stack(method, layers, target, into, counters);
        return counters;
    }
    method.warp(view, target, into);
    counters = without_empty(method.counters(), view);
    tint(view, into);
    WarpTarget shown = target;
    if (method.shows_frames_as_drawn()) shown.camera.world_from_eye = view.camera.world_from_eye;
    for (const Layer* layer : layers.subspan(1)) {
        if (const auto left_out = add(method, *layer, view, shown, into)) counters += *left_out;
    }
    return counters;
}

void LayerComposition::show_stack(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                                  DisplayFrame& into, WarpCounters& counters) {
    stack_all(layers, target);
    method.warp_stack(stack_, target, StackBase::nothing, into);
    counters += counters_of_stack(method);
    if (!begin_beside_view(*layers.front(), target, into)) return;
    method.warp_stack(stack_, target, StackBase::picture, into);
    counters += counters_of_stack(method);
    finish_beside_view(into);
}

void LayerComposition::begin_steps(WarpMethod& method, std::span<const Layer* const> layers, const WarpTarget& target,
                                   int bands, DisplayFrame& into) {
    LW_CHECK(!false_colours_, "false colours say of what layer a pixel is: layers are drawn one by one");
    steps_ = {&method, layers.front(), target, bands, &into, {}, false};
    find_sides(layers);
    stack_all(layers, target);
    dynamic_cast<SteppedWarp&>(method).begin_stack(stack_, target, StackBase::nothing, bands, into);
}

bool LayerComposition::next_stage() {
    auto& stepped = dynamic_cast<SteppedWarp&>(*steps_.method);
    stepped.finish_stack();
    steps_.counters += counters_of_stack(*steps_.method);
    if (steps_.is_last) {
        finish_beside_view(*steps_.into);
        return false;
    }
    if (!begin_beside_view(*steps_.view, steps_.target, *steps_.into)) return false;
    steps_.is_last = true;
    stepped.begin_stack(stack_, steps_.target, StackBase::picture, steps_.bands, *steps_.into);
    return true;
}

WarpCounters LayerComposition::counters_of_stack(const WarpMethod& method) const {
    WarpCounters counters = method.counters();
    for (const StackedLayer& layer : stack_) counters = without_empty(counters, *layer.layer);
    return counters;
}

// All but those that stand in past the view's edges.
void LayerComposition::stack_all(std::span<const Layer* const> layers, const WarpTarget& target) {
    const Layer& view = *layers.front();
    stack_.clear();
    beside_view_.clear();
    for (const Layer* layer : layers) {
        if (is_beside_view(*layer, view)) {
            beside_view_.push_back(layer);
            continue;
        }
        const StackedLayer placed = stacked(*layer, view, target.camera);
        if (!placed.reach.empty()) stack_.push_back(placed);
    }
}

// Stacks those that do, where they have something to show, and holds what must not change. False where none has.
bool LayerComposition::begin_beside_view(const Layer& view, const WarpTarget& target, DisplayFrame& into) {
    if (beside_view_.empty()) return false;
    float farthest_near = 0.0F;
    for (const StackedLayer& layer : stack_) {
        if (layer.layer->content.shell > 0) farthest_near = std::max(farthest_near, layer.nearest_depth);
    }
    stack_.clear();
    const auto worth_it = static_cast<std::size_t>(std::max(kWorthATile * pixel_count(target.camera), 1.0));
    if (look_where_view_looks(view, target.camera, into.depth) < worth_it) return false;
    for (const Layer* tile : beside_view_) {
        const StackedLayer placed = stacked(*tile, view, target.camera);
        if (missing_for(placed, viewed_rows_, into.depth) >= worth_it) stack_.push_back(placed);
    }
    if (stack_.empty()) return false;
    hold_what_the_view_shows(farthest_near, into);
    return true;
}

// How many pixels tiles may be wanted for: those that show nothing, and all where the view does not look.
std::size_t LayerComposition::look_where_view_looks(const Layer& view, const Camera& target, const DepthImage& shown) {
    const ViewCover& cover = cover_of(view, target);
    const int width = shown.width();
    viewed_rows_.resize(static_cast<std::size_t>(shown.height()));
    std::size_t open = 0;
    for (int y = 0; y < shown.height(); ++y) {
        const auto [first, end] = cover.columns(y, width);
        const auto columns = static_cast<std::size_t>(end - first);
        const std::size_t holes = count_below(shown.row(y).data() + first, columns, 0.0F);
        viewed_rows_[static_cast<std::size_t>(y)] = {first, end, holes};
        open += holes + static_cast<std::size_t>(width) - columns;
    }
    return open;
}

void LayerComposition::hold_what_the_view_shows(float farthest, DisplayFrame& into) {
    shown_depth_ = into.depth;
    for (int y = 0; y < into.depth.height(); ++y) {
        const ViewedRow& viewed = viewed_rows_[static_cast<std::size_t>(y)];
        hold_depths(into.depth.row(y).data() + viewed.first, static_cast<std::size_t>(viewed.end - viewed.first),
                    farthest);
    }
}

void LayerComposition::finish_beside_view(DisplayFrame& into) const {
    for (int y = 0; y < into.depth.height(); ++y) {
        const ViewedRow& viewed = viewed_rows_[static_cast<std::size_t>(y)];
        release_depths(into.depth.row(y).data() + viewed.first, shown_depth_.row(y).data() + viewed.first,
                       static_cast<std::size_t>(viewed.end - viewed.first));
    }
}

// Of a frame shown as it was drawn, `target` looks as its view does: what was drawn from elsewhere is turned to that.
WarpCounters LayerComposition::warp_into_scratch(WarpMethod& method, const Layer& layer, const WarpTarget& target) {
    if (!method.shows_frames_as_drawn()) {
        method.warp(layer, target, scratch_);
        return without_empty(method.counters(), layer);
    }
    WarpCounters counters;
    resample_by_rotation(layer, method.label(), target.camera, scratch_, counters);
    return without_empty(counters, layer);
}

std::optional<WarpCounters> LayerComposition::add(WarpMethod& method, const Layer& layer, const Layer& view,
                                                  const WarpTarget& target, DisplayFrame& into) {
    PixelRect rect = reach_of(layer, target.camera);
    if (rect.empty()) return std::nullopt;
    if (is_beside_view(layer, view)) {
        const ViewCover& cover = cover_of(view, target.camera);
        // Where the view covers all, only holes count, and no pixel need be asked.
        const MissingPixels missing = missing_in(into, rect, covers_all(cover, target.camera) ? 0.0F : 1.0F, cover);
        if (static_cast<double>(missing.count) < kWorthATile * pixel_count(target.camera)) return std::nullopt;
        rect = missing.rect;
    } else if (layer.content.static_only) {
        const MissingPixels missing = missing_in(into, rect, nearest_target_depth(layer, target.camera));
        if (missing.count == 0) return std::nullopt;
        rect = missing.rect;
    }
    const bool all = rect.size_px() == target.camera.size_px;
    const WarpTarget part{all ? target.camera : part_of(target.camera, rect), target.movers, target.eye};
    const WarpCounters left_out = warp_into_scratch(method, layer, part);
    if (false_colours_) tint(layer, scratch_);
    merge_nearest(scratch_, rect.first_px, into);
    return left_out;
}

void LayerComposition::tint(const Layer& layer, DisplayFrame& frame) const {
    if (!false_colours_) return;
    for (Rgba8& colour : frame.colour.pixels()) colour = mixed(colour, colour_of(layer));
}

}  // namespace lw
