#pragma once
/// Colours between pixels for `surface`: what a pixel would show whose centre lay half a pixel further.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "warp_server/methods/linear_colour.h"

namespace lw {

/// Steps of the lattice from one pixel centre to the next.
inline constexpr int kLatticeSteps = 2;

/// A bilinear read between two pixels shows a mean of two means, which blurs whatever is about a pixel wide. Of pixels
/// whose quarters are known, the mean over the same area anywhere between them is known too: this picture holds it at
/// each pixel's centre, where it is the pixel, and half a pixel to the right, below and both. Where neighbours are of
/// different surfaces what lies between them is of none; nobody reads there.
///
/// The channels of a node lie together, so that one read takes a stretch of nodes in all of them, wherever it is.
/// Around the picture its outermost nodes count again: a read of kReadNodes nodes and rows from `before(node)` on stays
/// inside, and may take up to 4 values more of each row.
class ColourLattice {
public:
    static constexpr int kChannels = 3;   ///< red, green and blue of linear light in 15 bits
    static constexpr int kReadNodes = 4;  ///< per axis, of which a read lies between the second and the third

    ColourLattice() = default;
    /// @param linear    of w x h pixels
    /// @param quarters  their quarters (CpuPixels), 2w x 2h, whose memory this takes
    /// @param samples   that each quarter is the mean of
    ColourLattice(const LinearImage& linear, LinearImage quarters, int samples);

    /// May a read between the nodes follow a curve? Quarters of one sample have noise that it would follow: in the city
    /// PSNR was 0.2 dB less.
    [[nodiscard]] bool is_smooth() const { return is_smooth_; }
    /// In nodes, two for each pixel and axis; the first one lies at the centre of the first pixel.
    [[nodiscard]] glm::ivec2 size() const { return rows_.size_px(); }
    [[nodiscard]] bool empty() const { return size().x == 0; }
    /// Values from one row of nodes to the next.
    [[nodiscard]] std::ptrdiff_t row_stride() const { return rows_.row_stride(); }
    /// The node left of and above node (x, y), which may be in the rim.
    [[nodiscard]] const std::uint16_t* before(int x, int y) const {
        return rows_.data() + y * row_stride() + std::ptrdiff_t{kChannels} * x;
    }
    /// kChannels values.
    [[nodiscard]] const std::uint16_t* node(int x, int y) const { return before(x + 1, y + 1); }

private:
    static constexpr int kRim = kReadNodes - 1;  // one node before, the others behind
    static_assert(kRim <= LinearImage::kSpareRows && kRim < LinearImage::kSpareColumns);

    LinearImage rows_;  // row y holds the nodes of row y - 1
    bool is_smooth_ = false;
};

}  // namespace lw
