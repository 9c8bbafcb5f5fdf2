#include "client_renderer/client_loop.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "client_renderer/hidden_layer.h"
#include "client_renderer/reveal_margin.h"

namespace lw {

namespace {

// How often a client that was told to hold still looks whether it still is.
constexpr Duration kFrozenLook = std::chrono::milliseconds{10};

// How often a client of shells looks whether anything has become wrong, while nothing has.
constexpr Duration kValidLook = std::chrono::milliseconds{5};

// Frames differ little from one to the next: a third of the newest follows a change within a few frames and halves the
// jitter.
Duration smoothed(Duration past, Duration newest) {
    return past == Duration::zero() ? newest : past + (newest - past) / 3;
}

}  // namespace

ClientLoop::ClientLoop(SceneRenderer& renderer, Clock& clock, const HeadPoseFeed& head, FrameExchange& exchange,
                       std::unique_ptr<HeadPosePredictor> predictor, PrepareLayer prepare, ClientSettings settings)
    : renderer_{renderer},
      clock_{clock},
      head_{head},
      exchange_{exchange},
      predictor_{std::move(predictor)},
      prepare_{std::move(prepare)},
      settings_{std::move(settings)},
      max_hz_{settings_.max_hz} {
    if (settings_.views.empty()) settings_.views = single_view(settings_.camera);
    for (const DrawnView& view : settings_.views) {
        views_.push_back({view, SourceCameras{view.camera, settings_.source}});
    }
    LW_CHECK(predictor_ != nullptr, "a client without a predictor");
    records_.reserve(4096);  // minutes of frames: growing would cost a frame now and then
    if (!settings_.shells.on) return;
    settings_.shells.clock = &clock_;
    const auto prepare_drawn = [this](const std::shared_ptr<Layer>& layer) {
        if (prepare_) prepare_(*layer);
    };
    LW_CHECK(views_.size() == 1, fmt::format("shells with {} views", views_.size()));
    shells_ = std::make_unique<ShellClient>(renderer_, views_.front().drawn.camera, settings_.source, settings_.shells,
                                            prepare_drawn);
}

void ClientLoop::run() {
    try {
        draw_until_stopped();
    } catch (const std::exception& error) {
        failure_ = error.what();
    } catch (...) {
        failure_ = "an unknown exception";
    }
}

void ClientLoop::draw_until_stopped() {
    TimePoint next_start = clock_.now();
    while (!stop_.load(std::memory_order_relaxed)) {
        if (frozen_.load(std::memory_order_relaxed)) {
            clock_.sleep_until(clock_.now() + kFrozenLook);
            continue;
        }
        draw_and_publish();
        const double max_hz = max_hz_.load(std::memory_order_relaxed);
        if (max_hz <= 0.0) continue;
        // A late frame starts the next at once, and the rhythm anew.
        next_start = std::max(next_start + from_seconds(1.0 / max_hz), clock_.now());
        clock_.sleep_until(next_start);
    }
}

void ClientLoop::draw_view(View& view, const FrameTimes& times, std::vector<std::shared_ptr<Layer>>& layers) {
    auto layer = layers_.acquire();
    layer->name = view.drawn.name;
    layer->for_eye = view.drawn.for_eye;
    // A frame is shown until one period after it was published.
    layer->camera = view.cameras.next(head_, times.sampled, latency_ + period_);
    layer->camera.world_from_eye = compose(times.head.world_from_head, view.drawn.head_from_view);
    layer->pose_sampled = times.head.newest_sample;
    layer->scene_time_s = seconds_of(times.target);
    renderer_.set_reveal_margin(eye_motion_m(view, times));
    const int samples = settings_.source.samples_per_axis;
    if (settings_.textures) {
        layer->pixels = renderer_.draw_to_textures(layer->camera, layer->scene_time_s, samples);
    } else {
        renderer_.draw_resolved(layer->camera, layer->scene_time_s, samples, layer->cpu());
    }
    renderer_.mover_placements(layer->scene_time_s, layer->movers);
    layers.push_back(std::move(layer));
}

void ClientLoop::draw_hidden(const View& view, const FrameTimes& times, std::vector<std::shared_ptr<Layer>>& layers) {
    auto hidden = layers_.acquire();
    draw_hidden_layer(renderer_, *layers.back(), settings_.source.samples_per_axis, eye_motion_m(view, times), *hidden);
    hidden->for_eye = view.drawn.for_eye;
    layers.push_back(std::move(hidden));
}

// How far the eyes that look at the frame come from where it was drawn: with the head, and by their place in it.
double ClientLoop::eye_motion_m(const View& view, const FrameTimes& times) {
    const TimePoint shown_from = times.sampled + latency_;
    return view.drawn.eye_distance_m + reveal_margin_m(settings_.reveal_margin_m, *predictor_, head_, times.sampled,
                                                       times.head.world_from_head, shown_from, shown_from + period_);
}

const std::vector<ShellFrameRecord>& ClientLoop::shell_records() const {
    static const std::vector<ShellFrameRecord> none;
    return shells_ != nullptr ? shells_->records() : none;
}

void ClientLoop::draw_and_publish_shells() {
    const TimePoint sampled = clock_.now();
    const TimePoint target = settings_.predict_source_pose ? middle_of_display_life(sampled) : sampled;
    const TimePoint shown_from = sampled + latency_;
    View& view = views_.front();
    const auto head_at = [&](TimePoint time) { return predictor_->predict(head_, sampled, time); };
    const auto view_at = [&](const PredictedPose& pose) {
        return compose(pose.world_from_head, view.drawn.head_from_view);
    };
    const PredictedPose middle = head_at(target);
    ShellMoment moment;
    moment.now_s = seconds_of(sampled);
    moment.scene_time_s = seconds_of(target);
    moment.pose_sampled = middle.newest_sample;
    moment.shown_from = view_at(head_at(shown_from));
    moment.shown_middle = view_at(middle);
    moment.shown_until = view_at(head_at(shown_from + period_));
    moment.source = view.cameras.next(head_, sampled, latency_ + period_);
    moment.head_motion_m = eye_motion_m(view, {sampled, target, middle});
    if (settings_.feedback != nullptr) shells_->take(settings_.feedback->take());

    auto frame = std::make_shared<RenderedFrame>();
    frame->times.pose_sampled = middle.newest_sample;
    frame->times.render_begin = clock_.now();
    frame->layers = shells_->draw(moment);
    frame->times.render_end = clock_.now();
    if (shells_->records().back().draws.empty() && !records_.empty()) {
        clock_.sleep_until(clock_.now() + kValidLook);
        return;
    }
    frame->index = records_.size() + 1;
    frame->times.published = clock_.now();
    const Layer& drawn = *frame->layers.front();
    const ClientFrameRecord record{frame->index, frame->times, shells_->counters(), drawn.camera, drawn.scene_time_s};
    exchange_.publish(std::move(frame));
    learn_timing(sampled, record.times.published);
    records_.push_back(record);
}

void ClientLoop::draw_and_publish() {
    if (shells_ != nullptr) return draw_and_publish_shells();
    const TimePoint sampled = clock_.now();
    const TimePoint target = settings_.predict_source_pose ? middle_of_display_life(sampled) : sampled;
    const FrameTimes times{sampled, target, predictor_->predict(head_, sampled, target)};
    if (settings_.min_pixels > 0.0) {
        renderer_.set_viewer_moves(viewer_moves(*predictor_, head_, sampled, sampled + latency_ + period_));
    }

    ClientFrameRecord record;
    record.index = records_.size() + 1;
    record.times.pose_sampled = times.head.newest_sample;
    record.times.render_begin = clock_.now();
    std::vector<std::shared_ptr<Layer>> layers;
    for (View& view : views_) {
        draw_view(view, times, layers);
        record.counters = renderer_.counters();
        if (settings_.source.layers == 2) draw_hidden(view, times, layers);
    }
    record.times.render_end = clock_.now();

    auto frame = std::make_shared<RenderedFrame>();
    frame->index = record.index;
    for (std::shared_ptr<Layer>& layer : layers) {
        if (prepare_) prepare_(*layer);
        frame->layers.push_back(std::move(layer));
    }
    record.times.published = clock_.now();
    frame->times = record.times;
    exchange_.publish(std::move(frame));
    learn_timing(sampled, record.times.published);
    records_.push_back(record);
}

TimePoint ClientLoop::middle_of_display_life(TimePoint sampled) const { return sampled + latency_ + period_ / 2; }

void ClientLoop::learn_timing(TimePoint sampled, TimePoint published) {
    latency_ = smoothed(latency_, published - sampled);
    // The first frame's period is not known yet: as fast as it can, a frame lasts as long as it takes.
    period_ = smoothed(period_, records_.empty() ? published - sampled : published - records_.back().times.published);
}

}  // namespace lw
