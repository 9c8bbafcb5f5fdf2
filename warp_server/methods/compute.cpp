/// The splat in compute shaders: 32-bit keys by atomic maximum, then a match pass that finds whose key it was, then one
/// that shows it.

#include <array>

#include "gl/program.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/gl_images.h"
#include "warp_server/methods/gl_source.h"

namespace lw {
namespace {

// One of the three shaders, with its sizes.
class Pass {
public:
    [[nodiscard]] static Result<Pass> create(std::string_view shader) {
        auto program = gl::Program::create({shader});
        if (!program) return program.error();
        return Pass{std::move(program).value()};
    }

    void run(glm::ivec2 source_size_px, glm::ivec2 target_size_px, glm::ivec2 invocations) const {
        program_.use();
        program_.set(source_size_, source_size_px);
        program_.set(target_size_, target_size_px);
        const glm::uvec2 groups = work_groups(invocations);
        glDispatchCompute(groups.x, groups.y, 1);
    }

private:
    explicit Pass(gl::Program program)
        : program_{std::move(program)},
          source_size_{program_.uniform("source_size_px")},
          target_size_{program_.uniform("target_size_px")} {}

    gl::Program program_;
    GLint source_size_;
    GLint target_size_;
};

class ComputeMethod final : public WarpMethod {
public:
    ComputeMethod(std::string label, Pass key, Pass match, Pass resolve)
        : label_{std::move(label)}, key_{std::move(key)}, match_{std::move(match)}, resolve_{std::move(resolve)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        const glm::ivec2 source_size_px = layer.camera.size_px;
        const glm::ivec2 target_size_px = target.camera.size_px;
        source_.bind(layer, target);
        images_.begin(target_size_px);
        clear(target_size_px);
        key_.run(source_size_px, target_size_px, source_size_px);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        match_.run(source_size_px, target_size_px, source_size_px);
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        resolve_.run(source_size_px, target_size_px, target_size_px);
        images_.read(out);
        counters_ = source_.counters();
    }

private:
    void clear(glm::ivec2 size_px) {
        if (!keys_ || keys_.size_px() != size_px) {
            keys_ = gl::Texture{size_px, GL_R32UI};
            indices_ = gl::Texture{size_px, GL_R32UI};
        }
        constexpr GLuint kNothing = 0;
        glClearTexImage(keys_.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &kNothing);
        glClearTexImage(indices_.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &kNothing);
        glBindImageTexture(LW_WARP_KEY_IMAGE, keys_.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
        glBindImageTexture(LW_WARP_INDEX_IMAGE, indices_.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    }

    std::string label_;
    Pass key_;
    Pass match_;
    Pass resolve_;
    gl::Texture keys_;
    gl::Texture indices_;
    GlSource source_;
    GlImages images_;
};

}  // namespace

MadeMethod make_compute_method(std::string label, const MethodSettings& /*settings*/) {
    auto key = Pass::create("warp/splat_key.comp");
    if (!key) return key.error();
    auto match = Pass::create("warp/splat_match.comp");
    if (!match) return match.error();
    auto resolve = Pass::create("warp/splat_resolve.comp");
    if (!resolve) return resolve.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<ComputeMethod>(
        std::move(label), std::move(key).value(), std::move(match).value(), std::move(resolve).value())};
}

}  // namespace lw
