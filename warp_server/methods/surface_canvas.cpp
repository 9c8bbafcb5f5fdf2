#include "warp_server/methods/surface_canvas.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "core/colour.h"
#include "warp_server/methods/surface_kernels.h"

namespace lw {

void SurfaceCanvas::begin(DisplayFrame& out, RowRange band) {
    frame_ = &out;
    band_ = band;
    const auto width = static_cast<std::size_t>(out.depth.width());
    first_index_ = static_cast<std::size_t>(band.begin) * width;
    const std::size_t count = static_cast<std::size_t>(band.end - band.begin) * width;
    std::memset(out.depth.pixels().data() + first_index_, kNothingByte, count * sizeof(float));
    fragments_.clear();
    touched_.clear();
    if (newest_.size() != count) newest_.assign(count, -1);  // else finish() left it clear
}

void SurfaceCanvas::finish() {
    for (const std::uint32_t touched : touched_) composite(touched);
    mark_coverage(frame_->depth.pixels().data() + first_index_, newest_.size(),
                  frame_->coverage.pixels().data() + first_index_);
}

// Nearest first, each over what is behind it; the farthest surface takes what is left, because the surfaces of one
// place fill it together.
void SurfaceCanvas::composite(std::size_t touched) {
    const std::size_t pixel = first_index_ + touched;
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const bool has_opaque = opaque_depth >= 0.0F;
    sorted_.clear();
    float covered = has_opaque ? 1.0F : 0.0F;
    for (std::int32_t i = newest_[touched]; i >= 0; i = fragments_[static_cast<std::size_t>(i)].next) {
        const Fragment& fragment = fragments_[static_cast<std::size_t>(i)];
        if (fragment.depth < opaque_depth) continue;
        sorted_.push_back(&fragment);
        covered += fragment.coverage;
    }
    newest_[touched] = -1;
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
