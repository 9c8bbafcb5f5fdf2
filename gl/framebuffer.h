#pragma once
/// Framebuffers over textures.

#include <span>

#include "core/result.h"
#include "gl/handle.h"
#include "gl/texture.h"

namespace lw::gl {

struct FramebufferTraits {
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};

/// Move-only. Keeps no reference to its textures: they outlive it.
class Framebuffer {
public:
    Framebuffer() noexcept = default;
    /// Colour attachment i is `*colours[i]` (all draw buffers are on), `depth` may be null. All attachments have one
    /// size. A combination that the driver does not support is an error.
    [[nodiscard]] static Result<Framebuffer> create(std::span<const Texture* const> colours, const Texture* depth);
    [[nodiscard]] static Result<Framebuffer> create(std::initializer_list<const Texture*> colours,
                                                    const Texture* depth) {
        return create(std::span<const Texture* const>{colours.begin(), colours.size()}, depth);
    }

    [[nodiscard]] GLuint id() const noexcept { return handle_.id(); }
    [[nodiscard]] glm::ivec2 size_px() const noexcept { return size_px_; }
    explicit operator bool() const noexcept { return static_cast<bool>(handle_); }

    /// Draws go here, the viewport covers all of it.
    void bind() const;

private:
    Framebuffer(Handle<FramebufferTraits> handle, glm::ivec2 size_px) : handle_{std::move(handle)}, size_px_{size_px} {}

    Handle<FramebufferTraits> handle_;
    glm::ivec2 size_px_{0};
};

}  // namespace lw::gl
