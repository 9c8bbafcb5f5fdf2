#include "warp_server/frame_warper.h"

#include <algorithm>

#include "core/check.h"
#include "warp_server/methods/registry.h"

namespace lw {
namespace {

// Of two reached pixels the nearer one is seen; a hole shows whatever the other layer has.
void merge_nearest(const DisplayFrame& layer, DisplayFrame& into) {
    const std::size_t count = into.coverage.pixels().size();
    for (std::size_t i = 0; i < count; ++i) {
        if (layer.coverage.pixels()[i] != Coverage::reached) continue;
        const bool hidden =
            into.coverage.pixels()[i] == Coverage::reached && into.depth.pixels()[i] >= layer.depth.pixels()[i];
        if (hidden) continue;
        into.colour.pixels()[i] = layer.colour.pixels()[i];
        into.depth.pixels()[i] = layer.depth.pixels()[i];
        into.coverage.pixels()[i] = Coverage::reached;
    }
}

}  // namespace

Result<FrameWarper> FrameWarper::create(std::string_view method, std::string_view fill) {
    Result<std::unique_ptr<WarpMethod>> made_method = make_warp_method(method);
    if (!made_method) return made_method.error();
    Result<std::unique_ptr<Fill>> made_fill = make_fill(fill);
    if (!made_fill) return made_fill.error();
    return FrameWarper{std::move(*made_method), std::move(*made_fill)};
}

void FrameWarper::prepare(Layer& layer) const {
    std::shared_ptr<const PreparedLayer> prepared = method_->prepare(layer);
    if (prepared == nullptr) return;
    for (auto& [label, existing] : layer.prepared) {
        if (label != method_->label()) continue;
        existing = std::move(prepared);
        return;
    }
    layer.prepared.emplace_back(std::string{method_->label()}, std::move(prepared));
}

const DisplayFrame& FrameWarper::warp(const RenderedFrame& frame, const WarpTarget& target) {
    LW_CHECK(!frame.layers.empty(), "a rendered frame has at least one layer");
    if (is_made_of(frame, target)) {
        counters_.pictures_reused = 1;
        return display_frame_;
    }
    method_->warp(*frame.layers.front(), target, display_frame_);
    counters_ = method_->counters();
    for (std::size_t i = 1; i < frame.layers.size(); ++i) {
        method_->warp(*frame.layers[i], target, layer_frame_);
        counters_ += method_->counters();
        merge_nearest(layer_frame_, display_frame_);
    }
    fill_->apply(display_frame_);
    remember(frame, target);
    return display_frame_;
}

bool FrameWarper::is_made_of(const RenderedFrame& frame, const WarpTarget& target) const {
    const auto same_layer = [](const std::weak_ptr<const Layer>& made, const std::shared_ptr<const Layer>& layer) {
        return !made.owner_before(layer) && !layer.owner_before(made);
    };
    return std::equal(made_.layers.begin(), made_.layers.end(), frame.layers.begin(), frame.layers.end(), same_layer) &&
           made_.camera == target.camera &&
           std::equal(made_.movers.begin(), made_.movers.end(), target.movers.begin(), target.movers.end());
}

void FrameWarper::remember(const RenderedFrame& frame, const WarpTarget& target) {
    made_.layers.assign(frame.layers.begin(), frame.layers.end());
    made_.camera = target.camera;
    made_.movers.assign(target.movers.begin(), target.movers.end());
}

}  // namespace lw
