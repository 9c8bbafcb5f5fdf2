#include "gl/fence.h"

namespace lw::gl {

Fence Fence::insert() {
    Fence fence{glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)};
    glFlush();
    return fence;
}

Fence::~Fence() {
    if (sync_ != nullptr) glDeleteSync(sync_);
}

bool Fence::signalled() const {
    if (sync_ == nullptr) return true;
    const GLenum state = glClientWaitSync(sync_, 0, 0);
    return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

}  // namespace lw::gl
