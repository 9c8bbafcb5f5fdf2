#pragma once
/// Where the surfaces of one picture lie in another, exactly, from depth, ids and poses: the oracle that error figures
/// are sorted by. Slow and obvious; no warp method uses it.

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "core/camera.h"
#include "core/image.h"
#include "core/object_transform.h"

namespace lw {

/// One sample per pixel at its centre, and where everything stood. Images are of the camera's size and outlive it.
struct SampledView {
    const Camera& camera;
    const DepthImage& depth;                  ///< reversed infinite depth, 0 = background
    const ObjectIdImage& object_id;           ///< 0 = static world and sky
    std::span<const ObjectTransform> movers;  ///< placements when it was drawn
};

enum class Visibility : std::uint8_t {
    seen,     ///< a pixel of the other picture beside the place lies on the surface
    hidden,   ///< something else is there
    outside,  ///< beyond the other picture's border, behind its eye or nearer than its near plane
};

/// Where the surface at one pixel's centre lies in the other picture.
struct SurfacePlace {
    Visibility visibility = Visibility::outside;
    glm::dvec2 position_px{0.0};           ///< in the other picture; meaningless where it is outside
    std::array<glm::ivec2, 4> neighbours;  ///< the pixels whose centres enclose the place, cut to the picture
    std::array<float, 4> weights{};        ///< bilinear over those on the surface, sum 1; all 0 unless seen
};

/// For every pixel of `from` its surface's place in `to`. A pixel of `to` lies on the surface when it has its object id
/// and its depth is within 3 % of the surface's plane there: planes at any slant match exactly, and sources whose depth
/// is averaged over a pixel's samples still match. An id that is unknown in one of both is hidden.
/// @param use  called once per pixel with its coordinates; from several threads at once, each with rows of its own,
///             when there are more than one
/// @param threads  0 means as many as the machine has
void match_surfaces(const SampledView& from, const SampledView& to, int threads,
                    const std::function<void(int x, int y, const SurfacePlace& place)>& use);

}  // namespace lw
