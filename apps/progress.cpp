#include "apps/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace lw {

Progress::Progress(std::string title, std::uint64_t total, bool quiet)
    : title_{std::move(title)}, total_{std::max<std::uint64_t>(total, 1)}, visible_{!quiet && isatty(STDERR_FILENO)} {
    show(0);
}

Progress::~Progress() {
    if (visible_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::uint64_t done) {
    if (!visible_) return;
    const int percent = static_cast<int>(std::min(done, total_) * 100 / total_);
    if (percent == shown_percent_) return;
    shown_percent_ = percent;
    constexpr int kBarLength = 40;
    std::string bar(kBarLength, '.');
    std::fill_n(bar.begin(), percent * kBarLength / 100, '#');
    std::fprintf(stderr, "\r%s [%s] %3d %%\033[K", title_.c_str(), bar.c_str(), percent);
    std::fflush(stderr);
}

}  // namespace lw
