#include "warp_server/methods/surface_lattice.h"

#include <cstddef>
#include <vector>

#include "warp_server/methods/linear_kernels.h"

namespace lw {

LinearImage lattice_between(const LinearImage& linear, LinearImage quarters) {
    LinearImage& lattice = quarters;
    const glm::ivec2 size = lattice.size_px();
    const auto columns = static_cast<std::size_t>(size.x);
    std::vector<std::uint16_t> last_row;  // below it, it counts again
    for (int y = 0; y < size.y; ++y) {
        for (int channel = 0; channel < 3; ++channel) {
            std::uint16_t* row = lattice.row(y, channel);
            const bool is_last = y + 1 == size.y;
            if (is_last) last_row.assign(row, row + size.x);
            // Pixels' centres hold the pixels exactly, for what does not move.
            const bool has_centres = y % kLatticeSteps == 0;
            average_quarters(row, is_last ? last_row.data() : lattice.row(y + 1, channel), columns,
                             has_centres ? linear.row(y / kLatticeSteps, channel) : nullptr);
        }
    }
    return quarters;
}

}  // namespace lw
