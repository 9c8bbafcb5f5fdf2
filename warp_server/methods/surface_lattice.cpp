#include "warp_server/methods/surface_lattice.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "warp_server/methods/linear_kernels.h"

namespace lw {
namespace {

LinearRow row_of(const LinearImage& image, int y) { return {image.row(y, 0), image.channel_stride()}; }

}  // namespace

ColourLattice::ColourLattice(const LinearImage& linear, LinearImage quarters, int samples)
    : rows_{std::move(quarters)}, is_smooth_{samples > 1} {
    const glm::ivec2 nodes = size();
    std::vector<std::uint16_t> row(static_cast<std::size_t>(kChannels * (nodes.x + kRim)));
    std::uint16_t* first = row.data() + kChannels;
    std::uint16_t* last = first + kChannels * (nodes.x - 1);
    const auto store = [&](int y) { std::copy(row.begin(), row.end(), rows_.row(y + 1, 0)); };
    // In place, since new memory costs as much as what is written there; from below, because a row then lands where the
    // quarters are no longer wanted.
    for (int y = nodes.y - 1; y >= 0; --y) {
        const LinearRow below = row_of(rows_, std::min(y + 1, nodes.y - 1));
        // Pixels' centres hold the pixels exactly, for what does not move.
        const bool has_centres = y % kLatticeSteps == 0;
        average_quarters(row_of(rows_, y), below, static_cast<std::size_t>(nodes.x),
                         has_centres ? row_of(linear, y / kLatticeSteps) : LinearRow{}, first);
        std::copy_n(first, kChannels, first - kChannels);
        for (int i = 1; i < kRim; ++i) std::copy_n(last, kChannels, last + i * kChannels);
        store(y);
        if (y + 1 < nodes.y) continue;
        for (int i = 1; i < kRim; ++i) store(y + i);
    }
    store(-1);
}

}  // namespace lw
