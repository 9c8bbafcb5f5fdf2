#include "warp_server/methods/gl_target.h"

#include <utility>

namespace lw {

void GlTarget::begin(glm::ivec2 size_px, Writes writes) {
    if (!framebuffer_ || framebuffer_.size_px() != size_px) {
        colour_ = gl::Texture{size_px, GL_SRGB8_ALPHA8};
        coverage_ = gl::Texture{size_px, GL_R8UI};
        depth_ = gl::Texture{size_px, GL_DEPTH_COMPONENT32F};
        auto framebuffer = gl::Framebuffer::create({&colour_, &coverage_}, &depth_);
        LW_CHECK(framebuffer.ok(), framebuffer.error().message());
        framebuffer_ = std::move(framebuffer).value();
    }
    framebuffer_.bind();
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    constexpr float kNothing[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    constexpr GLuint kHole[4] = {0, 0, 0, 0};
    constexpr float kBackground = 0.0F;
    glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, kNothing);
    glClearNamedFramebufferuiv(framebuffer_.id(), GL_COLOR, 1, kHole);
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kBackground);
    writes == Writes::linear_light ? glEnable(GL_FRAMEBUFFER_SRGB) : glDisable(GL_FRAMEBUFFER_SRGB);
}

void GlTarget::read(DisplayFrame& out) const {
    static_assert(sizeof(Coverage) == 1);
    out.resize(framebuffer_.size_px());
    colour_.download(GL_RGBA, GL_UNSIGNED_BYTE, out.colour.size_bytes(), out.colour.pixels().data());
    coverage_.download(GL_RED_INTEGER, GL_UNSIGNED_BYTE, out.coverage.size_bytes(), out.coverage.pixels().data());
    depth_.download(GL_DEPTH_COMPONENT, GL_FLOAT, out.depth.size_bytes(), out.depth.pixels().data());
}

}  // namespace lw
