#include "warp_server/layer_composition.h"

#include <array>

#include "warp_server/methods/homography_resample.h"

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

bool LayerComposition::add(WarpMethod& method, const Layer& layer, const Layer& view, const WarpTarget& target,
                           DisplayFrame& into) {
    PixelRect rect = reach_of(layer, target.camera);
    if (rect.empty()) return false;
    const bool beside_view = layer.content.shell == 0 && layer.content.item != view.content.item;
    if (beside_view) {
        const ViewCover cover{background_source_from_target(view.camera, target.camera), view.camera.size_px};
        // A view that covers the corners covers all between them: then only holes count, and no pixel need be asked.
        const glm::ivec2 last = target.camera.size_px - 1;
        const bool covers_all =
            cover.covers(0, 0) && cover.covers(last.x, 0) && cover.covers(0, last.y) && cover.covers(last.x, last.y);
        const MissingPixels missing = missing_in(into, rect, covers_all ? 0.0F : 1.0F, cover);
        const auto pixels = static_cast<double>(target.camera.size_px.x) * target.camera.size_px.y;
        if (static_cast<double>(missing.count) < kWorthATile * pixels) return false;
        rect = missing.rect;
    } else if (layer.content.static_only) {
        const MissingPixels missing = missing_in(into, rect, nearest_target_depth(layer, target.camera));
        if (missing.count == 0) return false;
        rect = missing.rect;
    }
    const bool all = rect.size_px() == target.camera.size_px;
    method.warp(layer, all ? target : WarpTarget{part_of(target.camera, rect), target.movers, target.eye}, scratch_);
    if (false_colours_) tint(layer, scratch_);
    merge_nearest(scratch_, rect.first_px, into);
    return true;
}

void LayerComposition::tint(const Layer& layer, DisplayFrame& frame) const {
    if (!false_colours_) return;
    for (Rgba8& colour : frame.colour.pixels()) colour = mixed(colour, colour_of(layer));
}

}  // namespace lw
