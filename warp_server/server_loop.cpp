#include "warp_server/server_loop.h"

#include <algorithm>

namespace lw {
namespace {

TimePoint oldest_pose_sampled(const RenderedFrame& frame) {
    TimePoint oldest = frame.layers.front()->pose_sampled;
    for (const auto& layer : frame.layers) oldest = std::min(oldest, layer->pose_sampled);
    return oldest;
}

}  // namespace

ServerLoop::ServerLoop(const ServerParts& parts, const ServerSettings& settings)
    : parts_{parts}, settings_{settings}, pacer_{settings.pacer} {
    records_.reserve(settings.reserved_refreshes);
}

void ServerLoop::run() {
    while (!stop_.load(std::memory_order_relaxed) && !parts_.presenter.closed()) show_next();
}

void ServerLoop::show_next() {
    // A refresh gets one picture: after an early one, the next refresh is the one after it.
    const TimePoint now = parts_.clock.now();
    const Refresh next = parts_.presenter.next_refresh(std::max(now, last_refresh_.scanout_begin));
    const PacerPlan plan = pacer_.next_wake(now, next);
    if (has_shown_) record_passed_over(plan.refresh);
    last_refresh_ = plan.refresh;

    parts_.clock.sleep_until(plan.wake);
    const Timing timing{parts_.clock.now(), cpu_time()};
    const RenderedFrame* frame = parts_.exchange.latest();
    if (frame == nullptr) return;
    if (!has_shown_) {
        warm_up(*frame, plan.refresh);
        has_shown_ = true;
        // What the warm-up took is nobody's miss: counting begins with the next refresh.
        last_refresh_ = parts_.presenter.next_refresh(parts_.clock.now());
        return;
    }
    if (timing.woken >= plan.refresh.scanout_begin) {
        // Work for a refresh that has begun would only delay the next one.
        record_without_picture(plan.refresh, plan.wake, MissCause::late_wakeup);
        pacer_.finished({plan.refresh, plan.wake, timing.woken});
        return;
    }
    make_picture(*frame, plan, timing);
}

void ServerLoop::warm_up(const RenderedFrame& frame, const Refresh& refresh) {
    for (int i = 0; i < kWarmUpWarps; ++i) {
        const PredictedPose head = head_at(parts_.clock.now(), refresh.photon());
        parts_.warper.warp(frame, target_at(head.world_from_head, refresh.photon()));
    }
}

void ServerLoop::make_picture(const RenderedFrame& frame, const PacerPlan& plan, const Timing& timing) {
    DisplayRecord record;
    record.refresh = plan.refresh.number;
    record.frame_index = frame.index;
    record.frame_pose_sampled = oldest_pose_sampled(frame);
    record.planned_wake = plan.wake;
    record.latched = timing.woken;
    record.scanout_begin = plan.refresh.scanout_begin;
    record.photon = plan.refresh.photon();

    const PredictedPose head = head_at(timing.woken, record.photon);
    record.pose_sampled = head.newest_sample;
    record.world_from_head = head.world_from_head;
    const WarpTarget target = target_at(head.world_from_head, record.photon);

    record.warp_begin = parts_.clock.now();
    const DisplayFrame& picture = parts_.warper.warp(frame, target);
    record.warp_end = parts_.clock.now();
    record.counters = parts_.warper.counters();
    held_ += parts_.warper.held();

    parts_.presenter.present(picture, plan.refresh);
    record.presented = parts_.clock.now();
    record.cause = cause_of(record, timing);

    if (frame.index != last_frame_index_) ++frames_shown_;
    last_frame_index_ = frame.index;
    pacer_.finished({plan.refresh, plan.wake, *record.presented});
    records_.push_back(record);
}

PredictedPose ServerLoop::head_at(TimePoint now, TimePoint photon) {
    PredictedPose predicted = parts_.predictor.predict(parts_.head, now, photon);
    if (const auto pose = sanitised(predicted.world_from_head)) {
        predicted.world_from_head = *pose;
        last_good_head_ = predicted;
    } else {
        ++bad_head_poses_;
    }
    return last_good_head_;
}

WarpTarget ServerLoop::target_at(const Pose& world_from_head, TimePoint photon) {
    parts_.movers.placements_at(photon, movers_);
    WarpTarget target;
    target.camera = settings_.camera;
    target.camera.world_from_eye = world_from_head;
    target.movers = movers_;
    return target;
}

void ServerLoop::record_passed_over(const Refresh& aimed_at) {
    // Refreshes are passed over because the picture before them was late, because the pacer knows that the work takes
    // longer than a period (both own), or because the thread lost time between two pictures.
    const bool was_late = !records_.empty() && records_.back().missed();
    const bool own = pacer_.is_too_slow_for(aimed_at.period);
    const MissCause cause = own ? MissCause::own : was_late ? records_.back().cause : MissCause::late_wakeup;
    for (std::uint64_t number = last_refresh_.number + 1; number < aimed_at.number; ++number) {
        Refresh passed = aimed_at;
        passed.number = number;
        passed.scanout_begin -= static_cast<Duration::rep>(aimed_at.number - number) * aimed_at.period;
        record_without_picture(passed, passed.scanout_begin, cause);
    }
}

void ServerLoop::record_without_picture(const Refresh& refresh, TimePoint planned_wake, MissCause cause) {
    DisplayRecord record;
    record.refresh = refresh.number;
    record.planned_wake = planned_wake;
    record.scanout_begin = refresh.scanout_begin;
    record.photon = refresh.photon();
    record.cause = cause;
    records_.push_back(record);
}

MissCause ServerLoop::cause_of(const DisplayRecord& record, const Timing& timing) const {
    if (!record.missed()) return MissCause::none;
    Duration lost = timing.woken - record.planned_wake;
    if (settings_.thread_cpu_time != nullptr) {
        lost += (*record.presented - timing.woken) - (cpu_time() - timing.cpu_at_wake);
    }
    return *record.presented - lost <= record.scanout_begin ? MissCause::late_wakeup : MissCause::own;
}

}  // namespace lw
