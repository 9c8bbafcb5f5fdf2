#include "warp_server/frame_warper.h"

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
    method_->warp(*frame.layers.front(), target, display_frame_);
    for (std::size_t i = 1; i < frame.layers.size(); ++i) {
        method_->warp(*frame.layers[i], target, layer_frame_);
        merge_nearest(layer_frame_, display_frame_);
    }
    fill_->apply(display_frame_);
    return display_frame_;
}

}  // namespace lw
