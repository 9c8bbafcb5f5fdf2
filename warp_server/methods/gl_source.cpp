#include "warp_server/methods/gl_source.h"

#include <algorithm>
#include <array>
#include <cstdint>

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

GlSource::GlSource() : counters_{gl::make_buffer(sizeof(CounterWords), nullptr, GL_DYNAMIC_STORAGE_BIT)} {}

void GlSource::bind(const Layer& layer, const WarpTarget& target) {
    if (const auto* textures = std::get_if<TexturePixels>(&layer.pixels)) {
        // A view needs a name that was never bound, hence not glCreateTextures.
        GLuint view = 0;
        glGenTextures(1, &view);
        colour_view_ = gl::Handle<gl::TextureTraits>{view};
        glTextureView(view, GL_TEXTURE_2D, textures->colour.id(), GL_RGBA8, 0, 1, 0, 1);
        glBindTextureUnit(LW_WARP_COLOUR_UNIT, view);
        glBindTextureUnit(LW_WARP_DEPTH_UNIT, textures->depth.id());
        glBindTextureUnit(LW_WARP_OBJECT_ID_UNIT, textures->object_id.id());
    } else {
        upload(checked_cpu_pixels(layer));
        glBindTextureUnit(LW_WARP_COLOUR_UNIT, colour_.id());
        glBindTextureUnit(LW_WARP_DEPTH_UNIT, depth_.id());
        glBindTextureUnit(LW_WARP_OBJECT_ID_UNIT, object_id_.id());
    }
    matrices_.build(layer, target);
    bind_objects();
    const CounterWords zero{};
    glNamedBufferSubData(counters_.id(), 0, sizeof(zero), zero.data());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, LW_WARP_COUNTERS_BINDING, counters_.id());
}

void GlSource::upload(const CpuPixels& pixels) {
    const glm::ivec2 size_px = pixels.colour.size_px();
    make_texture_if_needed(colour_, size_px, GL_RGBA8);
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

}  // namespace lw
