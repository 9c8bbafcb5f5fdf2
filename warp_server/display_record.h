#pragma once
/// What the server did for each refresh, in the vocabulary of the life of a frame (docs/conventions.md).

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/clock.h"
#include "core/pose.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Whose fault a missed refresh was.
enum class MissCause : std::uint8_t {
    none,         ///< on time
    own,          ///< the server's own work took too long
    late_wakeup,  ///< the machine woke the thread late or took its processor away; on time without that
};

/// One refresh of the display, or one strip's share of it (next_slot()). Where no picture was made in time to even
/// begin, `presented` stays unset and the times of the warp are those of the clock's zero.
struct DisplayRecord {
    std::uint64_t refresh = 0;      ///< the display's count
    std::uint64_t frame_index = 0;  ///< rendered frame shown, 0 where no picture was made
    TimePoint frame_pose_sampled;   ///< head sample the frame's oldest layer was drawn for
    TimePoint pose_sampled;         ///< stamp of the newest head sample the picture was warped with
    std::uint64_t pose_sample = 0;  ///< its number
    TimePoint planned_wake;
    TimePoint latched;
    TimePoint warp_begin;
    TimePoint warp_end;
    std::optional<TimePoint> presented;
    TimePoint scanout_begin;
    TimePoint photon;
    Pose world_from_head;  ///< predicted to `photon`; what the picture was warped to
    WarpCounters counters;
    MissCause cause = MissCause::none;

    /// The picture was not there when its scan-out began: the display showed an older one once more.
    [[nodiscard]] bool missed() const { return !presented || *presented > scanout_begin; }
    [[nodiscard]] Duration warp_time() const { return warp_end - warp_begin; }
};

/// One record per refresh from one per strip, which it takes the worst strip of: one that was missed, for the server's
/// own fault before others, else the one with the oldest head sample at its photons. `refresh` becomes the display's
/// count again. Refreshes at either end that lack strips are left out. Pure; with one strip a copy.
[[nodiscard]] std::vector<DisplayRecord> worst_strips(std::span<const DisplayRecord> strips, int count);

/// Time that warping took for each refresh, its strips added up; those that lack a strip are left out. Pure.
[[nodiscard]] std::vector<Duration> warp_times(std::span<const DisplayRecord> strips, int count);

/// Ages of what a viewer saw, one entry per refresh at which there was a picture.
struct SeenLatencies {
    std::vector<Duration> motion_to_photon;  ///< photon time minus the newest head sample used for what was on screen
    std::vector<Duration> frame_age;         ///< photon time minus the head sample its frame was drawn for
};

/// A missed refresh shows the last picture that was there in time, and is charged that picture's age: latencies of
/// refreshes, not of pictures, so a server cannot look fast by missing. `records` by ascending refresh. Pure.
[[nodiscard]] SeenLatencies seen_latencies(std::span<const DisplayRecord> records);

/// How many refreshes were missed, and why.
struct MissCounts {
    std::uint64_t refreshes = 0;
    std::uint64_t missed = 0;
    std::uint64_t own = 0;
    std::uint64_t late_wakeup = 0;
};
[[nodiscard]] MissCounts count_misses(std::span<const DisplayRecord> records);

}  // namespace lw
