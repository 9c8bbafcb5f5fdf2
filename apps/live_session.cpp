#include "apps/live_session.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "apps/clip_recorder.h"
#include "apps/demo_overlay.h"
#include "apps/interrupt.h"
#include "apps/live_client.h"
#include "apps/live_run.h"
#include "apps/live_server.h"
#include "apps/scene_mover_feed.h"
#include "apps/scene_stage.h"
#include "apps/thread_priority.h"
#include "apps/user_head.h"
#include "apps/window_presenter.h"
#include "frame_link/sampled_head_feed.h"

namespace lw {
namespace {

// How often the main thread looks for Ctrl-C and the end, and how often it samples a viewer's hands.
constexpr Duration kWatchPeriod = std::chrono::milliseconds{10};
constexpr Duration kHandsPeriod = std::chrono::milliseconds{2};

// The main thread of a live run: window and keys, the head and the movers, beginning and end.
class LiveSession {
public:
    LiveSession(const Options& options, const scene::Scene& scene, const Trace& trace, const AfterLiveRun& after)
        : options_{options}, after_{after}, run_{options, scene, trace}, scene_movers_{scene} {}

    Result<LiveResult> run(bool window);

private:
    Status open_window();
    [[nodiscard]] Status make_sides();
    [[nodiscard]] Status run_sides();
    void begin_feeds();
    void begin_injection();
    void watch();
    void update_hands(const HeadInput& input, Duration step);
    void update_movers();
    void follow_keys();
    void show_next_layout();
    void show_overlay(TimePoint now);
    [[nodiscard]] bool is_over(TimePoint& end) const;

    const Options& options_;
    const AfterLiveRun& after_;
    InterruptScope interrupt_;
    LiveRun run_;

    // What the head and the movers do.
    UserHead user_head_;
    SampledHeadFeed hands_feed_;
    std::optional<DelayedHeadFeed> delayed_head_;
    std::optional<FrameDelayLine> delay_line_;
    SceneMoverFeed scene_movers_;
    std::vector<ObjectTransform> mover_update_;

    // The demo's window only.
    std::unique_ptr<WindowPresenter> window_;
    std::unique_ptr<ClipRecorder> clip_;
    DemoOverlay overlay_{options_.size_px, options_.display_hz};
    std::size_t layout_ = 0;  ///< which the key chose last

    std::optional<LiveClient> client_;
    std::optional<LiveServer> server_;
};

Result<LiveResult> LiveSession::run(bool window) {
    if (window) {
        if (Status opened = open_window(); !opened) return opened.error();
    }
    if (Status made = make_sides(); !made) return made.error();
    std::thread{[this] { run_.realtime_allowed = take_realtime_priority(); }}.join();
    if (Status ran = run_sides(); !ran) return ran.error();
    return std::move(run_.result);
}

Status LiveSession::open_window() {
    if (options_.predict == "oracle") {
        return Error{"the oracle cannot foresee a viewer's hands", "--predict oracle",
                     "unset DISPLAY, or choose another predictor"};
    }
    auto window =
        WindowPresenter::create("Latewarp: " + run_.scene.name, picture_size_px(options_), options_.display_hz);
    if (!window) return window.error();
    window_ = std::move(window).value();
    clip_ = std::make_unique<ClipRecorder>(options_.out / "clip");
    window_->on_picture = [this](const ColourImage& picture, const Refresh& refresh) {
        if (run_.controls.recording) clip_->offer(picture, refresh.number);
    };
    run_.result.in_window = true;
    return Done{};
}

Status LiveSession::make_sides() {
    const std::string predictor = options_.predict.value_or(std::string{kDefaultPredictor});
    auto for_server = make_predictor(predictor);
    if (!for_server) return for_server.error();
    // The client never foresees: the oracle concerns the server.
    auto for_client = make_predictor(predictor == "oracle" ? kDefaultPredictor : std::string_view{predictor});
    if (!for_client) return for_client.error();
    client_.emplace(run_, std::move(for_client).value(), after_);
    server_.emplace(run_, window_.get(), overlay_, std::move(for_server).value());
    return Done{};
}

Status LiveSession::run_sides() {
    std::thread client{[this] { client_->run_thread(); }};
    Status status = client_->wait_until_ready();
    std::thread server;
    if (status) {
        server = std::thread{[this] { server_->run_thread(); }};
        status = server_->wait_until_ready();
    }
    if (status) begin_feeds();
    run_.go.set_value(status.ok());
    if (status) watch();
    if (server.joinable()) server.join();
    if (delay_line_) delay_line_->stop();
    run_.result.interrupted = interrupt_.interrupted();
    run_.server_ended.set_value();
    client.join();
    return status ? client_->outcome() : status;
}

void LiveSession::begin_feeds() {
    run_.trace_feed = std::make_shared<const TraceFeed>(run_.trace, run_.clock.now(), options_.tracker_hz);
    run_.head = run_.trace_feed.get();
    if (options_.inject.any()) begin_injection();
    if (window_ != nullptr) run_.head = &hands_feed_;
    update_hands({}, Duration{});
    update_movers();
}

void LiveSession::begin_injection() {
    run_.result.injection = InjectionPlan{options_.inject, run_.clock.now()};
    run_.head = &delayed_head_.emplace(*run_.trace_feed, run_.result.injection);
    if (!options_.inject.app_ms) return;
    run_.delays_frames = true;
    delay_line_.emplace(run_.clock, *run_.before_delay, *run_.exchange, run_.result.injection);
}

void LiveSession::watch() {
    TimePoint end = TimePoint::max();
    TimePoint last = run_.clock.now();
    while (!is_over(end)) {
        update_movers();
        if (window_ == nullptr) {
            run_.result.steal.sample(run_.clock.now());
            run_.clock.sleep_until(run_.clock.now() + kWatchPeriod);
            continue;
        }
        const HeadInput input = window_->wait_for_input(kHandsPeriod);
        const TimePoint now = run_.clock.now();
        update_hands(input, now - last);
        last = now;
        follow_keys();
        show_overlay(now);
        if (Status clip = clip_->write(); !clip) print_warnings({clip.error().message()}, false);
    }
    run_.stop = true;
    server_->request_stop();
    client_->request_stop();
}

// Once before there is anybody to ask for the head: it would be at the world's origin.
void LiveSession::update_hands(const HeadInput& input, Duration step) {
    const TimePoint now = run_.clock.now();
    user_head_.advance(input, step, run_.trace_feed->pose_at(now));
    hands_feed_.push(now, user_head_.pose());
}

// As an application would that moves its objects a hundred times a second: the server predicts from there.
void LiveSession::update_movers() {
    const TimePoint now = run_.clock.now();
    scene_movers_.placements_at(now, mover_update_);
    run_.movers.push(now, mover_update_);
}

void LiveSession::follow_keys() {
    const std::string keys = window_->take_keys();
    if (keys.empty()) return;
    DemoControls& controls = run_.controls;
    for (const char key : keys) {
        if (key == 'M') ++controls.method;
        if (key == 'H') controls.holes_shown = !controls.holes_shown;
        if (key == 'F') controls.renderer_frozen = !controls.renderer_frozen;
        if (key == 'L') controls.false_colours = !controls.false_colours;
        if (key == 'O') controls.overlay_shown = !controls.overlay_shown;
        if (key == 'R') controls.recording = !controls.recording;
        if (key == 'T') show_next_layout();
        if (key == 'P') server_->show_in_next_strips();
        const std::size_t rate = controls.app_rate;
        if (key == '+') controls.app_rate = std::min(rate + 1, DemoControls::kAppRates_hz.size() - 1);
        if (key == '-') controls.app_rate = rate == 0 ? 0 : rate - 1;
    }
    overlay_.outdate();
    client_->set_frozen(controls.renderer_frozen);
    if (keys.find_first_of("+-") != std::string::npos) {
        client_->set_max_hz(DemoControls::kAppRates_hz[controls.app_rate]);
    }
}

// Pictures of another size than the window's are stretched to it.
void LiveSession::show_next_layout() {
    StereoWarper* two_eyes = run_.warper.two_eyes;
    if (two_eyes == nullptr) return;
    constexpr std::array kLayouts{EyeLayout::side_by_side, EyeLayout::top_bottom, EyeLayout::anaglyph};
    layout_ = (layout_ + 1) % kLayouts.size();
    two_eyes->set_layout(kLayouts[layout_]);
}

void LiveSession::show_overlay(TimePoint now) {
    if (!overlay_.is_due(now)) return;
    const SwitchingMethod* switching = run_.warper.demo_method;
    const std::vector<std::string> labels =
        switching != nullptr ? switching->labels() : std::vector<std::string>{options_.method};
    const DemoState state{labels[run_.controls.method % labels.size()], options_.stereo.on,
                          run_.exchange->published_count(), clip_->written()};
    window_->set_overlay(overlay_.panels(now, run_.controls, state));
}

bool LiveSession::is_over(TimePoint& end) const {
    if (end == TimePoint::max() && run_.exchange->published_count() > 0) {
        end = run_.clock.now() + from_seconds(options_.seconds);
    }
    if (interrupt_.interrupted()) return true;
    if (window_ != nullptr && window_->closed()) return true;
    return run_.clock.now() >= end && !user_head_.is_taken();
}

}  // namespace

Result<LiveResult> run_live(const Options& options, const scene::Scene& scene, const Trace& trace, bool window,
                            const AfterLiveRun& after) {
    return LiveSession{options, scene, trace, after}.run(window);
}

}  // namespace lw
