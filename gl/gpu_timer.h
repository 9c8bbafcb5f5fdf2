#pragma once
/// Time of GL work without stalling it.

#include <array>
#include <cstdint>
#include <optional>

#include "core/clock.h"
#include "gl/handle.h"

namespace lw::gl {

struct QueryTraits {
    static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
using Query = Handle<QueryTraits>;

/// Measures one stage per frame. On a GPU: timer queries, read when they are ready, frames later, no waiting. On a
/// software GL, whose queries do not measure the work (17.8 ms read as 0.3): the CPU clock with glFinish at both ends.
/// Belongs to one context and its thread.
class GpuTimer {
public:
    /// `clock` outlives the timer. At most `kRing` measurements are under way; begin() beyond that drops the oldest.
    GpuTimer(const Clock& clock, bool is_software);

    /// begin() and end() alternate; timers do not nest (one GL_TIME_ELAPSED query at a time).
    void begin();
    void end();

    /// The oldest finished measurement not yet taken, milliseconds; nothing while there is none.
    [[nodiscard]] std::optional<double> take_ms();

private:
    static constexpr std::size_t kRing = 8;

    const Clock& clock_;
    bool is_software_;
    bool running_ = false;
    std::array<Query, kRing> queries_;  ///< empty on a software GL
    std::array<double, kRing> measured_ms_{};
    TimePoint begin_;
    std::uint64_t begun_ = 0;
    std::uint64_t taken_ = 0;
};

}  // namespace lw::gl
