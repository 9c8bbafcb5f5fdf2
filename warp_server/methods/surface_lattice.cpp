#include "warp_server/methods/surface_lattice.h"

#include <algorithm>

#include "warp_server/methods/linear_kernels.h"

namespace lw {
namespace {

LinearRow row_of(const LinearImage& image, int y) { return {image.row(y, 0), image.channel_stride()}; }

}  // namespace

ColourLattice::ColourLattice(const LinearImage& linear, const LinearImage& quarters) : size_{quarters.size_px()} {
    const auto columns = static_cast<std::size_t>(size_.x);
    const std::ptrdiff_t stride = row_stride();
    values_ = std::make_unique_for_overwrite<std::uint16_t[]>(static_cast<std::size_t>(stride * (size_.y + kRim)));
    const auto stored_row = [&](int y) { return values_.get() + (y + 1) * stride; };
    for (int y = 0; y < size_.y; ++y) {
        std::uint16_t* first = stored_row(y) + kChannels;
        const LinearRow below = row_of(quarters, std::min(y + 1, size_.y - 1));
        // Pixels' centres hold the pixels exactly, for what does not move.
        const bool has_centres = y % kLatticeSteps == 0;
        average_quarters(row_of(quarters, y), below, columns,
                         has_centres ? row_of(linear, y / kLatticeSteps) : LinearRow{}, first);
        std::uint16_t* last = first + kChannels * (size_.x - 1);
        std::copy_n(first, kChannels, first - kChannels);
        for (int i = 1; i < kRim; ++i) std::copy_n(last, kChannels, last + i * kChannels);
    }
    std::copy_n(stored_row(0), stride, stored_row(-1));
    for (int i = 0; i < kRim - 1; ++i) std::copy_n(stored_row(size_.y - 1), stride, stored_row(size_.y + i));
}

}  // namespace lw
