#include <string>
#include <string_view>
#include <utility>

#include "gl/api.h"
#include "gl/context.h"

namespace lw::gl {

namespace {

// Synchronous debug output calls back on the thread that made the faulty call.
thread_local std::string messages_of_this_thread;

void GLAPIENTRY collect(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length,
                        const GLchar* text, const void* /*user*/) {
    if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
    std::string_view line{text, static_cast<std::size_t>(length)};
    while (!line.empty() && (line.back() == '\n' || line.back() == '\0')) line.remove_suffix(1);
    messages_of_this_thread.append(line).push_back('\n');
}

}  // namespace

std::string take_debug_messages() { return std::exchange(messages_of_this_thread, {}); }

void apply_conventions() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(&collect, nullptr);

    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0.0);
    glDepthFunc(GL_GEQUAL);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

}  // namespace lw::gl
