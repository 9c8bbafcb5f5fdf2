#include "gl/texture.h"

namespace lw::gl {

Texture::Texture(glm::ivec2 size_px, GLenum internal_format, int levels)
    : size_px_{size_px}, internal_format_{internal_format} {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    handle_ = Handle<TextureTraits>{id};
    glTextureStorage2D(id, levels, internal_format, size_px.x, size_px.y);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, levels > 1 ? GL_LINEAR : GL_NEAREST);
    glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Texture::upload(GLenum format, GLenum type, const void* pixels) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(id(), 0, 0, 0, size_px_.x, size_px_.y, format, type, pixels);
}

void Texture::download(GLenum format, GLenum type, std::size_t size_bytes, void* pixels) const {
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(id(), 0, format, type, static_cast<GLsizei>(size_bytes), pixels);
}

}  // namespace lw::gl
