#include "client_renderer/image_passes.h"

#include "shaders/client_blocks.h"

namespace lw {

Result<ImagePasses> ImagePasses::create() {
    auto average = gl::Program::create({"client/fullscreen.vert", "client/average.frag"});
    if (!average.ok()) return average.error();
    auto depth_copy = gl::Program::create({"client/fullscreen.vert", "client/depth_copy.frag"});
    if (!depth_copy.ok()) return depth_copy.error();
    ImagePasses passes;
    passes.average_ = std::move(*average);
    passes.depth_copy_ = std::move(*depth_copy);
    passes.samples_per_axis_ = passes.average_.uniform("u_samples_per_axis");
    passes.no_attributes_ = gl::make_vertex_array();
    return passes;
}

void ImagePasses::average(const gl::Texture& source, int samples_per_axis, const gl::Texture& target) {
    LW_CHECK(source.size_px() == target.size_px() * samples_per_axis, "the sizes do not fit");
    average_.set(samples_per_axis_, samples_per_axis);
    draw(average_, source, target);
}

void ImagePasses::copy_depth(const gl::Texture& depth, const gl::Texture& target) {
    LW_CHECK(depth.size_px() == target.size_px(), "the sizes do not fit");
    draw(depth_copy_, depth, target);
}

void ImagePasses::draw(const gl::Program& program, const gl::Texture& source, const gl::Texture& target) {
    const auto framebuffer = gl::Framebuffer::create({&target}, nullptr);
    LW_CHECK(framebuffer.ok(), framebuffer.error().message());
    framebuffer->bind();
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_attributes_.id());
    glBindTextureUnit(shader::kUnitSource, source.id());
    glBindSampler(shader::kUnitSource, 0);
    program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace lw
