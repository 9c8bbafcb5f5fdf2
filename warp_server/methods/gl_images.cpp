#include "warp_server/methods/gl_images.h"

#include "shaders/warp_blocks.h"

namespace lw {

void GlImages::begin(glm::ivec2 size_px) {
    if (!colour_ || colour_.size_px() != size_px) {
        colour_ = gl::Texture{size_px, GL_RGBA8};
        depth_ = gl::Texture{size_px, GL_R32F};
        coverage_ = gl::Texture{size_px, GL_R8UI};
    }
    glBindImageTexture(LW_WARP_COLOUR_IMAGE, colour_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    glBindImageTexture(LW_WARP_DEPTH_IMAGE, depth_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
    glBindImageTexture(LW_WARP_COVERAGE_IMAGE, coverage_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R8UI);
}

void GlImages::read(DisplayFrame& out) const {
    static_assert(sizeof(Coverage) == 1);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    out.resize(colour_.size_px());
    colour_.download(GL_RGBA, GL_UNSIGNED_BYTE, out.colour.size_bytes(), out.colour.pixels().data());
    depth_.download(GL_RED, GL_FLOAT, out.depth.size_bytes(), out.depth.pixels().data());
    coverage_.download(GL_RED_INTEGER, GL_UNSIGNED_BYTE, out.coverage.size_bytes(), out.coverage.pixels().data());
}

}  // namespace lw
