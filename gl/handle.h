#pragma once
/// A GL name lives in one move-only handle. Id 0 is empty and needs no context; a filled handle is destroyed with a
/// context of its share group current.

#include <utility>

#include "gl/api.h"

namespace lw::gl {

template <class Traits>
class Handle {
public:
    Handle() noexcept = default;
    explicit Handle(GLuint id) noexcept : id_{id} {}
    Handle(Handle&& other) noexcept : id_{std::exchange(other.id_, 0)} {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (id_ != 0) Traits::destroy(id_);
    }

    [[nodiscard]] GLuint id() const noexcept { return id_; }
    explicit operator bool() const noexcept { return id_ != 0; }

private:
    GLuint id_ = 0;
};

struct BufferTraits {
    static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct VertexArrayTraits {
    static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct SamplerTraits {
    static void destroy(GLuint id) { glDeleteSamplers(1, &id); }
};

using Buffer = Handle<BufferTraits>;
using VertexArray = Handle<VertexArrayTraits>;
using Sampler = Handle<SamplerTraits>;

/// Immutable storage of `size_bytes` > 0, filled from `data` unless it is null. `flags` as glNamedBufferStorage.
[[nodiscard]] Buffer make_buffer(GLsizeiptr size_bytes, const void* data, GLbitfield flags);
[[nodiscard]] VertexArray make_vertex_array();
[[nodiscard]] Sampler make_sampler(GLenum min_filter, GLenum mag_filter, GLenum wrap_s, GLenum wrap_t);

}  // namespace lw::gl
