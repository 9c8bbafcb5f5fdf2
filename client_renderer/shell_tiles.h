#pragma once
/// The six faces of a cube around the viewer, cut into tiles: what an outer shell is drawn on. Faces look along the
/// world's axes, so that they stay right whichever way the head turns.

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "core/camera.h"

namespace lw {

/// Immutable. Any thread.
class ShellTiles {
public:
    /// Directions that a tile is judged by.
    static constexpr int kProbesPerSide = 4;
    using Probes = std::array<glm::dvec3, kProbesPerSide * kProbesPerSide>;

    /// @param display        its near plane, and its pixels per tangent at the centre, which tiles have too
    /// @param density        tile pixels per display pixel and axis there, > 0
    /// @param tiles_per_side of a face, >= 1
    ShellTiles(const Camera& display, double density, int tiles_per_side);

    [[nodiscard]] int count() const { return static_cast<int>(cameras_.size()); }
    /// At `eye_world`. Each has a rim of two pixels over its neighbours, so that tiles drawn from one place join.
    [[nodiscard]] Camera camera(int tile, const glm::dvec3& eye_world) const;
    /// Unit directions in world space, spread over the tile.
    [[nodiscard]] const Probes& probes(int tile) const { return probes_[static_cast<std::size_t>(tile)]; }
    /// Through its middle, unit, world space.
    [[nodiscard]] glm::dvec3 middle(int tile) const;
    /// Display pixels that a tile covers when it is looked at straight.
    [[nodiscard]] double display_pixels() const { return display_pixels_; }

private:
    std::vector<Camera> cameras_;  ///< at the origin
    std::vector<Probes> probes_;
    double display_pixels_ = 0.0;
};

}  // namespace lw
