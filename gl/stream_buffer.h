#pragma once
/// Buffers whose contents a pass replaces with every draw.

#include <cstddef>
#include <vector>

#include "gl/api.h"
#include "gl/handle.h"

namespace lw::gl {

/// Without storage; replace() gives it some. Needs a current context.
[[nodiscard]] inline Buffer make_stream_buffer() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return Buffer{id};
}

/// The buffer holds `elements` from now on, in storage of their size; draws under way keep what they read.
template <class T>
void replace(const Buffer& buffer, const std::vector<T>& elements) {
    glNamedBufferData(buffer.id(), static_cast<GLsizeiptr>(elements.size() * sizeof(T)), elements.data(),
                      GL_STREAM_DRAW);
}

/// GL takes an offset into the bound buffer as a pointer.
[[nodiscard]] inline const void* buffer_offset(std::size_t bytes) {
    return reinterpret_cast<const void*>(bytes);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace lw::gl
