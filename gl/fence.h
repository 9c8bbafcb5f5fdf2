#pragma once
/// A point in a context's command stream that others can ask about.

#include <utility>

#include "gl/api.h"

namespace lw::gl {

/// Move-only. Made in one context, polled in another of the same share group.
class Fence {
public:
    Fence() noexcept = default;
    /// Inserted after everything issued so far; flushes, so that other contexts will see it signalled.
    [[nodiscard]] static Fence insert();

    Fence(Fence&& other) noexcept : sync_{std::exchange(other.sync_, nullptr)} {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;
    ~Fence();

    /// Never waits. True for an empty fence. glWaitSync is not offered: on software GL it blocks the calling thread.
    [[nodiscard]] bool signalled() const;

private:
    explicit Fence(GLsync sync) noexcept : sync_{sync} {}
    GLsync sync_ = nullptr;
};

}  // namespace lw::gl
