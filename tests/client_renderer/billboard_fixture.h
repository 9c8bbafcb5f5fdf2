#pragma once
/// What tests of billboards share: a small scene, cameras, and renderers of it.

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <memory>

#include "client_renderer/scene_renderer.h"
#include "core/metrics.h"
#include "scene/chairs.h"
#include "tests/support/gl_test.h"

namespace lw::test {

/// A few chairs and scooters seen from outside, all of them beyond the threshold.
inline scene::Scene few_chairs(int movers = 0) { return std::move(*scene::make_chairs({7, 6, movers, 5})); }

inline Camera outside(const scene::Scene& scene, glm::ivec2 size_px = {256, 256}) {
    Camera camera;
    camera.size_px = size_px;
    camera.fov = FovTangents::symmetric(1.0, static_cast<double>(size_px.x) / size_px.y);
    camera.world_from_eye = *scene.start_pose;
    camera.world_from_eye.position_m += glm::dvec3{0.0, 1.5, 4.0};
    return camera;
}

class GlBillboards : public GlTest {
protected:
    std::unique_ptr<SceneRenderer> make(const scene::Scene& scene, BillboardSettings billboards) {
        SceneRendererSettings settings;
        settings.billboards = billboards;
        auto renderer = SceneRenderer::create(scene, settings);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message();
        (*renderer)->use_billboards(true);
        return std::move(*renderer);
    }
    static BillboardSettings with_mode(BillboardMode mode) {
        BillboardSettings settings;
        settings.mode = mode;
        settings.capacities = {32, 32, 32, 32, 16, 4};
        return settings;
    }
    static CpuPixels draw(SceneRenderer& renderer, const Camera& camera, double time_s = 0.0) {
        CpuPixels pixels;
        renderer.draw(camera, time_s, pixels);
        return pixels;
    }
    /// The same picture of meshes.
    static CpuPixels draw_meshes(SceneRenderer& renderer, const Camera& camera, double time_s = 0.0) {
        renderer.use_billboards(false);
        CpuPixels pixels = draw(renderer, camera, time_s);
        renderer.use_billboards(true);
        return pixels;
    }
};

inline int most_off(const Rgba8& a, const glm::vec3& b) {
    const glm::vec3 off = glm::abs(glm::vec3{a.r, a.g, a.b} - b);
    return static_cast<int>(std::ceil(std::max({off.r, off.g, off.b})));
}

inline glm::vec3 levels(const Rgba8& a) { return {a.r, a.g, a.b}; }

inline Camera moved(Camera camera, const glm::dvec3& step_m, double turn_rad = 0.0) {
    camera.world_from_eye.position_m += step_m;
    camera.world_from_eye.orientation =
        glm::angleAxis(turn_rad, glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
    return camera;
}

}  // namespace lw::test
