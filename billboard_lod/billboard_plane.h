#pragma once
/// The geometry of a billboard: its size on the screen, its plane before the eye, its own frustum (seed 000, section
/// 3.4, corrected).

#include <array>
#include <glm/glm.hpp>

#include "billboard_lod/projected_bounds.h"
#include "core/camera.h"

namespace lw {

/// Sides of the atlas's slots, texels.
inline constexpr std::array<int, 6> kBillboardDimensions{16, 32, 64, 128, 256, 512};

/// B_W and B_H: width and height of the projected box in a viewport, pixels. `bounds` is usable. Pure.
[[nodiscard]] glm::dvec2 screen_size_px(const ProjectedBounds& bounds, glm::ivec2 viewport_px);

/// Index into kBillboardDimensions of the dimension whose difference to the larger side is least (seed 000's rule; the
/// larger dimension on a tie). Pure.
[[nodiscard]] std::size_t nearest_dimension(const glm::dvec2& size_px);

/// Index of the smallest dimension that holds both sides, the largest one if none does. Pure.
[[nodiscard]] std::size_t covering_dimension(const glm::dvec2& size_px);

/// The texels of a billboard as tangents of its eye: texel (x, y), counted from the upper left corner, covers tangents
/// from (left + x * per_texel.x, up - y * per_texel.y) on.
struct TexelGrid {
    double left = 0.0;
    double up = 0.0;
    glm::dvec2 per_texel{0.0};  ///< tangents, both > 0
    glm::ivec2 size{0};         ///< texels in use, both sides at least 1 and at most those of the slot

    [[nodiscard]] FovTangents window() const {
        return {left, left + per_texel.x * size.x, up - per_texel.y * size.y, up};
    }
};

/// The grid that covers the projected box with `texels_per_px` (>= 1) texels per pixel of `camera` and lies on its
/// pixels: the centre of every pixel is the centre of a texel, so that from where it was drawn a billboard shows
/// exactly what the mesh would. `bounds` is usable. Pure.
[[nodiscard]] TexelGrid grid_on_pixels(const ProjectedBounds& bounds, const Camera& camera, int texels_per_px);

/// Texels per pixel and axis that a slot has at most, however small its object.
inline constexpr int kMaxTexelsPerPx = 8;

/// The grid of a slot of `max_side` texels a side: on the pixels, with at least `texels_per_px` texels per pixel and as
/// many more as the slot has room for, since that costs no memory. If it needs more than `max_side` texels they grow,
/// and lie anywhere. `bounds` is usable. Pure.
[[nodiscard]] TexelGrid grid_in_slot(const ProjectedBounds& bounds, const Camera& camera, int texels_per_px,
                                     int max_side);

/// A quad parallel to the picture.
struct BillboardPlane {
    glm::dvec3 centre_eye{0.0};  ///< P_cc
    double half_width_m = 0.0;   ///< |h|
    double half_height_m = 0.0;  ///< |u|
};

/// The window on the plane at `centre_m`. By P_X on the near plane and the factor e = d_cc / P_z, all three points at
/// once: their coordinates are tangents times distance. Pure.
[[nodiscard]] BillboardPlane plane_of(const FovTangents& window, double centre_m);

/// d_k = d_a + (d_l - d_cc): the distance of a point of a flat billboard whose middle is now at `plane_now_m`, from the
/// distance `drawn_m` it was drawn with (seed 000, section 3.5.3, corrected). Metres. Pure.
[[nodiscard]] constexpr double corrected_distance_m(double plane_now_m, double drawn_m, double plane_drawn_m) {
    return plane_now_m + (drawn_m - plane_drawn_m);
}

}  // namespace lw
