#pragma once
/// The server's thread: for every refresh wait as long as possible, latch the newest frame, predict head and movers to
/// photon time, warp, present, and write down when each of that happened.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/clock.h"
#include "frame_link/feeds.h"
#include "frame_link/frame_exchange.h"
#include "frame_link/hole_feedback.h"
#include "frame_link/prediction.h"
#include "warp_server/display_record.h"
#include "warp_server/pacer.h"
#include "warp_server/picture_maker.h"
#include "warp_server/presenter.h"
#include "warp_server/steady_refreshes.h"

namespace lw {

/// What the loop works with. Everything outlives it; the exchange's consumer side, the predictor, the warper and the
/// presenter are used by the loop's thread alone.
struct ServerParts {
    Clock& clock;
    FrameExchange& exchange;
    const HeadPoseFeed& head;
    const ObjectTransformFeed& movers;
    HeadPosePredictor& predictor;
    PictureMaker& warper;
    Presenter& presenter;
};

struct ServerSettings {
    Camera camera;  ///< size, field of view and near plane of the display; its pose is ignored
    PacerSettings pacer;
    /// The picture is made in so many horizontal strips, each just ahead of its share of a rolling scan-out, with a
    /// pose and a photon time of its own. 1: whole.
    int strips = 1;
    /// Write a PhotonCode into the corner of every picture, or of every strip.
    bool photon_codes = false;
    /// Called on the server's thread after every record; may be empty. What it does counts as the server's own work.
    std::function<void(const DisplayRecord&)> on_record;
    /// Told of the holes of every picture; may be null. Outlives the loop.
    HoleFeedbackLink* feedback = nullptr;
    /// Refreshes (with strips: strips) that can be written down before memory grows: the run's length times their rate.
    std::size_t reserved_refreshes = 4096;
    /// Processor time of the calling thread, to tell own work from time that the machine took away; null where the work
    /// is not the thread's own (a GL method waits for the GPU).
    Duration (*thread_cpu_time)() = nullptr;
};

/// Runs on the thread that calls run(). Until the first rendered frame arrives there is nothing to show: the display
/// keeps what it had and no refresh is counted. Each strip of that frame is then warped kWarmUpWarps times without
/// being shown, so that no counted refresh pays for touching memory for the first time. After that no refresh
/// allocates.
class ServerLoop {
public:
    ServerLoop(const ServerParts& parts, const ServerSettings& settings);

    /// Shows pictures until request_stop(), or until the presenter is closed.
    void run();
    /// What run() begins with: waits for the first rendered frame and warms up. It may be called before, to learn what
    /// the slowest strip takes at its best; zero when the loop was stopped before there was a frame.
    Duration rehearse();
    /// Waits for one refresh and makes its picture: what run() repeats.
    void show_next();

    /// Any thread, and a signal handler.
    void request_stop() { stop_.store(true, std::memory_order_relaxed); }

    /// One per refresh since the first picture, ascending, none left out; with strips one for each of them
    /// (worst_strips() makes refreshes of them). After run() has returned.
    [[nodiscard]] const std::vector<DisplayRecord>& records() const { return records_; }
    /// Refreshes whose predicted head pose was not finite: the last good one was shown again.
    [[nodiscard]] std::uint64_t bad_head_poses() const { return bad_head_poses_; }
    /// What else could not be used, over all pictures.
    [[nodiscard]] const HeldInput& held() const { return held_; }
    /// Rendered frames that were shown at least once.
    [[nodiscard]] std::uint64_t frames_shown() const { return frames_shown_; }

    static constexpr int kWarmUpWarps = 4;

private:
    struct Timing {
        TimePoint woken;
        Duration cpu_at_wake{};
    };

    [[nodiscard]] bool has_to_stop() const;
    void warm_up(const RenderedFrame& frame, const Refresh& refresh);
    void make_picture(const RenderedFrame& frame, const PacerPlan& plan, const Timing& timing);
    /// Head pose predicted to photon time; the last good one if it is unusable.
    [[nodiscard]] PredictedPose head_at(TimePoint now, TimePoint photon);
    [[nodiscard]] WarpTarget target_at(const Pose& world_from_head, const Refresh& slot);
    [[nodiscard]] Refresh next_slot_after(TimePoint now) const;
    [[nodiscard]] Strip strip_of(const Refresh& slot) const;
    void present(const Refresh& slot);
    void report_holes(const RenderedFrame& frame, const Camera& target, const Refresh& slot);
    /// Writes down the refreshes before `number` that no picture was aimed at.
    void record_passed_over(const Refresh& aimed_at);
    void record_without_picture(const Refresh& refresh, TimePoint planned_wake, MissCause cause);
    void write_down(const DisplayRecord& record);
    [[nodiscard]] MissCause cause_of(const DisplayRecord& record, const Timing& timing) const;
    [[nodiscard]] Duration cpu_time() const {
        return settings_.thread_cpu_time != nullptr ? settings_.thread_cpu_time() : Duration{};
    }

    ServerParts parts_;
    ServerSettings settings_;
    Pacer pacer_;
    std::atomic<bool> stop_{false};

    Refresh last_refresh_;    ///< the newest one that was written down or waited for
    bool has_shown_ = false;  ///< refreshes count from the first picture on
    Duration slowest_strip_{};
    std::vector<DisplayRecord> records_;
    std::vector<ObjectTransform> movers_;
    PredictedPose last_good_head_;
    std::uint64_t bad_head_poses_ = 0;
    HeldInput held_;
    std::uint64_t frames_shown_ = 0;
    std::uint64_t last_frame_index_ = 0;
};

}  // namespace lw
