#pragma once
/// The quarters of pixels in which surfaces meet, taken apart into what is whose.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/image.h"
#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/surface_links.h"

namespace lw {

/// Two values of a row side by side, the left one in the lower half; of the upper and the lower row.
using QuarterValues = std::array<std::uint32_t, 2>;

/// The shares in a pixel's quarters, of kLinearOne, and what is not its own surface's.
struct QuarterShares {
    std::array<QuarterValues, 4> others{};  ///< red, green and blue times share, and the share
    QuarterValues own{};
};

/// One thread.
class QuarterParts {
public:
    /// Leaves in `quarters` what the pixels' own surfaces show: colours times share. Where a
    /// quarter shows both, its pixel's surface is taken to look there as it does in all of the pixel.
    /// @param links     of pixels with shares and quarters
    /// @param linear    their colours
    /// @param quarters  their quarters
    /// All outlive this.
    QuarterParts(const SurfaceLinks& links, const LinearImage& linear, LinearImage& quarters);

    [[nodiscard]] const QuarterShares& shares(int x, int y) const { return shares_[number_.at(x, y)]; }
    [[nodiscard]] const LinearImage& own() const { return *quarters_; }

    /// Puts the parts together again for a lattice between pixels. Others that lie behind a pixel's surface may show in
    /// it: they are seen beside its edge wherever that goes. Those before it move away, and would leave a ghost behind:
    /// where they are in a quarter, it gets the mean colour of its pixel.
    void join_for_lattice();

private:
    void split(glm::ivec2 pixel, QuarterShares& shares);
    [[nodiscard]] bool is_behind_others(glm::ivec2 pixel) const;

    const SurfaceLinks* links_;
    const LinearImage* linear_;
    LinearImage* quarters_;
    Image<std::uint32_t> number_;          // in shares_
    std::vector<QuarterShares> shares_;    // the first one for all pixels of one surface
    std::vector<glm::ivec2> edge_pixels_;  // of the rest
};

}  // namespace lw
