#include "warp_server/methods/gl_source.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace lw {
namespace {

// bad_depth_count, unknown_object_count of shaders/warp/source_layer.glsl.
using CounterWords = std::array<std::uint32_t, 2>;

glsl::WarpObject packed(const PixelMatrix& matrix) {
    const auto column = [](const PixelMatrix::Column& c, float rest) { return glm::vec4{c.x, c.y, c.w, rest}; };
    return {column(matrix.x, 0.0F), column(matrix.y, 0.0F), column(matrix.one, matrix.valid ? 1.0F : 0.0F),
            column(matrix.z, matrix.depth_scale)};
}

void make_texture_if_needed(gl::Texture& texture, glm::ivec2 size_px, GLenum internal_format) {
    if (!texture || texture.size_px() != size_px) texture = gl::Texture{size_px, internal_format};
}

}  // namespace

GlSource::GlSource()
    : smooth_{gl::make_sampler(GL_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE)},
      counters_{gl::make_buffer(sizeof(CounterWords), nullptr, GL_DYNAMIC_STORAGE_BIT)} {}

void GlSource::bind(const Layer& layer, const WarpTarget& target) {
    if (const auto* textures = std::get_if<TexturePixels>(&layer.pixels)) {
        bind_textures(textures->colour.id(), textures->depth.id(), textures->object_id.id());
    } else {
        upload(checked_cpu_pixels(layer));
        bind_textures(colour_.id(), depth_.id(), object_id_.id());
    }
    matrices_.build(layer, target);
    bind_objects();
    const CounterWords zero{};
    glNamedBufferSubData(counters_.id(), 0, sizeof(zero), zero.data());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, LW_WARP_COUNTERS_BINDING, counters_.id());
}

void GlSource::bind_textures(GLuint colour, GLuint depth, GLuint object_id) {
    // A view needs a name that was never bound, hence not glCreateTextures.
    GLuint view = 0;
    glGenTextures(1, &view);
    glTextureView(view, GL_TEXTURE_2D, colour, GL_RGBA8, 0, 1, 0, 1);
    colour_view_ = gl::Handle<gl::TextureTraits>{view};
    glBindTextureUnit(LW_WARP_COLOUR_UNIT, view);
    glBindTextureUnit(LW_WARP_DEPTH_UNIT, depth);
    glBindTextureUnit(LW_WARP_OBJECT_ID_UNIT, object_id);
    glBindTextureUnit(LW_WARP_SMOOTH_COLOUR_UNIT, colour);
    for (const int unit : {LW_WARP_COLOUR_UNIT, LW_WARP_DEPTH_UNIT, LW_WARP_OBJECT_ID_UNIT}) {
        glBindSampler(static_cast<GLuint>(unit), 0);
    }
    glBindSampler(LW_WARP_SMOOTH_COLOUR_UNIT, smooth_.id());
}

void GlSource::upload(const CpuPixels& pixels) {
    const glm::ivec2 size_px = pixels.colour.size_px();
    make_texture_if_needed(colour_, size_px, GL_SRGB8_ALPHA8);
    make_texture_if_needed(depth_, size_px, GL_R32F);
    make_texture_if_needed(object_id_, size_px, GL_R16UI);
    colour_.upload(GL_RGBA, GL_UNSIGNED_BYTE, pixels.colour.pixels().data());
    depth_.upload(GL_RED, GL_FLOAT, pixels.depth.pixels().data());
    object_id_.upload(GL_RED_INTEGER, GL_UNSIGNED_SHORT, pixels.object_id.pixels().data());
}

void GlSource::bind_objects() {
    packed_.resize(matrices_.size());
    std::transform(matrices_.data(), matrices_.data() + matrices_.size(), packed_.begin(), packed);
    if (packed_.size() > object_capacity_) {
        object_capacity_ = packed_.size();
        objects_ = gl::make_buffer(static_cast<GLsizeiptr>(object_capacity_ * sizeof(glsl::WarpObject)), nullptr,
                                   GL_DYNAMIC_STORAGE_BIT);
    }
    const auto size_bytes = static_cast<GLsizeiptr>(packed_.size() * sizeof(glsl::WarpObject));
    glNamedBufferSubData(objects_.id(), 0, size_bytes, packed_.data());
    // By range: shaders ask how many objects there are by the length of the array.
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, LW_WARP_OBJECTS_BINDING, objects_.id(), 0, size_bytes);
}

WarpCounters GlSource::counters() const {
    CounterWords words{};
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(counters_.id(), 0, sizeof(words), words.data());
    return {words[0], words[1]};
}

Result<GlBadPixelCounter> GlBadPixelCounter::create() {
    auto program = gl::Program::create({"warp/count_bad.comp"});
    if (!program) return program.error();
    return GlBadPixelCounter{std::move(program).value()};
}

GlBadPixelCounter::GlBadPixelCounter(gl::Program program)
    : program_{std::move(program)}, source_size_{program_.uniform("source_size_px")} {}

void GlBadPixelCounter::count(glm::ivec2 source_size_px) const {
    program_.use();
    program_.set(source_size_, source_size_px);
    const glm::uvec2 groups = work_groups(source_size_px);
    glDispatchCompute(groups.x, groups.y, 1);
}

}  // namespace lw
