#pragma once
/// Random frames and poses whose exact picture is known: every source is cut into rectangles, each a plane of its own
/// at its own distance, static or on a mover. A case is made from its seed alone, the same on every machine.

#include <cstdint>
#include <string_view>
#include <vector>

#include "apps/stability/exact_reprojection.h"
#include "frame_link/rendered_frame.h"

namespace lw::stability {

/// How far a case may go.
enum class CaseRange : std::uint8_t {
    /// What the bounds of docs/accuracy.md are promised for: field of view 20 to 150 degrees, up to 75
    /// degrees off the axis, up to 4096 px, turns up to 90 degrees, 10 near planes to 10,000 km away, object scale 1e-3
    /// to 1e3, up to 10,000 km from the origin.
    promised,
    /// Beyond: 1 to 170 degrees, sizes from 1x1, surfaces from the near plane on and seen edge-on, object scale 1e-4 to
    /// 1e4, heads and objects that jump anywhere.
    beyond,
};

/// Pixels [x0, x1) x [y0, y1) of the source: one plane of one object. The depths of its pixels are floats exactly.
struct CaseRegion {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    ObjectId id = 0;
    DepthPlane plane;

    [[nodiscard]] bool contains(const ExactVec2& place_px, Exact margin_px) const {
        return place_px.x >= x0 + margin_px && place_px.x <= x1 - margin_px && place_px.y >= y0 + margin_px &&
               place_px.y <= y1 - margin_px;
    }
};

struct StabilityCase {
    std::uint64_t seed = 0;
    CaseRange range = CaseRange::promised;
    Camera source;
    Camera target;
    std::vector<CaseRegion> regions;  ///< by rows, left to right; they cover the source
    std::vector<ObjectTransform> at_source;
    std::vector<ObjectTransform> at_target;

    /// The motion of an object; nothing for the static world (id 0).
    [[nodiscard]] std::optional<MoverMotion> motion_of(ObjectId id) const;
};

/// Pure.
[[nodiscard]] StabilityCase make_case(std::uint64_t seed, CaseRange range);

/// What the source's pixels say of themselves.
enum class CasePattern : std::uint8_t {
    index,    ///< pixel number in 24 bits: for methods that show source pixels as they are
    lattice,  ///< red alternates between 0 and 255 by columns, green by rows: a bilinear read tells its place
};

/// The frame of a case, with CPU pixels.
[[nodiscard]] Layer layer_of(const StabilityCase& made, CasePattern pattern);

/// Pixel numbers of CasePattern::index, below 2^24.
[[nodiscard]] Rgba8 colour_of_index(std::uint32_t index);
[[nodiscard]] std::uint32_t index_of_colour(Rgba8 colour);

}  // namespace lw::stability
