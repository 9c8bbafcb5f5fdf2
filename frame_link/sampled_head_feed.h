#pragma once
/// A live head tracker: one thread pushes samples in (a window's mouse, a headset's driver), any thread reads them.

#include <array>
#include <atomic>
#include <cstdint>

#include "frame_link/feeds.h"

namespace lw {

/// A ring of the last 1024 samples (one second of a 1 kHz tracker), each slot guarded by a version counter. The writer
/// never waits for readers. A reader never waits or retries: should the writer overwrite a slot under it, everything
/// from there on has left the ring, and it returns the newer samples it already holds.
class SampledHeadFeed final : public HeadPoseFeed {
public:
    static constexpr std::size_t kCapacity = 1024;

    /// Writer only, one thread at a time. Samples are numbered from 1 in the order they are taken.
    /// @return false, and nothing is taken, when the pose is unusable (see sanitised()) or `time` is not after the
    /// newest sample's.
    bool push(TimePoint time, const Pose& world_from_head);

    /// Any thread.
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override;

private:
    // Time and the seven numbers of a pose, as bits: plain members would be a data race when the ring wraps.
    static constexpr std::size_t kWords = 8;
    struct Slot {
        std::atomic<std::uint64_t> version{0};  ///< 2 * number when sample `number` is whole, odd while it is written
        std::array<std::atomic<std::uint64_t>, kWords> words{};
    };

    [[nodiscard]] bool read(std::uint64_t number, PoseSample& sample) const;

    std::array<Slot, kCapacity> slots_;
    std::atomic<std::uint64_t> newest_number_{0};
    TimePoint newest_time_{};  ///< writer's own
};

}  // namespace lw
