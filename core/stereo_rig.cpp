#include "core/stereo_rig.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {
namespace {

// Half of what a pinhole picture may show at most: 85 degrees.
constexpr double kWidestTangent = 11.43;

// Side of a triangle of axes that differ by rounding only.
constexpr double kSameDirection = 1e-9;

// The rays at the corners of an eye's picture.
std::array<glm::dvec3, 4> corner_rays(const FovTangents& fov) {
    return {glm::dvec3{fov.left, fov.down, -1.0}, glm::dvec3{fov.right, fov.down, -1.0},
            glm::dvec3{fov.left, fov.up, -1.0}, glm::dvec3{fov.right, fov.up, -1.0}};
}

class TangentBounds {
public:
    // Directions behind the view, or nearly beside it, are in no picture.
    void add(const glm::dvec3& point_view) {
        const double ahead = -point_view.z;
        if (!(ahead * kWidestTangent > std::max(std::abs(point_view.x), std::abs(point_view.y)))) {
            too_wide_ = true;
            return;
        }
        const double x = point_view.x / ahead;
        const double y = point_view.y / ahead;
        if (empty_) fov_ = {x, x, y, y};
        empty_ = false;
        fov_ = {std::min(fov_.left, x), std::max(fov_.right, x), std::min(fov_.down, y), std::max(fov_.up, y)};
    }

    [[nodiscard]] bool too_wide() const { return too_wide_; }
    [[nodiscard]] const FovTangents& fov() const { return fov_; }

private:
    FovTangents fov_;
    bool empty_ = true;
    bool too_wide_ = false;
};

// What an eye sees from `nearest_m` on is spanned by its corner rays, and lies in a picture when their beginnings and
// their directions do.
void add_frustum(const EyeView& eye, const Pose& view_from_head, double nearest_m, TangentBounds& bounds) {
    const Pose view_from_eye = compose(view_from_head, eye.head_from_eye);
    for (const glm::dvec3& ray_eye : corner_rays(eye.fov)) {
        const glm::dvec3 direction = view_from_eye.orientation * ray_eye;
        bounds.add(direction);
        bounds.add(view_from_eye.position_m + nearest_m * direction);
    }
}

double finest(const StereoRig& rig, int size_px, double FovTangents::*low, double FovTangents::*high) {
    double per_tangent = 0.0;
    for (const EyeView& eye : rig.eyes) per_tangent = std::max(per_tangent, size_px / (eye.fov.*high - eye.fov.*low));
    return per_tangent;
}

// Whole pixels; a width that is whole but for rounding stays.
int whole_px(double span_tangents, double px_per_tangent) {
    return static_cast<int>(std::ceil(span_tangents * px_per_tangent - 1e-6));
}

}  // namespace

FovTangents mirrored(const FovTangents& fov) { return {-fov.right, -fov.left, fov.down, fov.up}; }

StereoRig mirrored_rig(double ipd_m, const FovTangents& left_fov, const glm::dquat& left_turn) {
    LW_CHECK(ipd_m >= 0.0, fmt::format("eyes {} m apart", ipd_m));
    // A mirror at x = 0 keeps turns about x and reverses those about y and z.
    const glm::dquat right_turn{left_turn.w, left_turn.x, -left_turn.y, -left_turn.z};
    return {{EyeView{{{-0.5 * ipd_m, 0.0, 0.0}, left_turn}, left_fov},
             EyeView{{{0.5 * ipd_m, 0.0, 0.0}, right_turn}, mirrored(left_fov)}}};
}

Camera eye_camera(const Camera& display, const EyeView& eye, const Pose& world_from_head) {
    Camera camera = display;
    camera.fov = eye.fov;
    camera.world_from_eye = compose(world_from_head, eye.head_from_eye);
    return camera;
}

std::string_view why_not_rectified(const Camera& one, const Camera& other) {
    const Pose one_from_other = compose(inverse(one.world_from_eye), other.world_from_eye);
    if (angle_between_rad(one_from_other.orientation, {1.0, 0.0, 0.0, 0.0}) > kSameDirection) {
        return "the eyes are turned against each other";
    }
    const glm::dvec3 offset_m = one_from_other.position_m;
    // Rounding of poses far from the world's origin: micrometres at 10,000 km.
    const double rounding_m = 1e-6 * glm::length(offset_m) + 1e-15 * glm::length(one.world_from_eye.position_m);
    if (std::abs(offset_m.y) > rounding_m) return "the up vector is not perpendicular to the axis between the eyes";
    if (std::abs(offset_m.z) > rounding_m) return "one eye is in front of the other";
    if (one.size_px.y != other.size_px.y || one.fov.down != other.fov.down || one.fov.up != other.fov.up) {
        return "the eyes' pictures differ in their rows";
    }
    return {};
}

Result<Camera> centre_view(const Camera& display, const StereoRig& rig, double nearest_m, double back_m) {
    LW_CHECK(nearest_m > 0.0 && back_m >= 0.0, fmt::format("covered from {} m on, {} m back", nearest_m, back_m));
    const Pose between = interpolate(rig.eyes[0].head_from_eye, rig.eyes[1].head_from_eye, 0.5);
    Camera view = display;
    view.world_from_eye = compose(between, {{0.0, 0.0, back_m}, {1.0, 0.0, 0.0, 0.0}});
    TangentBounds bounds;
    for (const EyeView& eye : rig.eyes) add_frustum(eye, inverse(view.world_from_eye), nearest_m, bounds);
    if (bounds.too_wide()) {
        return Error{"no single picture holds what both eyes see", "the eyes' directions and fields of view",
                     "turn them less, or draw two renders"};
    }
    const double px_per_tangent_x = finest(rig, display.size_px.x, &FovTangents::left, &FovTangents::right);
    const double px_per_tangent_y = finest(rig, display.size_px.y, &FovTangents::down, &FovTangents::up);
    view.fov = bounds.fov();
    view.size_px = {whole_px(view.fov.right - view.fov.left, px_per_tangent_x),
                    whole_px(view.fov.up - view.fov.down, px_per_tangent_y)};
    // Half a pixel off the columns of eyes that see symmetrically. On whole pixels far surfaces would copy the view's
    // own samples, which alias otherwise than an eye's: in the city, head still, that is an SSIM of 0.958 to an eye's
    // own render against 0.970; elsewhere and in motion it makes no difference (0.001).
    const bool is_between = rig.eyes[0].head_from_eye.position_m != rig.eyes[1].head_from_eye.position_m;
    if (is_between && (view.size_px.x - display.size_px.x) % 2 == 0) ++view.size_px.x;
    // What the rounding adds is shared by both sides.
    const double spare_x = view.size_px.x / px_per_tangent_x - (view.fov.right - view.fov.left);
    const double spare_y = view.size_px.y / px_per_tangent_y - (view.fov.up - view.fov.down);
    view.fov.left -= 0.5 * spare_x;
    view.fov.right += 0.5 * spare_x;
    view.fov.down -= 0.5 * spare_y;
    view.fov.up += 0.5 * spare_y;
    return view;
}

double distance_back_m(const StereoRig& rig) {
    const FovTangents& left = rig.eye(Eye::left).fov;
    const FovTangents& right = rig.eye(Eye::right).fov;
    const double half_m =
        0.5 * glm::distance(rig.eyes[0].head_from_eye.position_m, rig.eyes[1].head_from_eye.position_m);
    // The left edge of the left eye's frustum begins half the eyes' distance to the left of the middle.
    return half_m / std::min(-std::min(left.left, right.left), std::max(left.right, right.right));
}

}  // namespace lw
