#pragma once
/// Turns a G-buffer into a picture: surfaces and sky.

#include "client_renderer/light_tiles.h"
#include "client_renderer/render_targets.h"
#include "core/result.h"
#include "gl/program.h"

namespace lw {

/// Belongs to one GL context and its thread.
class LightingPass {
public:
    /// `point_lights` says whether the scene has any.
    [[nodiscard]] static Result<LightingPass> create(bool point_lights);

    /// Lights `targets` into its colour. The frame block is bound; `lights` was built for the same camera.
    /// Without `sky` pixels that show no surface keep what they hold.
    void draw(const RenderTargets& targets, const LightTiles& lights, bool sky = true);

private:
    LightingPass() = default;

    void cull_lights(const RenderTargets& targets, const LightTiles& lights);

    bool point_lights_ = false;
    gl::Program cull_lights_;  ///< empty without point lights
    gl::Program surfaces_;
    gl::Program sky_;
    gl::Buffer light_block_;
    gl::Buffer tile_masks_;
    gl::VertexArray no_attributes_;
};

}  // namespace lw
