#pragma once
/// Spaces are types: a transform says where it leads and where it comes from, and only matching ones multiply.

#include <glm/glm.hpp>

namespace lw {

// Conventions of every space below: docs/conventions.md.
struct World;       ///< right-handed, +Y up, metres
struct Object;      ///< an object's own space, metres before its scale
struct SourceEye;   ///< eye of the camera a layer was drawn with; looks along -Z, +X right, +Y up, metres
struct TargetEye;   ///< eye of the camera a layer is shown with
struct TargetClip;  ///< GL clip space, reversed infinite depth: z_ndc 1 at the near plane, 0 at infinity
struct SourcePx;    ///< homogeneous source pixel, written (x_px, y_px, 1, depth); row 0 on top, pixel centres at +0.5
struct TargetPx;    ///< homogeneous target pixel, written w * (x_px, y_px, depth, 1)

/// Linear map of homogeneous coordinates `To <- From`, column-major, double precision.
/// It is rounded to float once, where it is used per pixel.
template <class To, class From>
struct Transform {
    glm::dmat4 matrix{1.0};
};

template <class A, class B, class C>
[[nodiscard]] Transform<A, C> operator*(const Transform<A, B>& a_from_b, const Transform<B, C>& b_from_c) {
    return {a_from_b.matrix * b_from_c.matrix};
}

/// General inverse. The matrix must not be singular (its entries are infinite otherwise).
template <class To, class From>
[[nodiscard]] Transform<From, To> inverse(const Transform<To, From>& to_from) {
    return {glm::inverse(to_from.matrix)};
}

}  // namespace lw
