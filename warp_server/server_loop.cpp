#include "warp_server/server_loop.h"

#include <algorithm>

#include "warp_server/photon_code.h"

namespace lw {
namespace {

// Of the view. Other layers are as old as they may be: what is behind the head is seldom drawn.
TimePoint view_pose_sampled(const RenderedFrame& frame) { return frame.layers.front()->pose_sampled; }

PacerSettings pacer_settings(const ServerSettings& settings) {
    PacerSettings pacer = settings.pacer;
    pacer.strips = settings.strips;
    return pacer;
}

}  // namespace

ServerLoop::ServerLoop(const ServerParts& parts, const ServerSettings& settings)
    : parts_{parts}, settings_{settings}, pacer_{pacer_settings(settings)} {
    // Written, not only reserved: no picture waits for the machine to find memory, and a long run takes no more of it.
    records_.resize(settings.reserved_refreshes);
    records_.clear();
}

void ServerLoop::run() {
    while (!has_to_stop()) show_next();
}

Duration ServerLoop::rehearse() {
    while (!has_shown_ && !has_to_stop()) show_next();
    return slowest_strip_;
}

bool ServerLoop::has_to_stop() const { return stop_.load(std::memory_order_relaxed) || parts_.presenter.closed(); }

void ServerLoop::show_next() {
    const TimePoint now = parts_.clock.now();
    const PacerPlan plan = pacer_.next_wake(now, next_slot_after(now));
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
        last_refresh_ = next_slot(parts_.presenter, parts_.clock.now(), settings_.strips);
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

Refresh ServerLoop::next_slot_after(TimePoint now) const {
    // A slot gets one picture: after an early one, the next is the one that begins after its middle. After its
    // beginning it could come a second time: the pacer rounds that of a slot some way ahead.
    Refresh next = next_slot(parts_.presenter, std::max(now, last_refresh_.photon()), settings_.strips);
    if (!pacer_.is_too_slow_for(next.period)) return next;
    // Slots have to be passed over. Strips take turns, lest one be made again and again and another one never.
    const auto strips = static_cast<std::uint64_t>(settings_.strips);
    while (next.number % strips != (last_refresh_.number + 1) % strips) {
        ++next.number;
        next.scanout_begin += next.period;
    }
    return next;
}

void ServerLoop::warm_up(const RenderedFrame& frame, const Refresh& refresh) {
    Refresh slot = refresh;
    for (int strip = 0; strip < settings_.strips; ++strip, ++slot.number) {
        Duration least = Duration::max();
        for (int i = 0; i < kWarmUpWarps; ++i) {
            const TimePoint begin = parts_.clock.now();
            const PredictedPose head = head_at(begin, refresh.photon());
            parts_.warper.warp(frame, target_at(head.world_from_head, slot));
            least = std::min(least, parts_.clock.now() - begin);
        }
        slowest_strip_ = std::max(slowest_strip_, least);
    }
}

void ServerLoop::make_picture(const RenderedFrame& frame, const PacerPlan& plan, const Timing& timing) {
    DisplayRecord record;
    record.refresh = plan.refresh.number;
    record.frame_index = frame.index;
    record.frame_pose_sampled = view_pose_sampled(frame);
    record.planned_wake = plan.wake;
    record.latched = timing.woken;
    record.scanout_begin = plan.refresh.scanout_begin;
    record.photon = plan.refresh.photon();

    const PredictedPose head = head_at(timing.woken, record.photon);
    record.pose_sampled = head.newest_sample;
    record.pose_sample = head.sample_number;
    record.world_from_head = head.world_from_head;
    const WarpTarget target = target_at(head.world_from_head, plan.refresh);

    record.warp_begin = parts_.clock.now();
    parts_.warper.warp(frame, target);
    record.warp_end = parts_.clock.now();
    record.counters = parts_.warper.counters();
    held_ += parts_.warper.held();

    if (settings_.photon_codes) {
        write_photon_code(parts_.warper.display_frame_to_write_over().colour, 0, target.camera.size_px.y,
                          {static_cast<std::uint32_t>(record.pose_sample), static_cast<std::uint16_t>(frame.index)});
    }
    present(plan.refresh);
    record.presented = parts_.clock.now();
    if (settings_.feedback != nullptr) report_holes(frame, target.camera, plan.refresh);
    record.cause = cause_of(record, timing);

    if (frame.index != last_frame_index_) ++frames_shown_;
    last_frame_index_ = frame.index;
    // A picture shown again says nothing about how long the next new one takes.
    if (record.counters.pictures_reused == 0) pacer_.finished({plan.refresh, plan.wake, *record.presented});
    write_down(record);
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

Strip ServerLoop::strip_of(const Refresh& slot) const {
    const auto strips = static_cast<std::uint64_t>(settings_.strips);
    return strip_at(static_cast<int>(slot.number % strips), settings_.strips, settings_.camera.size_px.y);
}

void ServerLoop::present(const Refresh& slot) {
    if (settings_.strips == 1) {
        parts_.presenter.present(parts_.warper.display_frame(), slot);
    } else {
        parts_.presenter.present_strip(parts_.warper.display_frame(), slot, strip_of(slot));
    }
}

// After the picture is out of the door: the client can wait, the display cannot.
void ServerLoop::report_holes(const RenderedFrame& frame, const Camera& target, const Refresh& slot) {
    HoleFeedback feedback;
    feedback.shown = slot.scanout_begin;
    parts_.warper.report_holes(frame, target, feedback);
    settings_.feedback->offer(feedback);
}

WarpTarget ServerLoop::target_at(const Pose& world_from_head, const Refresh& slot) {
    parts_.movers.placements_at(slot.photon(), movers_);
    WarpTarget target;
    target.camera = camera_of(settings_.camera, strip_of(slot));
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
    write_down(record);
}

void ServerLoop::write_down(const DisplayRecord& record) {
    records_.push_back(record);
    if (settings_.on_record) settings_.on_record(record);
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
