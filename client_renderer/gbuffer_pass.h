#pragma once
/// Draws a draw list into the G-buffer.

#include "client_renderer/draw_list.h"
#include "client_renderer/gpu_scene.h"
#include "client_renderer/render_targets.h"
#include "gl/handle.h"

namespace lw {

/// Belongs to one GL context and its thread.
class GBufferPass {
public:
    /// `gpu_scene` outlives the pass.
    explicit GBufferPass(const GpuScene& gpu_scene);

    /// Clears the G-buffer and draws. The frame block is bound; for a part of the scene that lies behind something, the
    /// limits' texture too. Leaves depth test and face culling off.
    /// @return the number of draw calls
    std::uint64_t draw(const DrawList& list, const RenderTargets& targets,
                       GpuScene::Into into = GpuScene::Into::gbuffer);

    /// Draws three indices of every batch, so that the driver compiles every variant now (llvmpipe does at the first
    /// draw, 20-300 ms each).
    void warm_up(const RenderTargets& targets);

private:
    const GpuScene& gpu_scene_;
    gl::Buffer instances_;  ///< mutable storage, replaced per draw
    gl::Buffer commands_;
    gl::VertexArray vertex_array_;
};

}  // namespace lw
