#include "apps/stability/exact_reprojection.h"

#include <algorithm>
#include <cmath>

namespace lw::stability {
namespace {

struct Vec3 {
    Exact x = 0;
    Exact y = 0;
    Exact z = 0;
};

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Exact dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec3 column_of(const glm::dmat4& m, int i) { return {m[i].x, m[i].y, m[i].z}; }

// Rotation by a quaternion of any length: v + 2 (w (u x v) + u x (u x v)) / |q|^2.
Vec3 rotated(const glm::dquat& q, const Vec3& v, bool backwards) {
    const Exact sign = backwards ? -1 : 1;
    const Vec3 u{sign * q.x, sign * q.y, sign * q.z};
    const Exact w = q.w;
    const Exact twice = 2 / (dot(u, u) + w * w);
    const Vec3 once = cross(u, v);
    const Vec3 again = cross(u, once);
    return {v.x + twice * (w * once.x + again.x), v.y + twice * (w * once.y + again.y),
            v.z + twice * (w * once.z + again.z)};
}

// Linear parts solved by Cramer's rule.
Vec3 object_from_world(const glm::dmat4& m, const Vec3& world, Exact w) {
    const Vec3 a = column_of(m, 0);
    const Vec3 b = column_of(m, 1);
    const Vec3 c = column_of(m, 2);
    const Vec3 p{world.x - Exact{m[3].x} * w, world.y - Exact{m[3].y} * w, world.z - Exact{m[3].z} * w};
    const Exact determinant = dot(a, cross(b, c));
    return {dot(p, cross(b, c)) / determinant, dot(p, cross(c, a)) / determinant, dot(p, cross(a, b)) / determinant};
}

Vec3 world_from_object(const glm::dmat4& m, const Vec3& object, Exact w) {
    const Vec3 a = column_of(m, 0);
    const Vec3 b = column_of(m, 1);
    const Vec3 c = column_of(m, 2);
    const Vec3 t = column_of(m, 3);
    return {a.x * object.x + b.x * object.y + c.x * object.z + t.x * w,
            a.y * object.x + b.y * object.y + c.y * object.z + t.y * w,
            a.z * object.x + b.z * object.y + c.z * object.z + t.z * w};
}

ExactPoint mapped(const Camera& source, const Camera& target, const MoverMotion* mover, const ExactPoint& pixel) {
    // pixel holds (x_px, y_px, 1, depth) in x, y, w, z.
    const FovTangents& from = source.fov;
    const Vec3 eye{Exact{from.left} * pixel.w + (Exact{from.right} - from.left) / source.size_px.x * pixel.x,
                   Exact{from.up} * pixel.w - (Exact{from.up} - from.down) / source.size_px.y * pixel.y, -pixel.w};
    const Exact w = pixel.z / Exact{source.near_m};
    const glm::dvec3& at = source.world_from_eye.position_m;
    const Vec3 turned = rotated(source.world_from_eye.orientation, eye, false);
    Vec3 world{turned.x + Exact{at.x} * w, turned.y + Exact{at.y} * w, turned.z + Exact{at.z} * w};
    if (mover != nullptr) world = world_from_object(mover->at_target, object_from_world(mover->at_source, world, w), w);
    const glm::dvec3& to = target.world_from_eye.position_m;
    const Vec3 relative{world.x - Exact{to.x} * w, world.y - Exact{to.y} * w, world.z - Exact{to.z} * w};
    const Vec3 seen = rotated(target.world_from_eye.orientation, relative, true);
    const FovTangents& fov = target.fov;
    const Exact distance = -seen.z;  // times the homogeneous scale, like all that follows
    return {(seen.x - Exact{fov.left} * distance) / (Exact{fov.right} - fov.left) * target.size_px.x,
            (Exact{fov.up} * distance - seen.y) / (Exact{fov.up} - fov.down) * target.size_px.y,
            Exact{target.near_m} * w, distance};
}

using Rows = std::array<std::array<Exact, 3>, 3>;

std::optional<Rows> inverse_of(const Rows& m) {
    const Vec3 a{m[0][0], m[1][0], m[2][0]};
    const Vec3 b{m[0][1], m[1][1], m[2][1]};
    const Vec3 c{m[0][2], m[1][2], m[2][2]};
    const Vec3 bc = cross(b, c);
    const Vec3 ca = cross(c, a);
    const Vec3 ab = cross(a, b);
    const Exact determinant = dot(a, bc);
    const Exact scale = std::sqrt(dot(a, a)) * std::sqrt(dot(b, b)) * std::sqrt(dot(c, c));
    if (!(std::abs(determinant) > scale * 1e-16L) || !std::isfinite(determinant)) return std::nullopt;
    return Rows{{{bc.x / determinant, bc.y / determinant, bc.z / determinant},
                 {ca.x / determinant, ca.y / determinant, ca.z / determinant},
                 {ab.x / determinant, ab.y / determinant, ab.z / determinant}}};
}

}  // namespace

ExactReprojection::ExactReprojection(const Camera& source, const Camera& target, const MoverMotion* mover)
    : column_{mapped(source, target, mover, {1, 0, 0, 0}), mapped(source, target, mover, {0, 1, 0, 0}),
              mapped(source, target, mover, {0, 0, 0, 1}), mapped(source, target, mover, {0, 0, 1, 0})} {}

ExactPoint ExactReprojection::apply(Exact x_px, Exact y_px, Exact one, Exact depth) const {
    const auto sum = [&](Exact ExactPoint::*part) {
        return column_[0].*part * x_px + column_[1].*part * y_px + column_[2].*part * one + column_[3].*part * depth;
    };
    return {sum(&ExactPoint::x), sum(&ExactPoint::y), sum(&ExactPoint::z), sum(&ExactPoint::w)};
}

std::optional<ExactPlace> ExactReprojection::place(Exact x_px, Exact y_px, Exact depth) const {
    const ExactPoint h = apply(x_px, y_px, 1, depth);
    if (!(h.w > 0)) return std::nullopt;
    return ExactPlace{{h.x / h.w, h.y / h.w}, h.z / h.w, h.w};
}

Exact ExactJacobian::largest_stretch() const {
    const Exact sum = along_x.x * along_x.x + along_x.y * along_x.y + along_y.x * along_y.x + along_y.y * along_y.y;
    const Exact root = std::sqrt(std::max(sum * sum - 4 * determinant() * determinant(), Exact{0}));
    return std::sqrt((sum + root) / 2);
}

Exact ExactJacobian::smallest_stretch() const { return std::abs(determinant()) / largest_stretch(); }

std::optional<ExactHomography> ExactHomography::of(const ExactReprojection& reprojection, const DepthPlane& plane) {
    const std::array<ExactPoint, 3> columns{reprojection.apply(1, 0, 0, plane.slope_x),
                                            reprojection.apply(0, 1, 0, plane.slope_y),
                                            reprojection.apply(0, 0, 1, plane.at_origin)};
    ExactHomography made;
    for (std::size_t i = 0; i < 3; ++i) {
        made.target_from_source_[0][i] = columns[i].x;
        made.target_from_source_[1][i] = columns[i].y;
        made.target_from_source_[2][i] = columns[i].w;
        made.depth_row_[i] = columns[i].z;
    }
    const std::optional<Rows> inverse = inverse_of(made.target_from_source_);
    if (!inverse) return std::nullopt;
    made.source_from_target_ = *inverse;
    return made;
}

std::optional<ExactHomography::Source> ExactHomography::source_of(Exact x_px, Exact y_px) const {
    std::array<Exact, 3> s{};
    for (std::size_t i = 0; i < 3; ++i) {
        s[i] = source_from_target_[i][0] * x_px + source_from_target_[i][1] * y_px + source_from_target_[i][2];
    }
    // s = (x, y, 1) / w of the target: in front of both eyes where the third is positive.
    if (!(s[2] > 0)) return std::nullopt;
    const Exact depth = depth_row_[0] * s[0] + depth_row_[1] * s[1] + depth_row_[2] * s[2];
    return Source{{s[0] / s[2], s[1] / s[2]}, depth};
}

ExactJacobian ExactHomography::jacobian_at(const ExactVec2& source_px) const {
    std::array<Exact, 3> h{};
    for (std::size_t i = 0; i < 3; ++i) {
        h[i] = target_from_source_[i][0] * source_px.x + target_from_source_[i][1] * source_px.y +
               target_from_source_[i][2];
    }
    const auto along = [&](std::size_t column) {
        return ExactVec2{(target_from_source_[0][column] - h[0] / h[2] * target_from_source_[2][column]) / h[2],
                         (target_from_source_[1][column] - h[1] / h[2] * target_from_source_[2][column]) / h[2]};
    };
    return {along(0), along(1)};
}

}  // namespace lw::stability
