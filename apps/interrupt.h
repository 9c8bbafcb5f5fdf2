#pragma once
/// Ctrl-C ends a live run early and cleanly: it still writes its report.

namespace lw {

/// While one exists, SIGINT and SIGTERM are noted instead of ending the program; a second one ends it as ever. One at a
/// time (signal handlers are the process's).
class InterruptScope {
public:
    InterruptScope();
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;
    ~InterruptScope();

    [[nodiscard]] bool interrupted() const;
};

}  // namespace lw
