#pragma once
/// Which neighbouring pixels lie on one surface.

#include <cstdint>

#include "core/image.h"
#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw {

/// Each side and diagonal of a cell may be a link: both of its ends on one surface.
enum CellLink : std::uint8_t {
    kLinkTop = 1,       ///< corners 0-1
    kLinkBottom = 2,    ///< 2-3
    kLinkLeft = 4,      ///< 0-2
    kLinkRight = 8,     ///< 1-3
    kLinkFalling = 16,  ///< 0-3
    kLinkRising = 32,   ///< 1-2
};

/// Which of its neighbours a pixel is linked to.
inline constexpr std::uint8_t kToRight = 1;
inline constexpr std::uint8_t kDown = 2;

/// Links of an image. Coordinates may exceed the image by a pixel; the last pixels count again there.
class SurfaceLinks {
public:
    /// Any thread; `pixels` must outlive this.
    /// @param unseen_step  depths of what stands still that lie no farther apart are linked; >= 0
    explicit SurfaceLinks(const CpuPixels& pixels, float unseen_step = 0.0F);

    [[nodiscard]] glm::ivec2 size_px() const { return to_right_and_down_.size_px(); }
    [[nodiscard]] const CpuPixels& pixels() const { return *pixels_; }

    /// Is (x, y) on one surface with its right (lower) neighbour? Inside the image only.
    [[nodiscard]] bool to_right(int x, int y) const { return (to_right_and_down_.at(x, y) & kToRight) != 0; }
    [[nodiscard]] bool down(int x, int y) const { return (to_right_and_down_.at(x, y) & kDown) != 0; }

    /// The sides of the cell at (x, y): CellLink bits.
    [[nodiscard]] std::uint8_t sides(int x, int y) const {
        const int x1 = x + 1 < size_px().x ? x + 1 : x;
        const int y1 = y + 1 < size_px().y ? y + 1 : y;
        const unsigned here = to_right_and_down_.at(x, y);
        const unsigned right = to_right_and_down_.at(x1, y);
        const unsigned below = to_right_and_down_.at(x, y1);
        return static_cast<std::uint8_t>((here & 1U) | (below & 1U) << 1U | (here & 2U) << 1U | (right & 2U) << 2U);
    }
    /// Sides and diagonals.
    [[nodiscard]] std::uint8_t all_links(int x, int y) const;

    /// How far off a plane of object `id` pixels may lie, where `part` of their depth would be seen: neighbours may lie
    /// on both sides of it, and are linked then.
    [[nodiscard]] DepthTolerance tolerance(ObjectId id, float part) const { return {part, 0.5F * unseen_step(id)}; }

    /// Depth for a surface of object `id`, negative where the pixel, which lies in the image, is of another object or
    /// its depth is unusable.
    [[nodiscard]] float depth_of(ObjectId id, int x, int y) const {
        const float depth = pixels_->depth.at(x, y);
        return pixels_->object_id.at(x, y) == id && is_usable_depth(depth) ? depth : -1.0F;
    }

private:
    [[nodiscard]] bool diagonal(int x, int y, int step_x) const;
    [[nodiscard]] float unseen_step(ObjectId id) const { return id == 0 ? unseen_step_ : 0.0F; }

    const CpuPixels* pixels_;
    float unseen_step_;  // of what stands still
    Image<std::uint8_t> to_right_and_down_;
};

/// A block of pixels: its first one, its size, and the plane it should lie on.
struct BlockToTest {
    int x = 0;
    int y = 0;
    int columns = 1;
    int rows = 1;
    ObjectId id = 0;
    float depth = 0.0F;  ///< at the first pixel
    float gradient_x = 0.0F;
    float gradient_y = 0.0F;
    DepthTolerance tolerance;  ///< how far off the plane a pixel may be
};
/// Are all pixels of the block, which lies in the image, of its object and on its plane?
[[nodiscard]] bool block_is_plane(const CpuPixels& pixels, const BlockToTest& block);

/// Which of them are: bit `column` of `rows[row]`. At most 16 columns.
void plane_members(const CpuPixels& pixels, const BlockToTest& block, std::uint16_t* rows);

/// True for cells whose sides join all four corners: three of them do.
[[nodiscard]] inline bool joins_all_corners(std::uint8_t sides) {
    constexpr std::uint32_t kThreeOrMore = 1U << 7U | 1U << 11U | 1U << 13U | 1U << 14U | 1U << 15U;
    return (kThreeOrMore >> (sides & 15U) & 1U) != 0;
}

}  // namespace lw
