#include "apps/live_session.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "apps/app_load.h"
#include "apps/clip_recorder.h"
#include "apps/demo_controls.h"
#include "apps/demo_overlay.h"
#include "apps/interrupt.h"
#include "apps/real_clock.h"
#include "apps/scene_mover_feed.h"
#include "apps/scene_stage.h"
#include "apps/user_head.h"
#include "apps/window_presenter.h"
#include "frame_link/sampled_head_feed.h"
#include "frame_link/sampled_mover_feed.h"
#include "warp_server/frame_warper.h"
#include "warp_server/methods/registry.h"
#include "warp_server/server_loop.h"
#include "warp_server/stereo_warper.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

// How often the main thread looks for Ctrl-C and the end, and how often it samples a viewer's hands.
constexpr Duration kWatchPeriod = std::chrono::milliseconds{10};
constexpr Duration kHandsPeriod = std::chrono::milliseconds{2};
// Room for the refreshes of a run that overruns its time a little.
constexpr std::size_t kSpareRecords = 1024;
// Strips of a picture unless --strips says, where the scan-out is known. Two cost the server nothing and give most of
// what many do; with more of them a client's frame that becomes ready meanwhile is seen in parts more often.
constexpr int kStripsOfAScanout = 2;
constexpr int kLeastRowsOfStrips = 64;
// A strip that takes more of its time than this when nothing disturbs it will often take longer than that, and strips
// that take turns show less than whole pictures that are late. Some methods take as long for a strip as for all.
constexpr double kMostOfAStripsTime = 0.7;

/// The client's rate where its frames must meet the refreshes at every phase: a period that is a whole number of
/// refreshes, give or take a fifth, gets 0.31 of one more. 0, as fast as it can, drifts by itself.
double hz_between_refreshes(double app_hz, double display_hz) {
    if (app_hz <= 0.0) return app_hz;
    const double refreshes = display_hz / app_hz;
    const double whole = std::round(refreshes);
    return std::abs(refreshes - whole) < 0.2 ? display_hz / (whole + 0.31) : app_hz;
}

class LiveSession {
public:
    LiveSession(const Options& options, const scene::Scene& scene, const Trace& trace, const AfterLiveRun& after)
        : options_{options},
          scene_{scene},
          trace_{trace},
          after_{after},
          entry_{*find_warp_method(options.method)},
          scene_movers_{scene} {}

    Result<LiveResult> run(bool window);

private:
    // Phases of a thread, each a promise to the main thread.
    struct Phases {
        std::promise<Status> ready;
        std::promise<Status> done;
    };

    Status open_window();
    Status start_client();
    Status start_server();
    void watch();
    void update_hands(const HeadInput& input, Duration step);
    void update_movers();
    void follow_keys();
    void show_next_layout();
    void show_in_next_strips();
    void stop_server();
    void show_overlay(TimePoint now);
    [[nodiscard]] bool is_over(TimePoint& end) const;

    void client_thread();
    Status prepare_client(std::unique_ptr<gl::Context>& context, std::unique_ptr<SceneRenderer>& renderer);
    void draw_until_stopped(SceneRenderer& renderer);
    void server_thread();
    Status prepare_server(std::unique_ptr<gl::Context>& context);
    Status make_warper();
    Status make_mono_warper();
    [[nodiscard]] Result<FrameWarper> make_demo_warper();
    Status make_stereo_warper();
    [[nodiscard]] glm::ivec2 picture_px() const {
        return options_.stereo.on ? packed_size_px(options_.stereo.layout, options_.size_px) : options_.size_px;
    }
    void raise_priority();
    void watch_photons();
    [[nodiscard]] bool has_photon_codes() const {
        return window_ == nullptr && options_.subcommand == Subcommand::measure;
    }
    /// To begin with, if they are made in time. A window's compositor takes whole pictures, and nobody knows how it
    /// scans them out; a GL method draws the whole source for every strip; the eyes' pictures are made whole.
    [[nodiscard]] int first_strips() const {
        const bool whole =
            window_ != nullptr || entry_.needs_gl || options_.stereo.on || options_.size_px.y < kLeastRowsOfStrips;
        return options_.strips.value_or(whole ? 1 : kStripsOfAScanout);
    }
    [[nodiscard]] std::size_t reserved_parts() const {
        return (static_cast<std::size_t>(options_.seconds * options_.display_hz) + kSpareRecords) *
               static_cast<std::size_t>(controls_.strips);
    }
    void show_until_stopped();
    void make_loop(ServerSettings& settings, Presenter& presenter);
    [[nodiscard]] bool is_in_time(int strips);
    void show(int strips);
    void take_results(const ServerLoop& loop, int strips);

    [[nodiscard]] const HeadPoseFeed& head() const {
        if (window_ != nullptr) return hands_feed_;
        return delayed_head_ ? static_cast<const HeadPoseFeed&>(*delayed_head_) : *trace_feed_;
    }
    [[nodiscard]] FrameExchange& client_exchange() { return delay_line_ ? *before_delay_ : *exchange_; }
    void begin_injection();

    const Options& options_;
    const scene::Scene& scene_;
    const Trace& trace_;
    const AfterLiveRun& after_;
    const MethodEntry& entry_;
    RealClock clock_;
    InterruptScope interrupt_;
    LiveResult result_;

    std::unique_ptr<WindowPresenter> window_;
    std::optional<VirtualDisplay> virtual_display_;
    SampledHeadFeed hands_feed_;
    UserHead user_head_;
    std::shared_ptr<const TraceFeed> trace_feed_;
    std::optional<DelayedHeadFeed> delayed_head_;
    std::optional<FrameDelayLine> delay_line_;
    SceneMoverFeed scene_movers_;
    SampledMoverFeed movers_;  ///< what the server is told of them
    std::vector<ObjectTransform> mover_update_;
    std::unique_ptr<FrameExchange> exchange_ = std::make_unique<FrameExchange>();
    std::unique_ptr<FrameExchange> before_delay_ = std::make_unique<FrameExchange>();
    HoleFeedbackLink hole_feedback_;
    FrameWarper* one_eye_ = nullptr;  ///< the warper, where there is one
    std::unique_ptr<PictureMaker> warper_;
    StereoWarper* stereo_ = nullptr;  ///< the warper, where there are two eyes
    std::unique_ptr<HeadPosePredictor> server_predictor_;
    std::unique_ptr<HeadPosePredictor> client_predictor_;
    bool textures_ = false;
    std::vector<DrawnView> views_;
    const gl::Context* client_context_ = nullptr;

    DemoControls controls_;  ///< only a window has keys for them

    // The demo's window only.
    SwitchingMethod* demo_method_ = nullptr;  ///< the warper's
    std::unique_ptr<ClipRecorder> clip_;
    DemoOverlay overlay_{options_.size_px, options_.display_hz};
    std::size_t layout_ = 0;  ///< which the key chose last

    bool realtime_allowed_ = false;
    Phases client_;
    Phases server_;
    std::promise<bool> go_;  ///< false: the other side could not start
    std::shared_future<bool> may_go_{go_.get_future()};
    std::promise<void> client_stopped_;  ///< it calls the warper's prepare step no more
    std::promise<void> server_ended_;
    std::future<void> may_drop_warper_{client_stopped_.get_future()};
    std::future<void> may_drop_frames_{server_ended_.get_future()};
    std::atomic<bool> stop_{false};
    std::atomic<bool> show_on_{false};  ///< the server's loop was stopped to go on with other strips
    // Made by their threads, stopped by the main thread through the pointers, and alive until the session ends.
    std::mutex server_mutex_;  ///< while there is another loop to stop
    std::optional<ServerLoop> server_loop_;
    std::optional<ClientLoop> client_loop_;
    std::atomic<ClientLoop*> running_client_{nullptr};
};

// Main thread.

Result<LiveResult> LiveSession::run(bool window) {
    const std::string predictor = options_.predict.value_or(std::string{kDefaultPredictor});
    for (auto* made : {&server_predictor_, &client_predictor_}) {
        // The client never foresees: the oracle concerns the server.
        const bool is_client = made == &client_predictor_;
        auto result =
            make_predictor(is_client && predictor == "oracle" ? kDefaultPredictor : std::string_view{predictor});
        if (!result) return result.error();
        *made = std::move(result).value();
    }
    if (window) {
        if (Status opened = open_window(); !opened) return opened.error();
    }
    controls_.strips = first_strips();
    std::thread{[this] { realtime_allowed_ = take_realtime_priority(); }}.join();

    std::thread client{[this] { client_thread(); }};
    Status status = client_.ready.get_future().get();
    std::thread server;
    if (status) {
        server = std::thread{[this] { server_thread(); }};
        status = server_.ready.get_future().get();
    }
    if (status) {
        trace_feed_ = std::make_shared<const TraceFeed>(trace_, clock_.now(), options_.tracker_hz);
        if (options_.inject.any()) begin_injection();
        update_hands({}, Duration{});
        update_movers();
    }
    go_.set_value(status.ok());
    if (status) watch();
    if (server.joinable()) server.join();
    if (delay_line_) delay_line_->stop();
    server_ended_.set_value();
    client.join();
    if (!status) return status.error();
    if (Status done = client_.done.get_future().get(); !done) return done.error();
    return std::move(result_);
}

void LiveSession::begin_injection() {
    result_.injection = InjectionPlan{options_.inject, clock_.now()};
    delayed_head_.emplace(*trace_feed_, result_.injection);
    if (options_.inject.app_ms) delay_line_.emplace(clock_, *before_delay_, *exchange_, result_.injection);
}

Status LiveSession::open_window() {
    if (options_.predict == "oracle") {
        return Error{"the oracle cannot foresee a viewer's hands", "--predict oracle",
                     "unset DISPLAY, or choose another predictor"};
    }
    auto window = WindowPresenter::create("Latewarp: " + scene_.name, picture_px(), options_.display_hz);
    if (!window) return window.error();
    window_ = std::move(window).value();
    clip_ = std::make_unique<ClipRecorder>(options_.out / "clip");
    window_->on_picture = [this](const ColourImage& picture, const Refresh& refresh) {
        if (controls_.recording) clip_->offer(picture, refresh.number);
    };
    result_.in_window = true;
    return Done{};
}

void LiveSession::watch() {
    TimePoint end = TimePoint::max();
    TimePoint last = clock_.now();
    while (!is_over(end)) {
        update_movers();
        if (window_ == nullptr) {
            result_.steal.sample(clock_.now());
            clock_.sleep_until(clock_.now() + kWatchPeriod);
            continue;
        }
        const HeadInput input = window_->wait_for_input(kHandsPeriod);
        const TimePoint now = clock_.now();
        update_hands(input, now - last);
        last = now;
        follow_keys();
        show_overlay(now);
        if (Status clip = clip_->write(); !clip) print_warnings({clip.error().message()}, false);
    }
    stop_ = true;
    stop_server();
    if (ClientLoop* loop = running_client_) loop->request_stop();
}

// Once before there is anybody to ask for the head: it would be at the world's origin.
void LiveSession::update_hands(const HeadInput& input, Duration step) {
    const TimePoint now = clock_.now();
    user_head_.advance(input, step, trace_feed_->pose_at(now));
    hands_feed_.push(now, user_head_.pose());
}

// As an application would that moves its objects a hundred times a second: the server predicts from there.
void LiveSession::update_movers() {
    const TimePoint now = clock_.now();
    scene_movers_.placements_at(now, mover_update_);
    movers_.push(now, mover_update_);
}

void LiveSession::follow_keys() {
    const std::string keys = window_->take_keys();
    for (const char key : keys) {
        if (key == 'M') ++controls_.method;
        if (key == 'H') controls_.holes_shown = !controls_.holes_shown;
        if (key == 'F') controls_.renderer_frozen = !controls_.renderer_frozen;
        if (key == 'L') controls_.false_colours = !controls_.false_colours;
        if (key == 'O') controls_.overlay_shown = !controls_.overlay_shown;
        if (key == 'R') controls_.recording = !controls_.recording;
        if (key == 'T') show_next_layout();
        if (key == 'P') show_in_next_strips();
        const std::size_t rate = controls_.app_rate;
        if (key == '+') controls_.app_rate = std::min(rate + 1, DemoControls::kAppRates_hz.size() - 1);
        if (key == '-') controls_.app_rate = rate == 0 ? 0 : rate - 1;
    }
    if (keys.empty()) return;
    overlay_.outdate();
    ClientLoop* client = running_client_;
    if (client == nullptr) return;
    client->set_frozen(controls_.renderer_frozen);
    if (keys.find_first_of("+-") != std::string::npos)
        client->set_max_hz(DemoControls::kAppRates_hz[controls_.app_rate]);
}

// Pictures of another size than the window's are stretched to it.
void LiveSession::show_next_layout() {
    if (stereo_ == nullptr) return;
    constexpr std::array kLayouts{EyeLayout::side_by_side, EyeLayout::top_bottom, EyeLayout::anaglyph};
    layout_ = (layout_ + 1) % kLayouts.size();
    stereo_->set_layout(kLayouts[layout_]);
}

// What the pacer has learnt of strips says nothing about others, so another loop goes on.
void LiveSession::show_in_next_strips() {
    if (stereo_ != nullptr) return;
    const int more = 2 * controls_.strips;
    controls_.strips = more > std::min(DemoControls::kMostStrips, options_.size_px.y) ? 1 : more;
    show_on_ = true;
    stop_server();
}

void LiveSession::stop_server() {
    const std::lock_guard lock{server_mutex_};
    if (server_loop_) server_loop_->request_stop();
}

void LiveSession::show_overlay(TimePoint now) {
    if (!overlay_.is_due(now)) return;
    const std::vector<std::string> labels =
        demo_method_ != nullptr ? demo_method_->labels() : std::vector<std::string>{options_.method};
    const DemoState state{labels[controls_.method % labels.size()], stereo_ != nullptr, exchange_->published_count(),
                          clip_->written()};
    window_->set_overlay(overlay_.panels(now, controls_, state));
}

bool LiveSession::is_over(TimePoint& end) const {
    if (end == TimePoint::max() && exchange_->published_count() > 0)
        end = clock_.now() + from_seconds(options_.seconds);
    if (interrupt_.interrupted()) return true;
    if (window_ != nullptr && window_->closed()) return true;
    return clock_.now() >= end && !user_head_.is_taken();
}

// Client's thread.

void LiveSession::client_thread() {
    name_thread("lw-client");
    if (!realtime_allowed_) result_.scheduling = step_back() ? Scheduling::nice : Scheduling::none;
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<SceneRenderer> renderer;
    const Status ready = prepare_client(context, renderer);
    client_.ready.set_value(ready);
    if (may_go_.get()) draw_until_stopped(*renderer);
    client_stopped_.set_value();
    may_drop_frames_.wait();
    // The server's thread is gone: what it wrote is visible here, and its frames may be dropped.
    exchange_.reset();
    before_delay_.reset();
    Status done{Done{}};
    if (ready && may_go_.get()) {
        result_.interrupted = interrupt_.interrupted();
        if (after_) done = after_(*renderer, *context, result_);
    }
    renderer.reset();
    context.reset();
    client_.done.set_value(done);
}

Status LiveSession::prepare_client(std::unique_ptr<gl::Context>& context, std::unique_ptr<SceneRenderer>& renderer) {
    auto made_context = gl::Context::create();
    if (!made_context) return made_context.error();
    context = std::move(made_context).value();
    context->make_current();
    client_context_ = context.get();
    textures_ = entry_.needs_gl && !context->is_software();
    auto made_renderer = SceneRenderer::create(
        scene_, {.culling = options_.culling, .billboards = options_.billboards, .order = options_.draw_order});
    if (!made_renderer) return made_renderer.error();
    renderer = with_load(std::move(made_renderer).value(), options_.load);
    if (textures_ && options_.inject.app_ms) {
        return Error{"frames in textures cannot be delayed", "--inject app", "choose a CPU --method"};
    }
    if (auto views = drawn_views_of(options_, &trace_)) {
        views_ = *std::move(views);
    } else {
        return views.error();
    }
    if (textures_ && options_.source.layers > 1) {
        return Error{"a hidden layer cannot be handed over in textures yet", "--layers 2", "choose a CPU --method"};
    }
    if (textures_ && options_.shells.on) {
        return Error{"shells cannot be handed over in textures yet", "--shells", "choose a CPU --method"};
    }
    // The driver compiles at the first draw; that is no frame of the run.
    Camera camera = views_.front().camera;
    camera.world_from_eye = trace_.at(0.0);
    CpuPixels pixels;
    renderer->use_billboards(true);
    renderer->draw_resolved(camera, 0.0, options_.source.samples_per_axis, pixels);
    if (options_.source.layers > 1 || options_.shells.on) {
        const DepthImage limits{camera.size_px, 1.0F};
        ScenePart behind;
        behind.behind = &limits;
        renderer->draw_part(camera, 0.0, options_.source.samples_per_axis, behind, pixels);
    }
    return Done{};
}

void LiveSession::draw_until_stopped(SceneRenderer& renderer) {
    ClientSettings settings;
    settings.camera = options_.camera();
    settings.views = views_;
    settings.max_hz = options_.app_hz.value_or(0.0);
    if (options_.inject.any()) settings.max_hz = hz_between_refreshes(settings.max_hz, options_.display_hz);
    settings.predict_source_pose = options_.source_pose == SourcePose::predicted;
    settings.source = options_.source;
    // A software GL pays for every pixel: twice of them (1.9x in the city) halved the client's rate, and the frames got
    // older by more than the band covers. There `auto` means none; a band in degrees is drawn as asked.
    if (!settings.source.guard_band_rad && client_context_->is_software()) settings.source.guard_band_rad = 0.0;
    settings.textures = textures_;
    settings.shells = options_.shells;
    settings.feedback = options_.shells.on ? &hole_feedback_ : nullptr;
    settings.reveal_margin_m = options_.reveal_margin_m;
    settings.min_pixels = options_.culling.min_pixels;
    const auto prepare = [this](Layer& layer) {
        if (layer.name == views_.front().name) result_.source_views.push_back({layer.camera, layer.scene_time_s});
        warper_->prepare(layer);
    };
    client_loop_.emplace(renderer, clock_, head(), client_exchange(), std::move(client_predictor_), prepare, settings);
    running_client_ = &*client_loop_;
    if (stop_) client_loop_->request_stop();  // asked for before there was a loop to ask
    client_loop_->run();
    result_.app_frames = client_loop_->records();
    result_.shells = client_loop_->shell_records();
    if (options_.shells.on) {
        for (const ClientFrameRecord& frame : result_.app_frames) {
            result_.source_views.push_back({frame.view, frame.scene_time_s});
        }
    }
    result_.app_failure = client_loop_->failure();
    if (!result_.app_failure.empty()) {
        print_warnings({fmt::format("the client stopped ({}): its last frame stays", result_.app_failure)}, false);
    }
}

// Server's thread.

void LiveSession::server_thread() {
    name_thread("lw-server");
    std::unique_ptr<gl::Context> context;
    const Status ready = prepare_server(context);
    server_.ready.set_value(ready);
    if (may_go_.get()) show_until_stopped();
    may_drop_warper_.wait();
    warper_.reset();
    if (window_ != nullptr && ready) window_->detach();
    context.reset();
}

Status LiveSession::prepare_server(std::unique_ptr<gl::Context>& context) {
    if (entry_.needs_gl) {
        auto made = gl::Context::create(textures_ ? client_context_ : nullptr);
        if (!made) return made.error();
        context = std::move(made).value();
        context->make_current();
    }
    // The threads of a CPU method inherit the priority; those of a GL driver must not.
    if (!entry_.needs_gl) raise_priority();
    if (Status made = make_warper(); !made) return made;
    if (window_ != nullptr) {
        window_->attach(clock_.now());
    } else {
        virtual_display_.emplace(clock_.now(), options_.display_hz, picture_px());
    }
    if (entry_.needs_gl) raise_priority();
    wake_exactly();
    return Done{};
}

Status LiveSession::make_warper() { return options_.stereo.on ? make_stereo_warper() : make_mono_warper(); }

Status LiveSession::make_mono_warper() {
    const bool plain = window_ == nullptr || entry_.needs_gl;
    auto warper = plain ? FrameWarper::create(options_.method, options_.fill) : make_demo_warper();
    if (!warper) return warper.error();
    auto made = std::make_unique<FrameWarper>(*std::move(warper));
    one_eye_ = made.get();
    warper_ = std::move(made);
    return Done{};
}

// Its method and what it shows in holes follow the keys.
Result<FrameWarper> LiveSession::make_demo_warper() {
    auto method = make_demo_method(options_.method, controls_);
    if (!method) return method.error();
    auto fill = make_fill(options_.fill);
    if (!fill) return fill.error();
    demo_method_ = method->get();
    return FrameWarper{std::move(*method), make_demo_fill(std::move(*fill), controls_)};
}

Status LiveSession::make_stereo_warper() {
    StereoSettings settings{stereo_rig_of(options_, &trace_), options_.stereo.layout, !entry_.needs_gl};
    const bool plain = window_ == nullptr || entry_.needs_gl || options_.stereo.mode == StereoMode::scanline;
    std::unique_ptr<StereoWarper> made;
    if (plain) {
        auto warper =
            StereoWarper::create(options_.method, options_.fill, options_.stereo.mode, options_.camera(), settings);
        if (!warper) return warper.error();
        made = std::move(*warper);
    } else {
        auto left = make_demo_warper();
        if (!left) return left.error();
        auto right = make_demo_warper();
        if (!right) return right.error();
        made = std::make_unique<StereoWarper>(*std::move(left), *std::move(right), settings);
    }
    stereo_ = made.get();
    warper_ = std::move(made);
    return Done{};
}

void LiveSession::watch_photons() {
    PhotonWatchSettings settings;
    settings.strips = controls_.strips;
    settings.reserved_parts = reserved_parts();
    settings.panel_latency = [this](TimePoint scanout) { return result_.injection.delay(Injected::present, scanout); };
    virtual_display_->watch_photons(clock_, settings);
}

void LiveSession::raise_priority() {
    if (realtime_allowed_ && take_realtime_priority()) result_.scheduling = Scheduling::fifo;
}

void LiveSession::show_until_stopped() {
    ServerSettings settings;
    settings.camera = options_.camera();
    if (options_.lead_given) settings.pacer.fixed_lead = from_ms(options_.lead_ms);
    settings.feedback = options_.shells.on ? &hole_feedback_ : nullptr;
    settings.photon_codes = has_photon_codes();
    if (window_ != nullptr) {
        settings.on_record = [this](const DisplayRecord& record) {
            overlay_.note(record);
            if (one_eye_ != nullptr) one_eye_->set_false_colours(controls_.false_colours);
        };
    }
    settings.thread_cpu_time = entry_.needs_gl ? nullptr : thread_cpu_time;
    Presenter& presenter = window_ != nullptr ? static_cast<Presenter&>(*window_) : *virtual_display_;
    make_loop(settings, presenter);
    if (!options_.strips && settings.strips > 1 && !is_in_time(settings.strips)) {
        controls_.strips = 1;
        make_loop(settings, presenter);
    }
    if (has_photon_codes()) watch_photons();
    show(settings.strips);
    while (show_on_.exchange(false) && !stop_) {
        make_loop(settings, presenter);
        show(settings.strips);
    }
    if (virtual_display_) {
        const auto seen = virtual_display_->seen();
        result_.seen.assign(seen.begin(), seen.end());
        result_.true_head = trace_feed_;
    }
    result_.display_camera = settings.camera;
    if (stereo_ == nullptr) return;
    for (const Eye eye : kEyes) result_.last_eyes.push_back(stereo_->eye(eye).display_frame().colour);
}

void LiveSession::make_loop(ServerSettings& settings, Presenter& presenter) {
    settings.strips = controls_.strips;
    settings.reserved_refreshes = reserved_parts();
    const std::lock_guard lock{server_mutex_};
    server_loop_.emplace(ServerParts{clock_, *exchange_, head(), movers_, *server_predictor_, *warper_, presenter},
                         settings);
    if (stop_) server_loop_->request_stop();
}

bool LiveSession::is_in_time(int strips) {
    return to_seconds(server_loop_->rehearse()) <= kMostOfAStripsTime / (options_.display_hz * strips);
}

void LiveSession::show(int strips) {
    server_loop_->run();
    take_results(*server_loop_, strips);
}

void LiveSession::take_results(const ServerLoop& loop, int strips) {
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(result_.parts, loop.records());
    append(result_.refreshes, worst_strips(loop.records(), strips));
    append(result_.warp_times, warp_times(loop.records(), strips));
    result_.strips = strips;
    result_.app_frames_shown += loop.frames_shown();
    result_.bad_head_poses += loop.bad_head_poses();
    result_.bad_placements += loop.held().bad_placement;
    result_.bad_layers += loop.held().bad_layer;
}

}  // namespace

Result<LiveResult> run_live(const Options& options, const scene::Scene& scene, const Trace& trace, bool window,
                            const AfterLiveRun& after) {
    return LiveSession{options, scene, trace, after}.run(window);
}

}  // namespace lw
