#pragma once
/// The reprojection in long double and straight from its definition: what the double precision of `reference` is
/// checked with. It shares nothing with core/reprojection.cpp: points go through absolute world coordinates, one space
/// after the other, and no matrices are multiplied.

#include <array>
#include <optional>

#include "core/camera.h"
#include "core/object_transform.h"

namespace lw::stability {

/// 64 bits of mantissa on x86: at 10,000 km from the origin a step is 5e-13 m.
using Exact = long double;

struct ExactVec2 {
    Exact x = 0;
    Exact y = 0;
};

/// Homogeneous target pixel: w * (x_px, y_px, depth, 1).
struct ExactPoint {
    Exact x = 0;
    Exact y = 0;
    Exact z = 0;
    Exact w = 0;
};

/// A placed sample.
struct ExactPlace {
    ExactVec2 position_px;
    Exact depth = 0;
    Exact w = 0;
};

/// How one object moves between the time of the source and that of the target; none for the static world.
struct MoverMotion {
    glm::dmat4 at_source{1.0};  ///< world_from_object
    glm::dmat4 at_target{1.0};
};

/// The linear map (x_px, y_px, 1, depth) -> w * (x_px, y_px, depth, 1) of one object.
class ExactReprojection {
public:
    /// `mover` null: the static world. Cameras are usable and at_source is not singular. Pure.
    ExactReprojection(const Camera& source, const Camera& target, const MoverMotion* mover);

    /// Homogeneous; `one` is 1 for points and 0 for differences.
    [[nodiscard]] ExactPoint apply(Exact x_px, Exact y_px, Exact one, Exact depth) const;

    /// Nothing at and behind the target's eye plane.
    [[nodiscard]] std::optional<ExactPlace> place(Exact x_px, Exact y_px, Exact depth) const;

private:
    std::array<ExactPoint, 4> column_;  // of x_px, y_px, 1 and depth
};

/// A plane seen in the source: depth = at_origin + slope_x * x_px + slope_y * y_px.
struct DepthPlane {
    Exact at_origin = 0;
    Exact slope_x = 0;
    Exact slope_y = 0;

    [[nodiscard]] Exact at(Exact x_px, Exact y_px) const { return at_origin + slope_x * x_px + slope_y * y_px; }
};

/// d(target place) / d(source place) on a plane: two columns.
struct ExactJacobian {
    ExactVec2 along_x;
    ExactVec2 along_y;

    [[nodiscard]] Exact determinant() const { return along_x.x * along_y.y - along_x.y * along_y.x; }
    /// Largest and smallest stretch of a small step.
    [[nodiscard]] Exact largest_stretch() const;
    [[nodiscard]] Exact smallest_stretch() const;
};

/// Reprojection of one plane: a homography both ways.
class ExactHomography {
public:
    /// Nothing when the plane collapses to a line in the target, or when a number is not finite.
    [[nodiscard]] static std::optional<ExactHomography> of(const ExactReprojection& reprojection,
                                                           const DepthPlane& plane);

    /// Where in the source the plane is that shows at a target place, with the plane's depth in the target; nothing
    /// where that is behind either eye.
    struct Source {
        ExactVec2 place_px;
        Exact target_depth = 0;
    };
    [[nodiscard]] std::optional<Source> source_of(Exact x_px, Exact y_px) const;

    /// At a source place that is before the target's eye.
    [[nodiscard]] ExactJacobian jacobian_at(const ExactVec2& source_px) const;

private:
    std::array<std::array<Exact, 3>, 3> target_from_source_{};  // rows x, y, w
    std::array<std::array<Exact, 3>, 3> source_from_target_{};
    std::array<Exact, 3> depth_row_{};
};

}  // namespace lw::stability
