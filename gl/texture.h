#pragma once
/// 2D textures with immutable storage.

#include <glm/glm.hpp>

#include "gl/handle.h"

namespace lw::gl {

struct TextureTraits {
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};

/// Owns a texture name and remembers its size and format. Empty by default.
class Texture {
public:
    Texture() noexcept = default;
    /// Both sides of `size_px` >= 1. `levels` >= 1; contents undefined. Filters start as nearest, wrap as clamp to
    /// edge.
    Texture(glm::ivec2 size_px, GLenum internal_format, int levels = 1);

    [[nodiscard]] GLuint id() const noexcept { return handle_.id(); }
    [[nodiscard]] glm::ivec2 size_px() const noexcept { return size_px_; }
    [[nodiscard]] GLenum internal_format() const noexcept { return internal_format_; }
    explicit operator bool() const noexcept { return static_cast<bool>(handle_); }

    /// Replaces level 0; `pixels` holds tightly packed rows, top row first.
    void upload(GLenum format, GLenum type, const void* pixels);
    /// Reads level 0 into `pixels` (`size_bytes` of room), tightly packed, top row first. Waits for the GPU.
    void download(GLenum format, GLenum type, std::size_t size_bytes, void* pixels) const;

private:
    Handle<TextureTraits> handle_;
    glm::ivec2 size_px_{0};
    GLenum internal_format_ = 0;
};

}  // namespace lw::gl
