#include "core/pose.h"

#include <cmath>

namespace lw {
namespace {

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

// atan2 keeps tiny angles exact where acos(w) loses them below 1e-8 rad.
glm::dvec3 rotation_vector(glm::dquat q) {
    if (q.w < 0.0) q = -q;
    const glm::dvec3 v{q.x, q.y, q.z};
    const double sine = glm::length(v);
    if (sine < 1e-300) return glm::dvec3{0.0};
    return v * (2.0 * std::atan2(sine, q.w) / sine);
}

glm::dquat from_rotation_vector(const glm::dvec3& rotation) {
    const double angle_rad = glm::length(rotation);
    if (angle_rad < 1e-300) return {1.0, 0.0, 0.0, 0.0};
    const glm::dvec3 v = rotation * (std::sin(0.5 * angle_rad) / angle_rad);
    return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

std::optional<Pose> sanitised(const Pose& pose) {
    const glm::dquat& q = pose.orientation;
    const double norm = std::hypot(std::hypot(q.w, q.x), std::hypot(q.y, q.z));
    if (!is_finite(pose.position_m) || !std::isfinite(norm) || norm < 1e-6) return std::nullopt;
    // Division by a norm within rounding of 1 would move the last bits of a pose that is already unit.
    if (std::abs(norm - 1.0) < 1e-15) return pose;
    return Pose{pose.position_m, q / norm};
}

glm::dmat4 matrix_of(const Pose& pose) {
    glm::dmat4 matrix{glm::mat3_cast(pose.orientation)};
    matrix[3] = glm::dvec4{pose.position_m, 1.0};
    return matrix;
}

glm::dmat4 inverse_matrix_of(const Pose& pose) {
    const glm::dmat3 rotation = glm::transpose(glm::mat3_cast(pose.orientation));
    glm::dmat4 matrix{rotation};
    matrix[3] = glm::dvec4{-(rotation * pose.position_m), 1.0};
    return matrix;
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
    const glm::dvec3 rotation = rotation_vector(glm::conjugate(a.orientation) * b.orientation);
    return {a.position_m + (b.position_m - a.position_m) * t,
            glm::normalize(a.orientation * from_rotation_vector(rotation * t))};
}

double angle_between_rad(const glm::dquat& a, const glm::dquat& b) {
    return glm::length(rotation_vector(glm::conjugate(a) * b));
}

Pose compose(const Pose& outer, const Pose& inner) {
    return {outer.position_m + outer.orientation * inner.position_m,
            glm::normalize(outer.orientation * inner.orientation)};
}

Pose inverse(const Pose& pose) {
    const glm::dquat back = glm::conjugate(pose.orientation);
    return {-(back * pose.position_m), back};
}

}  // namespace lw
