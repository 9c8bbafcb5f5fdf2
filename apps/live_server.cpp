#include "apps/live_server.h"

#include <utility>

#include "apps/scene_stage.h"
#include "apps/thread_priority.h"

namespace lw {
namespace {

// Room for the refreshes of a run that overruns its time a little.
constexpr std::size_t kSpareRecords = 1024;
// Strips of a picture unless --strips says, where the scan-out is known. Two cost the server nothing and give most of
// what many do; with more of them a client's frame that becomes ready meanwhile is seen in parts more often.
constexpr int kStripsOfAScanout = 2;
constexpr int kLeastRowsOfStrips = 64;
// A strip that takes more of its time than this when nothing disturbs it will often take longer than that, and strips
// that take turns show less than whole pictures that are late. Some methods take as long for a strip as for all.
constexpr double kMostOfAStripsTime = 0.7;

}  // namespace

LiveServer::LiveServer(LiveRun& run, WindowPresenter* window, DemoOverlay& overlay,
                       std::unique_ptr<HeadPosePredictor> predictor)
    : run_{run}, window_{window}, overlay_{overlay}, predictor_{std::move(predictor)} {
    run_.controls.strips = first_strips();
}

// To begin with, if they are made in time. A window's compositor takes whole pictures, and nobody knows how it scans
// them out; a GL method draws the whole source for every strip; the eyes' pictures are made whole.
int LiveServer::first_strips() const {
    const Options& options = run_.options;
    const bool whole =
        window_ != nullptr || run_.entry.needs_gl || options.stereo.on || options.size_px.y < kLeastRowsOfStrips;
    return options.strips.value_or(whole ? 1 : kStripsOfAScanout);
}

std::size_t LiveServer::reserved_parts() const {
    const auto refreshes = static_cast<std::size_t>(run_.options.seconds * run_.options.display_hz);
    return (refreshes + kSpareRecords) * static_cast<std::size_t>(run_.controls.strips);
}

bool LiveServer::has_photon_codes() const {
    return window_ == nullptr && run_.options.subcommand == Subcommand::measure;
}

void LiveServer::run_thread() {
    name_thread("lw-server");
    std::unique_ptr<gl::Context> context;
    const Status ready = prepare(context);
    ready_.set_value(ready);
    if (run_.may_go.get()) show_until_stopped();
    run_.may_drop_warper.wait();
    run_.warper = {};
    if (window_ != nullptr && ready) window_->detach();
    context.reset();
}

Status LiveServer::prepare(std::unique_ptr<gl::Context>& context) {
    const bool needs_gl = run_.entry.needs_gl;
    if (needs_gl) {
        auto made = gl::Context::create(run_.textures ? run_.client_context : nullptr);
        if (!made) return made.error();
        context = std::move(made).value();
        context->make_current();
    }
    // The threads of a CPU method inherit the priority; those of a GL driver must not.
    if (!needs_gl) raise_priority();
    auto warper = make_live_warper(run_.options, run_.trace, window_ != nullptr ? &run_.controls : nullptr);
    if (!warper) return warper.error();
    run_.warper = *std::move(warper);
    if (window_ != nullptr) {
        window_->attach(run_.clock.now());
    } else {
        virtual_display_.emplace(run_.clock.now(), run_.options.display_hz, picture_size_px(run_.options));
    }
    if (needs_gl) raise_priority();
    wake_exactly();
    return Done{};
}

void LiveServer::raise_priority() {
    if (run_.realtime_allowed && take_realtime_priority()) run_.result.scheduling = Scheduling::fifo;
}

ServerSettings LiveServer::settings() {
    const Options& options = run_.options;
    ServerSettings settings;
    settings.camera = options.camera();
    if (options.lead_given) settings.pacer.fixed_lead = from_ms(options.lead_ms);
    settings.feedback = options.shells.on ? &run_.hole_feedback : nullptr;
    settings.photon_codes = has_photon_codes();
    if (window_ != nullptr) {
        settings.on_record = [this](const DisplayRecord& record) {
            overlay_.note(record);
            if (run_.warper.one_eye != nullptr) run_.warper.one_eye->set_false_colours(run_.controls.false_colours);
        };
    }
    settings.thread_cpu_time = run_.entry.needs_gl ? nullptr : thread_cpu_time;
    return settings;
}

void LiveServer::show_until_stopped() {
    ServerSettings settings = this->settings();
    Presenter& presenter = window_ != nullptr ? static_cast<Presenter&>(*window_) : *virtual_display_;
    make_loop(settings, presenter);
    if (!run_.options.strips && settings.strips > 1 && !is_in_time(settings.strips)) {
        run_.controls.strips = 1;
        make_loop(settings, presenter);
    }
    if (has_photon_codes()) watch_photons();
    show(settings.strips);
    while (show_on_.exchange(false) && !run_.stop) {
        make_loop(settings, presenter);
        show(settings.strips);
    }
    take_display_results(settings.camera);
}

void LiveServer::make_loop(ServerSettings& settings, Presenter& presenter) {
    settings.strips = run_.controls.strips;
    settings.reserved_refreshes = reserved_parts();
    const std::lock_guard lock{loop_mutex_};
    loop_.emplace(
        ServerParts{run_.clock, *run_.exchange, *run_.head, run_.movers, *predictor_, *run_.warper.maker, presenter},
        settings);
    if (run_.stop) loop_->request_stop();
}

bool LiveServer::is_in_time(int strips) {
    return to_seconds(loop_->rehearse()) <= kMostOfAStripsTime / (run_.options.display_hz * strips);
}

void LiveServer::watch_photons() {
    PhotonWatchSettings settings;
    settings.strips = run_.controls.strips;
    settings.reserved_parts = reserved_parts();
    settings.panel_latency = [this](TimePoint scanout) {
        return run_.result.injection.delay(Injected::present, scanout);
    };
    virtual_display_->watch_photons(run_.clock, settings);
}

void LiveServer::show(int strips) {
    loop_->run();
    take_loop_results(strips);
}

void LiveServer::take_loop_results(int strips) {
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    LiveResult& result = run_.result;
    append(result.parts, loop_->records());
    append(result.refreshes, worst_strips(loop_->records(), strips));
    append(result.warp_times, warp_times(loop_->records(), strips));
    result.strips = strips;
    result.app_frames_shown += loop_->frames_shown();
    result.bad_head_poses += loop_->bad_head_poses();
    result.bad_placements += loop_->held().bad_placement;
    result.bad_layers += loop_->held().bad_layer;
}

void LiveServer::take_display_results(const Camera& camera) {
    LiveResult& result = run_.result;
    if (virtual_display_) {
        const auto seen = virtual_display_->seen();
        result.seen.assign(seen.begin(), seen.end());
        result.true_head = run_.trace_feed;
    }
    result.display_camera = camera;
    const StereoWarper* two_eyes = run_.warper.two_eyes;
    if (two_eyes == nullptr) return;
    for (const Eye eye : kEyes) result.last_eyes.push_back(two_eyes->eye(eye).display_frame().colour);
}

// What the pacer has learnt of strips says nothing about others, so another loop goes on.
void LiveServer::show_in_next_strips() {
    if (run_.options.stereo.on) return;
    const int more = 2 * run_.controls.strips;
    run_.controls.strips = more > std::min(DemoControls::kMostStrips, run_.options.size_px.y) ? 1 : more;
    show_on_ = true;
    request_stop();
}

void LiveServer::request_stop() {
    const std::lock_guard lock{loop_mutex_};
    if (loop_) loop_->request_stop();
}

}  // namespace lw
