#include "gl/gpu_timer.h"

#include "core/check.h"

namespace lw::gl {

GpuTimer::GpuTimer(const Clock& clock, bool is_software) : clock_{clock}, is_software_{is_software} {
    if (is_software_) return;
    for (Query& query : queries_) {
        GLuint id = 0;
        glCreateQueries(GL_TIME_ELAPSED, 1, &id);
        query = Query{id};
    }
}

void GpuTimer::begin() {
    LW_CHECK(!running_, "begin() twice without end()");
    running_ = true;
    if (begun_ - taken_ == kRing) ++taken_;
    if (is_software_) {
        glFinish();
        begin_ = clock_.now();
    } else {
        glBeginQuery(GL_TIME_ELAPSED, queries_[begun_ % kRing].id());
    }
}

void GpuTimer::end() {
    LW_CHECK(running_, "end() without begin()");
    running_ = false;
    if (is_software_) {
        glFinish();
        measured_ms_[begun_ % kRing] = to_ms(clock_.now() - begin_);
    } else {
        glEndQuery(GL_TIME_ELAPSED);
    }
    ++begun_;
}

std::optional<double> GpuTimer::take_ms() {
    if (taken_ == begun_) return std::nullopt;
    const std::size_t slot = taken_ % kRing;
    if (!is_software_) {
        GLint available = GL_FALSE;
        glGetQueryObjectiv(queries_[slot].id(), GL_QUERY_RESULT_AVAILABLE, &available);
        if (available == GL_FALSE) return std::nullopt;
        GLuint64 elapsed_ns = 0;
        glGetQueryObjectui64v(queries_[slot].id(), GL_QUERY_RESULT, &elapsed_ns);
        measured_ms_[slot] = static_cast<double>(elapsed_ns) * 1e-6;
    }
    ++taken_;
    return measured_ms_[slot];
}

}  // namespace lw::gl
