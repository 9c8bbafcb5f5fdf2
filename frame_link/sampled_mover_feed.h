#pragma once
/// Placements of movers as an application that moves them hands them over: updates now and then, extrapolated between.

#include <memory>
#include <mutex>

#include "frame_link/feeds.h"

namespace lw {

/// One thread pushes updates, any thread asks. Nobody waits longer than it takes to copy a pointer.
class SampledMoverFeed final : public ObjectTransformFeed {
public:
    /// Every mover's placement at `time`, by ascending id. An update that is not after the one before, or a placement
    /// that is not finite, is passed over.
    /// @return false when the whole update was passed over
    bool push(TimePoint time, std::span<const ObjectTransform> placements);

    /// The newest update carried on as heads are without anything learnt: at the linear and angular velocity since the
    /// update before, in full for 30 ms and dying away beyond (steady_span()). A mover that the update before did not
    /// have, or an update after more than a second, stands still. Before the newest update: between the two. Empty
    /// before the first.
    void placements_at(TimePoint time, std::vector<ObjectTransform>& transforms) const override;

private:
    struct Update {
        TimePoint time;
        std::vector<ObjectTransform> placements;
    };
    struct Updates {
        Update newest;
        Update before;
        bool has_before = false;
    };
    [[nodiscard]] std::shared_ptr<const Updates> updates() const;

    mutable std::mutex mutex_;  ///< guards the pointer, for as long as it takes to copy it
    std::shared_ptr<const Updates> updates_;
};

/// The placement `seconds` after `newest`, going on from `before`, which was `span_s` earlier: position linear, turning
/// about the object's origin at constant angular velocity, shape as in `newest`. Pure.
[[nodiscard]] glm::dmat4 carried_on(const glm::dmat4& before, const glm::dmat4& newest, double span_s, double seconds);

}  // namespace lw
