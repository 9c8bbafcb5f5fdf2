#include "warp_server/methods/surface_canvas.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "core/colour.h"
#include "warp_server/methods/linear_colour.h"
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

float SurfaceCanvas::sort_fragments(std::int32_t newest, float opaque_depth) {
    const auto goes_before = [](const Fragment& a, const Fragment& b) {
        if (a.depth != b.depth) return a.depth > b.depth;
        return std::tie(a.coverage, a.linear.x, a.linear.y, a.linear.z) >
               std::tie(b.coverage, b.linear.x, b.linear.y, b.linear.z);
    };
    sorted_.clear();
    float covered = 0.0F;
    for (std::int32_t i = newest; i >= 0; i = fragments_[static_cast<std::size_t>(i)].next) {
        const Fragment& fragment = fragments_[static_cast<std::size_t>(i)];
        if (fragment.depth < opaque_depth) continue;
        covered += fragment.coverage;
        sorted_.push_back(&fragment);  // insertion: there are two or three
        for (std::size_t at = sorted_.size() - 1; at > 0 && goes_before(fragment, *sorted_[at - 1]); --at) {
            std::swap(sorted_[at], sorted_[at - 1]);
        }
    }
    return covered;
}

// Nearest first, each over what is behind it; the farthest surface takes what is left, because the surfaces of one
// place fill it together.
void SurfaceCanvas::composite(std::size_t touched) {
    const std::size_t pixel = first_index_ + touched;
    Rgba8& colour = frame_->colour.pixels()[pixel];
    const float opaque_depth = frame_->depth.pixels()[pixel];
    const bool has_opaque = opaque_depth >= 0.0F;
    const float covered = sort_fragments(newest_[touched], opaque_depth);
    newest_[touched] = -1;
    if (sorted_.empty() || (!has_opaque && covered < 0.5F)) return;
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
        const std::array<float, 256>& linear = linear_from_srgb8_table();
        sum += left * static_cast<float>(kLinearOne) * glm::vec3{linear[colour.r], linear[colour.g], linear[colour.b]};
        if (left >= largest_share) depth = opaque_depth;
    }
    const std::array<std::uint8_t, kLinearOne + 1>& encode = srgb8_from_linear15_table();
    const auto encoded = [&](float linear) {
        return encode[static_cast<std::size_t>(std::clamp(linear + 0.5F, 0.0F, static_cast<float>(kLinearOne)))];
    };
    colour = {encoded(sum.x), encoded(sum.y), encoded(sum.z), 255};
    frame_->depth.pixels()[pixel] = depth;
}

}  // namespace lw
