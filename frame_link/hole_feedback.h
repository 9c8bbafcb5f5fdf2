#pragma once
/// What the server tells the client of each display frame: where its layers had nothing to show.

#include <cstdint>
#include <mutex>
#include <vector>

#include "core/clock.h"

namespace lw {

/// Unreached pixels of one display frame (or of several, added up), by LayerContent::item: a hole counts for every item
/// whose picture covers its direction, since each of them might have shown something there.
struct HoleFeedback {
    TimePoint shown;                      ///< scan-out of the newest display frame in it
    std::uint32_t display_frames = 0;     ///< added up
    std::vector<std::uint32_t> holes_px;  ///< by item; shorter when no item beyond has a hole

    void add(std::uint32_t item, std::uint32_t pixels) {
        if (holes_px.size() <= item) holes_px.resize(item + std::size_t{1}, 0);
        holes_px[item] += pixels;
    }
    void add(const HoleFeedback& other) {
        shown = other.shown;
        display_frames += other.display_frames;
        for (std::size_t i = 0; i < other.holes_px.size(); ++i) add(static_cast<std::uint32_t>(i), other.holes_px[i]);
    }
};

/// The way of the feedback from the server's thread to the client's. The server never waits: while the client takes, a
/// display frame's feedback is dropped; the next one says nearly the same.
class HoleFeedbackLink {
public:
    /// Server's thread.
    void offer(const HoleFeedback& feedback) {
        const std::unique_lock lock{mutex_, std::try_to_lock};
        if (lock.owns_lock()) pending_.add(feedback);
    }
    /// Client's thread: everything offered since the last call.
    [[nodiscard]] HoleFeedback take() {
        const std::lock_guard lock{mutex_};
        HoleFeedback taken = std::move(pending_);
        pending_ = {};
        return taken;
    }

private:
    std::mutex mutex_;
    HoleFeedback pending_;
};

}  // namespace lw
