#include "client_renderer/gbuffer_pass.h"

#include "client_renderer/packed_vertex.h"
#include "gl/stream_buffer.h"

namespace lw {

namespace {

void begin(const RenderTargets& targets, const gl::VertexArray& vertex_array, const gl::Buffer& commands) {
    targets.gbuffer.bind();
    glBindVertexArray(vertex_array.id());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    // Passes write encoded colour themselves. GL warp methods on the same context, as in replay, leave theirs on.
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void end() {
    glFrontFace(GL_CCW);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    glBindVertexArray(0);
}

}  // namespace

GBufferPass::GBufferPass(const GpuScene& gpu_scene)
    : gpu_scene_{gpu_scene}, instances_{gl::make_stream_buffer()}, commands_{gl::make_stream_buffer()} {
    gl::replace(instances_, std::vector<PackedInstance>(1));
    vertex_array_ =
        make_vertex_array(gpu_scene.surface_vertices(), gpu_scene.texture_vertices(), instances_, gpu_scene.indices());
}

std::uint64_t GBufferPass::draw(const DrawList& list, const RenderTargets& targets, GpuScene::Into into) {
    if (!list.commands().empty()) {
        gl::replace(instances_, list.instances());
        gl::replace(commands_, list.commands());
    }
    begin(targets, vertex_array_, commands_);
    // The colours need no clearing: lighting looks at covered pixels only. Ids and depth are read everywhere.
    const GLuint no_object[4] = {};
    const GLfloat background = 0.0f;
    glClearNamedFramebufferuiv(targets.gbuffer.id(), GL_COLOR, 3, no_object);
    glClearNamedFramebufferfv(targets.gbuffer.id(), GL_DEPTH, 0, &background);
    for (const DrawRange& range : list.ranges()) {
        gpu_scene_.bind(gpu_scene_.batches()[static_cast<std::size_t>(range.batch)], into);
        glFrontFace(range.mirrored ? GL_CW : GL_CCW);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                    gl::buffer_offset(range.first_command * sizeof(DrawCommand)),
                                    static_cast<GLsizei>(range.command_count), 0);
    }
    end();
    return list.ranges().size();
}

void GBufferPass::warm_up(const RenderTargets& targets) {
    gl::replace(instances_, std::vector<PackedInstance>(1));
    std::vector<DrawCommand> commands;
    for (const std::vector<MeshPart>& parts : gpu_scene_.parts()) {
        commands.push_back({3, 1, parts.front().first_index, parts.front().base_vertex, 0});
    }
    if (commands.empty()) return;
    gl::replace(commands_, commands);
    begin(targets, vertex_array_, commands_);
    for (std::size_t b = 0; b < commands.size(); ++b) {
        gpu_scene_.bind(gpu_scene_.batches()[b]);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, gl::buffer_offset(b * sizeof(DrawCommand)), 1, 0);
    }
    end();
}

}  // namespace lw
