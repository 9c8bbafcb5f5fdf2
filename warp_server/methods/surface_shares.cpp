#include "warp_server/methods/surface_shares.h"

#include <algorithm>
#include <cstring>

namespace lw {
namespace {

bool is_thin(const SurfaceLinks& links, int x, int y) {
    const glm::ivec2 last = links.size_px() - 1;
    const bool alone_in_row = x > 0 && x < last.x && !links.to_right(x - 1, y) && !links.to_right(x, y);
    const bool alone_in_column = y > 0 && y < last.y && !links.down(x, y - 1) && !links.down(x, y);
    return alone_in_row || alone_in_column;
}

}  // namespace

void halve_lacks_of_thin_things(const SurfaceLinks& links, LinearImage& linear) {
    constexpr int kAtOnce = 4;
    constexpr std::uint64_t kAllWhole = 0x7FFF7FFF7FFF7FFF;  // kLinearOne four times, as most are
    for (int y = 0; y < linear.size_px().y; ++y) {
        std::uint16_t* shares = linear.alpha_row(y);
        for (int x = 0; x < linear.size_px().x; x += kAtOnce) {
            std::uint64_t four = 0;  // those beyond the last pixel are zeros in memory of the image
            std::memcpy(&four, shares + x, sizeof(four));
            if (four == kAllWhole) continue;
            for (int i = x; i < std::min(x + kAtOnce, linear.size_px().x); ++i) {
                if (shares[i] == kLinearOne || !is_thin(links, i, y)) continue;
                shares[i] = static_cast<std::uint16_t>((shares[i] + kLinearOne) / 2);
            }
        }
    }
}

}  // namespace lw
