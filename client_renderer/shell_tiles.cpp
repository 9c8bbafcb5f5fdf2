#include "client_renderer/shell_tiles.h"

#include <cmath>

#include "core/camera_picture.h"
#include "core/check.h"

namespace lw {
namespace {

// Turns of a camera that looks along -Z with +Y up.
std::array<glm::dquat, 6> face_orientations() {
    const double quarter = glm::half_pi<double>();
    const glm::dvec3 x{1.0, 0.0, 0.0};
    const glm::dvec3 y{0.0, 1.0, 0.0};
    return {glm::dquat{1.0, 0.0, 0.0, 0.0}, glm::angleAxis(-quarter, y), glm::angleAxis(2.0 * quarter, y),
            glm::angleAxis(quarter, y),     glm::angleAxis(quarter, x),  glm::angleAxis(-quarter, x)};
}

// Over its neighbours, which may have been drawn from elsewhere: with one pixel a turn of 360 degrees a second left a
// hole of one pixel where four tiles met.
constexpr int kRimPx = 2;

ShellTiles::Probes probes_of(const Camera& camera) {
    ShellTiles::Probes probes;
    for (int i = 0; i < ShellTiles::kProbesPerSide; ++i) {
        for (int j = 0; j < ShellTiles::kProbesPerSide; ++j) {
            const double u = (j + 0.5) / ShellTiles::kProbesPerSide;
            const double v = (i + 0.5) / ShellTiles::kProbesPerSide;
            probes[static_cast<std::size_t>(i * ShellTiles::kProbesPerSide + j)] =
                glm::normalize(direction_at(camera, u, v));
        }
    }
    return probes;
}

}  // namespace

ShellTiles::ShellTiles(const Camera& display, double density, int tiles_per_side) {
    LW_CHECK(density > 0.0 && tiles_per_side >= 1, fmt::format("{} tiles of density {}", tiles_per_side, density));
    const double px_per_tan = display.size_px.y / (display.fov.up - display.fov.down);
    const double side_tan = 2.0 / tiles_per_side;
    const int side_px = std::max(static_cast<int>(std::ceil(density * px_per_tan * side_tan - 1e-9)), 1);
    const double rim_tan = kRimPx * side_tan / side_px;
    display_pixels_ = px_per_tan * px_per_tan * side_tan * side_tan;
    for (const glm::dquat& orientation : face_orientations()) {
        for (int tile = 0; tile < tiles_per_side * tiles_per_side; ++tile) {
            const int row = tile / tiles_per_side;
            const double left = -1.0 + side_tan * (tile % tiles_per_side);
            const double up = 1.0 - side_tan * row;
            Camera camera;
            camera.world_from_eye.orientation = orientation;
            camera.near_m = display.near_m;
            camera.size_px = glm::ivec2{side_px + 2 * kRimPx};
            camera.fov = {left - rim_tan, left + side_tan + rim_tan, up - side_tan - rim_tan, up + rim_tan};
            cameras_.push_back(camera);
            probes_.push_back(probes_of(camera));
        }
    }
}

Camera ShellTiles::camera(int tile, const glm::dvec3& eye_world) const {
    Camera camera = cameras_[static_cast<std::size_t>(tile)];
    camera.world_from_eye.position_m = eye_world;
    return camera;
}

glm::dvec3 ShellTiles::middle(int tile) const {
    const Camera& camera = cameras_[static_cast<std::size_t>(tile)];
    return glm::normalize(direction_at(camera, 0.5, 0.5));
}

}  // namespace lw
