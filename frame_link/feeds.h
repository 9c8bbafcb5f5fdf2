#pragma once
/// Where head poses and mover placements come from. Both sides of the link read the same feeds.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/clock.h"
#include "core/object_transform.h"
#include "core/pose.h"

namespace lw {

/// One measurement of the head. `number` counts the tracker's samples from 1 and never repeats.
struct PoseSample {
    TimePoint time;
    Pose world_from_head;
    std::uint64_t number = 0;
};

/// A head tracker. Implementations allow calls from several threads at once.
class HeadPoseFeed {
public:
    virtual ~HeadPoseFeed() = default;

    /// The newest samples stamped at or before `now`, newest first.
    /// @return how many of `samples` were filled; at least 1 if the feed has begun. No allocation, no waiting.
    [[nodiscard]] virtual std::size_t newest(TimePoint now, std::span<PoseSample> samples) const = 0;
};

/// A feed that also knows the future: a recording. What `--predict oracle` asks.
class ForeseeingHeadPoseFeed : public HeadPoseFeed {
public:
    /// The pose at `time`; the first and the last pose hold outside. No allocation, no waiting.
    [[nodiscard]] virtual Pose pose_at(TimePoint time) const = 0;
};

/// Placements of the movers. Implementations allow calls from several threads at once.
class ObjectTransformFeed {
public:
    virtual ~ObjectTransformFeed() = default;

    /// Every mover's placement at `time` (extrapolated between updates), by ascending id; replaces `transforms`.
    virtual void placements_at(TimePoint time, std::vector<ObjectTransform>& transforms) const = 0;
};

}  // namespace lw
