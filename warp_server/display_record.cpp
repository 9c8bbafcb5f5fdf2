#include "warp_server/display_record.h"

namespace lw {

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
