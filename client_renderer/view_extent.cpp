#include "client_renderer/view_extent.h"

#include <algorithm>
#include <cmath>

#include "client_renderer/guard_band.h"

namespace lw {
namespace {

// Of the display's side.
constexpr int kStepsPerSide = 32;
constexpr int kIdleSteps = 2;
constexpr int kUnseen_px = 1;

// Tangents of a box around what is seen.
struct Box {
    double least;
    double most;

    void include(double tangent) {
        least = std::min(least, tangent);
        most = std::max(most, tangent);
    }
};

// What lies behind the eye's plane is seen at the widest angle.
double tangent_of(double across, double ahead) {
    const double widest = std::tan(kWidestHalfAngleRad);
    if (ahead <= 0.0) return across < 0.0 ? -widest : widest;
    return std::clamp(across / ahead, -widest, widest);
}

// Rounding is no pixel.
int whole_px(double tangent, double tan_per_px) { return static_cast<int>(std::ceil(tangent / tan_per_px - 1e-6)); }

// In whole steps, and as before where that is hardly more.
int settled_px(int needed_px, int before_px, int display_px) {
    if (needed_px <= kUnseen_px) needed_px = 0;
    const int step_px = std::max(display_px / kStepsPerSide, 1);
    const int wanted_px = (needed_px + step_px - 1) / step_px * step_px;
    const bool is_near = before_px >= wanted_px && before_px < wanted_px + kIdleSteps * step_px;
    return is_near && wanted_px > 0 ? before_px : wanted_px;
}

}  // namespace

ViewExtent ViewExtent::scaled(double share) const {
    const auto part = [&](int px) { return static_cast<int>(share * px); };
    return {part(left_px), part(right_px), part(down_px), part(up_px)};
}

Camera extended(const Camera& display, const ViewExtent& extent) {
    const FovTangents& fov = display.fov;
    const double across = (fov.right - fov.left) / display.size_px.x;
    const double up = (fov.up - fov.down) / display.size_px.y;
    Camera view = display;
    view.size_px += glm::ivec2{extent.left_px + extent.right_px, extent.down_px + extent.up_px};
    view.fov = {fov.left - extent.left_px * across, fov.right + extent.right_px * across,
                fov.down - extent.down_px * up, fov.up + extent.up_px * up};
    return view;
}

ViewExtent needed_extent(const Camera& display, const ViewMotion& motion) {
    const FovTangents& fov = display.fov;
    const glm::dmat4 view_from_world = inverse_matrix_of(motion.drawn_from);
    Box across{fov.left, fov.right};
    Box up{fov.down, fov.up};
    for (const Pose& pose : {motion.shown_from, motion.drawn_from, motion.shown_until}) {
        const glm::dmat4 view_from_display = view_from_world * matrix_of(pose);
        for (int corner = 0; corner < 8; ++corner) {
            const double x = (corner & 1) != 0 ? fov.right : fov.left;
            const double y = (corner & 2) != 0 ? fov.up : fov.down;
            const double w = (corner & 4) != 0 ? 1.0 / motion.near_m : 0.0;
            const glm::dvec4 h = view_from_display * glm::dvec4{x, y, -1.0, w};
            across.include(tangent_of(h.x, -h.z));
            up.include(tangent_of(h.y, -h.z));
        }
    }
    const double px_x = (fov.right - fov.left) / display.size_px.x;
    const double px_y = (fov.up - fov.down) / display.size_px.y;
    return {whole_px(fov.left - across.least, px_x), whole_px(across.most - fov.right, px_x),
            whole_px(fov.down - up.least, px_y), whole_px(up.most - fov.up, px_y)};
}

ViewExtent next_extent(const Camera& display, const ViewMotion& motion, const ViewExtent& before) {
    const ViewExtent needed = needed_extent(display, motion);
    const glm::ivec2 size_px = display.size_px;
    return {settled_px(needed.left_px, before.left_px, size_px.x),
            settled_px(needed.right_px, before.right_px, size_px.x),
            settled_px(needed.down_px, before.down_px, size_px.y), settled_px(needed.up_px, before.up_px, size_px.y)};
}

}  // namespace lw
