#include "warp_server/methods/surface_fragments.h"

namespace lw {

void SurfaceFragments::begin(std::size_t pixels) {
    chunks_ = 1;
    ends_.assign((pixels + kStretch - 1) >> kStretchBits, 0);
}

std::uint32_t SurfaceFragments::begin_chunk(std::uint32_t end_before) {
    const std::uint32_t chunk = chunks_++;
    if (ends_before_.size() < chunks_) {
        ends_before_.resize(std::size_t{2} * chunks_);
        fragments_.resize(ends_before_.size() * kChunk);
    }
    ends_before_[chunk] = end_before;
    return chunk * kChunk;
}

}  // namespace lw
