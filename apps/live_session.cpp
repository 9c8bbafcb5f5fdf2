#include "apps/live_session.h"

#include <cstdlib>
#include <future>
#include <memory>
#include <optional>
#include <thread>

#include "apps/interrupt.h"
#include "apps/real_clock.h"
#include "apps/scene_mover_feed.h"
#include "apps/user_head.h"
#include "apps/window_presenter.h"
#include "frame_link/sampled_head_feed.h"
#include "warp_server/methods/registry.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

// How often the main thread looks for Ctrl-C and the end, and how often it samples a viewer's hands.
constexpr Duration kWatchPeriod = std::chrono::milliseconds{10};
constexpr Duration kHandsPeriod = std::chrono::milliseconds{2};
// Room for the refreshes of a run that overruns its time a little.
constexpr std::size_t kSpareRecords = 1024;

class LiveSession {
public:
    LiveSession(const Options& options, const scene::Scene& scene, const Trace& trace, const AfterLiveRun& after)
        : options_{options},
          scene_{scene},
          trace_{trace},
          after_{after},
          entry_{*find_warp_method(options.method)},
          movers_{scene} {}

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
    [[nodiscard]] bool is_over(TimePoint& end) const;

    void client_thread();
    Status prepare_client(std::unique_ptr<gl::Context>& context, std::unique_ptr<SceneRenderer>& renderer);
    void draw_until_stopped(SceneRenderer& renderer);
    void server_thread();
    Status prepare_server(std::unique_ptr<gl::Context>& context);
    void raise_priority();
    void show_until_stopped();

    [[nodiscard]] const HeadPoseFeed& head() const {
        return window_ != nullptr ? static_cast<const HeadPoseFeed&>(hands_feed_) : *trace_feed_;
    }

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
    std::optional<TraceFeed> trace_feed_;
    SceneMoverFeed movers_;
    std::unique_ptr<FrameExchange> exchange_ = std::make_unique<FrameExchange>();
    std::optional<FrameWarper> warper_;
    std::unique_ptr<HeadPosePredictor> server_predictor_;
    std::unique_ptr<HeadPosePredictor> client_predictor_;
    bool textures_ = false;
    const gl::Context* client_context_ = nullptr;

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
    // Made by their threads, stopped by the main thread through the pointers, and alive until the session ends.
    std::optional<ServerLoop> server_loop_;
    std::optional<ClientLoop> client_loop_;
    std::atomic<ServerLoop*> running_server_{nullptr};
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
    std::thread{[this] { realtime_allowed_ = take_realtime_priority(); }}.join();

    std::thread client{[this] { client_thread(); }};
    Status status = client_.ready.get_future().get();
    std::thread server;
    if (status) {
        server = std::thread{[this] { server_thread(); }};
        status = server_.ready.get_future().get();
    }
    if (status) trace_feed_.emplace(trace_, clock_.now(), options_.tracker_hz);
    go_.set_value(status.ok());
    if (status) watch();
    if (server.joinable()) server.join();
    server_ended_.set_value();
    client.join();
    if (!status) return status.error();
    if (Status done = client_.done.get_future().get(); !done) return done.error();
    return std::move(result_);
}

Status LiveSession::open_window() {
    if (options_.predict == "oracle") {
        return Error{"the oracle cannot foresee a viewer's hands", "--predict oracle",
                     "unset DISPLAY, or choose another predictor"};
    }
    auto window = WindowPresenter::create("Latewarp: " + scene_.name, options_.size_px, options_.display_hz);
    if (!window) return window.error();
    window_ = std::move(window).value();
    result_.in_window = true;
    return Done{};
}

void LiveSession::watch() {
    TimePoint end = TimePoint::max();
    TimePoint last = clock_.now();
    while (!is_over(end)) {
        if (window_ == nullptr) {
            clock_.sleep_until(clock_.now() + kWatchPeriod);
            continue;
        }
        const HeadInput input = window_->wait_for_input(kHandsPeriod);
        const TimePoint now = clock_.now();
        user_head_.advance(input, now - last, trace_feed_->pose_at(now));
        hands_feed_.push(now, user_head_.pose());
        last = now;
    }
    stop_ = true;
    if (ServerLoop* loop = running_server_) loop->request_stop();
    if (ClientLoop* loop = running_client_) loop->request_stop();
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
    auto made_renderer = SceneRenderer::create(scene_, {options_.culling});
    if (!made_renderer) return made_renderer.error();
    renderer = std::move(made_renderer).value();
    // The driver compiles at the first draw; that is no frame of the run.
    Camera camera = options_.camera();
    camera.world_from_eye = trace_.at(0.0);
    CpuPixels pixels;
    renderer->draw_resolved(camera, 0.0, options_.source.samples_per_axis, pixels);
    return Done{};
}

void LiveSession::draw_until_stopped(SceneRenderer& renderer) {
    ClientSettings settings;
    settings.camera = options_.camera();
    settings.max_hz = options_.app_hz.value_or(0.0);
    settings.predict_source_pose = options_.source_pose == SourcePose::predicted;
    settings.source = options_.source;
    // A software GL pays for every pixel: twice of them (1.9x in the city) halved the client's rate, and the frames got
    // older by more than the band covers. There `auto` means none; a band in degrees is drawn as asked.
    if (!settings.source.guard_band_rad && client_context_->is_software()) settings.source.guard_band_rad = 0.0;
    settings.textures = textures_;
    settings.reveal_margin_m = options_.reveal_margin_m;
    settings.min_pixels = options_.culling.min_pixels;
    const auto prepare = [this](Layer& layer) {
        result_.source_views.push_back({layer.camera, layer.scene_time_s});
        warper_->prepare(layer);
    };
    client_loop_.emplace(renderer, clock_, head(), *exchange_, std::move(client_predictor_), prepare, settings);
    running_client_ = &*client_loop_;
    if (stop_) client_loop_->request_stop();  // asked for before there was a loop to ask
    client_loop_->run();
    result_.app_frames = client_loop_->records();
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
    auto warper = FrameWarper::create(options_.method, options_.fill);
    if (!warper) return warper.error();
    warper_ = std::move(warper).value();
    if (window_ != nullptr) {
        window_->attach(clock_.now());
    } else {
        virtual_display_.emplace(clock_.now(), options_.display_hz, options_.size_px);
    }
    if (entry_.needs_gl) raise_priority();
    wake_exactly();
    return Done{};
}

void LiveSession::raise_priority() {
    if (realtime_allowed_ && take_realtime_priority()) result_.scheduling = Scheduling::fifo;
}

void LiveSession::show_until_stopped() {
    ServerSettings settings;
    settings.camera = options_.camera();
    if (options_.lead_given) settings.pacer.fixed_lead = from_ms(options_.lead_ms);
    settings.reserved_refreshes = static_cast<std::size_t>(options_.seconds * options_.display_hz) + kSpareRecords;
    settings.thread_cpu_time = entry_.needs_gl ? nullptr : thread_cpu_time;
    Presenter& presenter = window_ != nullptr ? static_cast<Presenter&>(*window_) : *virtual_display_;
    server_loop_.emplace(ServerParts{clock_, *exchange_, head(), movers_, *server_predictor_, *warper_, presenter},
                         settings);
    running_server_ = &*server_loop_;
    if (stop_) server_loop_->request_stop();
    server_loop_->run();
    result_.refreshes = server_loop_->records();
    result_.app_frames_shown = server_loop_->frames_shown();
    result_.bad_head_poses = server_loop_->bad_head_poses();
    result_.bad_placements = server_loop_->held().bad_placement;
    result_.bad_layers = server_loop_->held().bad_layer;
    result_.display_camera = settings.camera;
}

}  // namespace

Result<LiveResult> run_live(const Options& options, const scene::Scene& scene, const Trace& trace, bool window,
                            const AfterLiveRun& after) {
    return LiveSession{options, scene, trace, after}.run(window);
}

}  // namespace lw
