#include "gl/framebuffer.h"

#include <vector>

namespace lw::gl {

Result<Framebuffer> Framebuffer::create(std::span<const Texture* const> colours, const Texture* depth) {
    LW_CHECK(!colours.empty() || depth != nullptr, "a framebuffer without attachments");
    const glm::ivec2 size_px = colours.empty() ? depth->size_px() : colours.front()->size_px();
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    Handle<FramebufferTraits> handle{id};
    std::vector<GLenum> draw_buffers;
    for (const Texture* colour : colours) {
        LW_CHECK(colour->size_px() == size_px, "attachments of different sizes");
        const auto attachment = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + draw_buffers.size());
        glNamedFramebufferTexture(id, attachment, colour->id(), 0);
        draw_buffers.push_back(attachment);
    }
    if (draw_buffers.empty()) {
        glNamedFramebufferDrawBuffer(id, GL_NONE);
    } else {
        glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    }
    if (depth != nullptr) {
        LW_CHECK(depth->size_px() == size_px, "attachments of different sizes");
        glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth->id(), 0);
    }
    const GLenum state = glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
    if (state != GL_FRAMEBUFFER_COMPLETE) {
        return Error{"the driver cannot draw into these textures",
                     fmt::format("framebuffer of {}x{} pixels, status {:#x}", size_px.x, size_px.y, state),
                     "use a smaller --size or another driver"};
    }
    return Framebuffer{std::move(handle), size_px};
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id());
    glViewport(0, 0, size_px_.x, size_px_.y);
}

}  // namespace lw::gl
