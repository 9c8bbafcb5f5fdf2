#include "apps/interrupt.h"

#include <csignal>

namespace lw {
namespace {

// A handler can reach nothing but this.
volatile std::sig_atomic_t was_interrupted = 0;

void note_interrupt(int signal) {
    was_interrupted = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptScope::InterruptScope() {
    was_interrupted = 0;
    std::signal(SIGINT, note_interrupt);
    std::signal(SIGTERM, note_interrupt);
}

InterruptScope::~InterruptScope() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool InterruptScope::interrupted() const { return was_interrupted != 0; }

}  // namespace lw
