#include "warp_server/methods/surface_canvas.h"

#include <algorithm>
#include <tuple>

#include "core/colour.h"

namespace lw {

void SurfaceCanvas::begin(DisplayFrame& out) {
    frame_ = &out;
    std::fill(out.depth.pixels().begin(), out.depth.pixels().end(), kNothing);
    fragments_.clear();
    touched_.clear();
    if (newest_.size_px() == out.colour.size_px()) return;  // finish() left it clear
    newest_.resize(out.colour.size_px());
    std::fill(newest_.pixels().begin(), newest_.pixels().end(), -1);
}

void SurfaceCanvas::put_fragment(int x, int y, float depth, float coverage, const glm::vec3& linear) {
    std::int32_t& newest = newest_.at(x, y);
    if (newest < 0)
        touched_.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(newest_.width()) +
                           static_cast<std::size_t>(x));
    fragments_.push_back({linear, depth, coverage, newest});
    newest = static_cast<std::int32_t>(fragments_.size()) - 1;
}

void SurfaceCanvas::finish() {
    for (const std::size_t pixel : touched_) composite(pixel);
    const std::size_t count = frame_->depth.pixels().size();
    for (std::size_t i = 0; i < count; ++i) {
        frame_->coverage.pixels()[i] = frame_->depth.pixels()[i] >= 0.0F ? Coverage::reached : Coverage::hole;
    }
}

// Nearest first, each over what is behind it; the farthest surface takes what is left, because the surfaces of one
// place fill it together.
void SurfaceCanvas::composite(std::size_t pixel) {
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const bool has_opaque = opaque_depth >= 0.0F;
    sorted_.clear();
    float covered = has_opaque ? 1.0F : 0.0F;
    for (std::int32_t i = newest_.pixels()[pixel]; i >= 0; i = fragments_[static_cast<std::size_t>(i)].next) {
        const Fragment& fragment = fragments_[static_cast<std::size_t>(i)];
        if (fragment.depth < opaque_depth) continue;
        sorted_.push_back(&fragment);
        covered += fragment.coverage;
    }
    newest_.pixels()[pixel] = -1;
    if (sorted_.empty() || covered < 0.5F) return;
    std::sort(sorted_.begin(), sorted_.end(), [](const Fragment* a, const Fragment* b) {
        return std::tie(a->depth, a->coverage, a->linear.x, a->linear.y, a->linear.z) >
               std::tie(b->depth, b->coverage, b->linear.x, b->linear.y, b->linear.z);
    });
    glm::vec3 sum{0.0F};
    float left = 1.0F;
    float largest_share = 0.0F;
    float depth = opaque_depth;
    for (const Fragment* fragment : sorted_) {
        const bool is_last = !has_opaque && fragment == sorted_.back();
        const float share = is_last ? left : left * fragment->coverage;
        sum += share * fragment->linear;
        left -= share;
        if (share > largest_share) {
            largest_share = share;
            depth = fragment->depth;
        }
    }
    if (has_opaque) {
        sum += left * linear_of(frame_->colour.pixels()[pixel]);
        if (left >= largest_share) depth = opaque_depth;
    }
    frame_->colour.pixels()[pixel] = srgb8_of(sum);
    frame_->depth.pixels()[pixel] = depth;
}

}  // namespace lw
