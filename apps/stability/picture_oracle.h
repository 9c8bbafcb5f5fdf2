#pragma once
/// What every pixel of a case's picture must show, from the exact reprojection alone.

#include <optional>
#include <vector>

#include "apps/stability/exact_reprojection.h"
#include "apps/stability/stability_case.h"

namespace lw::stability {

/// Which motions a method follows.
enum class OracleMotion : std::uint8_t {
    full,      ///< head and movers
    rotation,  ///< the head's rotation alone, as `rotation` does
    none,      ///< a change of view alone, as `stale` does
};

/// What a target pixel shows.
struct ExpectedPixel {
    enum class Kind : std::uint8_t {
        unclear,  ///< near an edge or where surfaces hide each other: left out of the comparison
        nothing,  ///< no surface comes near it: a hole
        surface,
    };
    Kind kind = Kind::unclear;
    int region = -1;
    ExactVec2 source_px;  ///< the place of the source that lands on the pixel's centre
    Exact depth = 0;      ///< in the target
    Exact largest_stretch = 0;
    Exact smallest_stretch = 0;
};

class PictureOracle {
public:
    /// Keeps a reference to `made`.
    PictureOracle(const StabilityCase& made, OracleMotion motion);

    [[nodiscard]] ExpectedPixel at(int x, int y) const;

    /// The case's target as this oracle's methods see it.
    [[nodiscard]] const Camera& target() const { return target_; }

    /// Where a source place of a region goes when its depth is `depth`.
    [[nodiscard]] std::optional<ExactPlace> place(int region, const ExactVec2& source_px, Exact depth) const;

    /// d(target) / d(source) of a region's plane at a source place before the target's eye.
    [[nodiscard]] std::optional<ExactJacobian> jacobian_at(int region, const ExactVec2& source_px) const;

    /// Least and largest target depth of a region's plane within `margin_px` of a target place.
    struct DepthRange {
        Exact low = 0;
        Exact high = 0;
    };
    [[nodiscard]] DepthRange depth_around(int region, const ExactVec2& target_px, Exact margin_px) const;

    /// Index of the region of a source pixel.
    [[nodiscard]] int region_of(int x, int y) const;

    [[nodiscard]] const StabilityCase& of_case() const { return made_; }

private:
    struct Moved {
        CaseRegion region;
        ExactReprojection reprojection;
        std::optional<ExactHomography> homography;
        // Where the region's corners land and the nearest of their depths; no box when one is behind the eye.
        ExactVec2 low_px;
        ExactVec2 high_px;
        Exact nearest = -1;

        [[nodiscard]] bool box_holds(Exact x_px, Exact y_px, Exact margin_px) const {
            return nearest >= 0 && x_px >= low_px.x - margin_px && x_px <= high_px.x + margin_px &&
                   y_px >= low_px.y - margin_px && y_px <= high_px.y + margin_px;
        }
    };
    [[nodiscard]] static Moved moved_region(const CaseRegion& region, const ExactReprojection& reprojection);

    const StabilityCase& made_;
    Camera target_;
    std::vector<Moved> moved_;
};

}  // namespace lw::stability
