#include "client_renderer/view_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/camera_picture.h"

namespace lw {
namespace {

// Over the edge of the other picture, where its own surfaces end.
constexpr double kSeam_px = 3.0;
// Directions are compared at so many places along each side of the view.
constexpr int kProbesPerSide = 32;

// Tangents of the whole view between which a vertical edge of another picture is seen.
struct EdgeReach {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
};

EdgeReach reach_of_edge(const Camera& whole, const Camera& other, double edge_tangent, double near_m) {
    const glm::dmat4 whole_from_other = inverse_matrix_of(whole.world_from_eye) * matrix_of(other.world_from_eye);
    EdgeReach reach;
    for (const double up : {other.fov.down, 0.0, other.fov.up}) {
        for (const double w : {0.0, 1.0 / near_m}) {
            const glm::dvec4 h = whole_from_other * glm::dvec4{edge_tangent, up, -1.0, w};
            if (h.z >= 0.0) return {whole.fov.left, whole.fov.right};
            reach.least = std::min(reach.least, h.x / -h.z);
            reach.most = std::max(reach.most, h.x / -h.z);
        }
    }
    return reach;
}

}  // namespace

Camera side_of(const Camera& whole, ViewSide side, const Camera& other, double near_m) {
    if (side == ViewSide::whole) return whole;
    const int columns = whole.size_px.x;
    const double tan_per_px = (whole.fov.right - whole.fov.left) / columns;
    const int middle = columns / 2;
    Camera part = whole;
    if (side == ViewSide::left) {
        const double most = reach_of_edge(whole, other, other.fov.left, near_m).most;
        const double end = std::ceil((most - whole.fov.left) / tan_per_px + kSeam_px);
        part.size_px.x = std::max(static_cast<int>(std::min(end, static_cast<double>(columns))), middle);
        part.fov.right = whole.fov.left + part.size_px.x * tan_per_px;
    } else {
        const double least = reach_of_edge(whole, other, other.fov.right, near_m).least;
        const double first = std::floor((least - whole.fov.left) / tan_per_px - kSeam_px);
        part.size_px.x = columns - std::min(static_cast<int>(std::max(first, 0.0)), middle);
        part.fov.left = whole.fov.right - part.size_px.x * tan_per_px;
    }
    return part;
}

double share_left_open(const Camera& whole, const Camera& side, const Camera& other, const Camera& display,
                       std::span<const Pose> poses) {
    int shown = 0;
    int open = 0;
    for (const Pose& pose : poses) {
        const Camera shown_at = at_pose(display, pose);
        for (int y = 0; y < kProbesPerSide; ++y) {
            for (int x = 0; x < kProbesPerSide; ++x) {
                const glm::dvec3 direction =
                    direction_at(shown_at, (x + 0.5) / kProbesPerSide, (y + 0.5) / kProbesPerSide);
                if (!sees(whole, direction)) continue;
                ++shown;
                open += sees(side, direction) || sees(other, direction) ? 0 : 1;
            }
        }
    }
    return shown == 0 ? 0.0 : static_cast<double>(open) / shown;
}

Pose gone_on(const Pose& from, const Pose& to) {
    const glm::dquat turned = to.orientation * glm::conjugate(from.orientation);
    return {to.position_m + (to.position_m - from.position_m), glm::normalize(turned * to.orientation)};
}

}  // namespace lw
