#include "warp_server/display_record.h"

#include <algorithm>

namespace lw {
namespace {

/// True if `b` is the worse of two strips of one refresh.
bool is_worse(const DisplayRecord& a, const DisplayRecord& b) {
    const auto rank = [](const DisplayRecord& record) {
        if (!record.missed()) return 0;
        return record.cause == MissCause::late_wakeup ? 1 : 2;
    };
    if (rank(a) != rank(b)) return rank(b) > rank(a);
    return b.photon - b.pose_sampled > a.photon - a.pose_sampled;
}

// Calls `use` with the strips of each whole refresh.
template <class Use>
void for_each_refresh(std::span<const DisplayRecord> strips, int count, const Use& use) {
    const auto per_refresh = static_cast<std::uint64_t>(std::max(1, count));
    std::size_t first = 0;
    while (first < strips.size() && strips[first].refresh % per_refresh != 0) ++first;
    for (; first + per_refresh <= strips.size(); first += per_refresh) use(strips.subspan(first, per_refresh));
}

}  // namespace

std::vector<DisplayRecord> worst_strips(std::span<const DisplayRecord> strips, int count) {
    std::vector<DisplayRecord> refreshes;
    refreshes.reserve(strips.size() / static_cast<std::size_t>(std::max(1, count)));
    for_each_refresh(strips, count, [&](std::span<const DisplayRecord> of_refresh) {
        refreshes.push_back(*std::max_element(of_refresh.begin(), of_refresh.end(), is_worse));
        refreshes.back().refresh /= of_refresh.size();
    });
    return refreshes;
}

std::vector<Duration> warp_times(std::span<const DisplayRecord> strips, int count) {
    std::vector<Duration> times;
    times.reserve(strips.size() / static_cast<std::size_t>(std::max(1, count)));
    for_each_refresh(strips, count, [&](std::span<const DisplayRecord> of_refresh) {
        Duration sum{};
        for (const DisplayRecord& strip : of_refresh) {
            if (!strip.presented) return;
            sum += strip.warp_time();
        }
        times.push_back(sum);
    });
    return times;
}

SeenLatencies seen_latencies(std::span<const DisplayRecord> records) {
    SeenLatencies seen;
    seen.motion_to_photon.reserve(records.size());
    seen.frame_age.reserve(records.size());
    const DisplayRecord* on_screen = nullptr;
    std::size_t next = 0;
    for (const DisplayRecord& refresh : records) {
        // Pictures are handed over in the order of their records, so the newest in time is the last one.
        for (; next < records.size() && records[next].refresh <= refresh.refresh; ++next) {
            const DisplayRecord& picture = records[next];
            if (!picture.presented) continue;
            if (*picture.presented > refresh.scanout_begin) break;
            on_screen = &picture;
        }
        if (on_screen == nullptr) continue;
        seen.motion_to_photon.push_back(refresh.photon - on_screen->pose_sampled);
        seen.frame_age.push_back(refresh.photon - on_screen->frame_pose_sampled);
    }
    return seen;
}

MissCounts count_misses(std::span<const DisplayRecord> records) {
    MissCounts counts;
    counts.refreshes = records.size();
    for (const DisplayRecord& record : records) {
        if (!record.missed()) continue;
        ++counts.missed;
        ++(record.cause == MissCause::late_wakeup ? counts.late_wakeup : counts.own);
    }
    return counts;
}

}  // namespace lw
