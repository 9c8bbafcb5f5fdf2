#pragma once
/// Turns a G-buffer into a picture: surfaces and sky.

#include <span>

#include "client_renderer/light_tiles.h"
#include "client_renderer/render_targets.h"
#include "client_renderer/sky_pass.h"
#include "core/result.h"
#include "gl/program.h"

namespace lw {

/// Belongs to one GL context and its thread.
class LightingPass {
public:
    /// `point_lights` says whether the scene has any.
    [[nodiscard]] static Result<LightingPass> create(bool point_lights);

    /// Lights `targets` into its colour. The frame block is bound; `lights` was built for the same camera.
    /// Pixels that show no surface get the sky where `sky` covers them (SkyParts), elsewhere they keep what they hold.
    void draw(const RenderTargets& targets, const LightTiles& lights, std::span<const SkyRect> sky);

private:
    explicit LightingPass(SkyPass sky) : sky_{std::move(sky)} {}

    void cull_lights(const RenderTargets& targets, const LightTiles& lights);

    bool point_lights_ = false;
    gl::Program cull_lights_;  ///< empty without point lights
    gl::Program surfaces_;
    SkyPass sky_;
    gl::Buffer light_block_;
    gl::Buffer tile_masks_;
    gl::VertexArray no_attributes_;
};

}  // namespace lw
