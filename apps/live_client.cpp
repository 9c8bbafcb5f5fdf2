#include "apps/live_client.h"

#include <cmath>
#include <utility>

#include "apps/app_load.h"
#include "apps/scene_stage.h"
#include "apps/thread_priority.h"

namespace lw {
namespace {

/// The client's rate where its frames must meet the refreshes at every phase: a period that is a whole number of
/// refreshes, give or take a fifth, gets 0.31 of one more. 0, as fast as it can, drifts by itself.
double hz_between_refreshes(double app_hz, double display_hz) {
    if (app_hz <= 0.0) return app_hz;
    const double refreshes = display_hz / app_hz;
    const double whole = std::round(refreshes);
    return std::abs(refreshes - whole) < 0.2 ? display_hz / (whole + 0.31) : app_hz;
}

// What a frame in textures cannot do yet.
Status check_textures(const Options& options) {
    if (options.inject.app_ms) {
        return Error{"frames in textures cannot be delayed", "--inject app", "choose a CPU --method"};
    }
    if (options.source.layers > 1) {
        return Error{"a hidden layer cannot be handed over in textures yet", "--layers 2", "choose a CPU --method"};
    }
    if (options.shells.on) {
        return Error{"shells cannot be handed over in textures yet", "--shells", "choose a CPU --method"};
    }
    return Done{};
}

}  // namespace

void LiveClient::run_thread() {
    name_thread("lw-client");
    if (!run_.realtime_allowed) run_.result.scheduling = step_back() ? Scheduling::nice : Scheduling::none;
    const Status ready = prepare();
    ready_.set_value(ready);
    if (run_.may_go.get()) draw_until_stopped();
    run_.client_stopped.set_value();
    run_.may_drop_frames.wait();
    // The server's thread is gone: what it wrote is visible here, and its frames may be dropped.
    run_.exchange.reset();
    run_.before_delay.reset();
    Status done{Done{}};
    if (ready && run_.may_go.get() && after_) done = after_(*renderer_, *context_, run_.result);
    renderer_.reset();
    context_.reset();
    done_.set_value(done);
}

Status LiveClient::prepare() {
    const Options& options = run_.options;
    auto context = gl::Context::create();
    if (!context) return context.error();
    context_ = std::move(context).value();
    context_->make_current();
    run_.client_context = context_.get();
    run_.textures = run_.entry.needs_gl && !context_->is_software();
    if (run_.textures) {
        if (Status checked = check_textures(options); !checked) return checked;
    }
    auto renderer = SceneRenderer::create(
        run_.scene, {.culling = options.culling, .billboards = options.billboards, .order = options.draw_order});
    if (!renderer) return renderer.error();
    renderer_ = with_load(std::move(renderer).value(), options.load);
    auto views = drawn_views_of(options, &run_.trace);
    if (!views) return views.error();
    views_ = *std::move(views);
    warm_up();
    return Done{};
}

// The driver compiles at the first draw; that is no frame of the run.
void LiveClient::warm_up() {
    const int samples = run_.options.source.samples_per_axis;
    Camera camera = views_.front().camera;
    camera.world_from_eye = run_.trace.at(0.0);
    CpuPixels pixels;
    renderer_->use_billboards(true);
    renderer_->draw_resolved(camera, 0.0, samples, pixels);
    if (run_.options.source.layers > 1 || run_.options.shells.on) {
        const DepthImage limits{camera.size_px, 1.0F};
        ScenePart behind;
        behind.behind = &limits;
        renderer_->draw_part(camera, 0.0, samples, behind, pixels);
    }
}

ClientSettings LiveClient::settings() const {
    const Options& options = run_.options;
    ClientSettings settings;
    settings.camera = options.camera();
    settings.views = views_;
    settings.max_hz = options.app_hz.value_or(0.0);
    if (options.inject.any()) settings.max_hz = hz_between_refreshes(settings.max_hz, options.display_hz);
    settings.predict_source_pose = options.source_pose == SourcePose::predicted;
    settings.source = options.source;
    // A software GL pays for every pixel: twice of them (1.9x in the city) halved the client's rate, and the frames got
    // older by more than the band covers. There `auto` means none; a band in degrees is drawn as asked.
    if (!settings.source.guard_band_rad && context_->is_software()) settings.source.guard_band_rad = 0.0;
    settings.textures = run_.textures;
    settings.shells = options.shells;
    settings.feedback = options.shells.on ? &run_.hole_feedback : nullptr;
    settings.reveal_margin_m = options.reveal_margin_m;
    settings.min_pixels = options.culling.min_pixels;
    return settings;
}

void LiveClient::draw_until_stopped() {
    const auto prepare = [this](Layer& layer) {
        if (layer.name == views_.front().name) {
            run_.result.source_views.push_back({layer.camera, layer.scene_time_s});
        }
        run_.warper.maker->prepare(layer);
    };
    loop_.emplace(*renderer_, run_.clock, *run_.head, run_.client_exchange(), std::move(predictor_), prepare,
                  settings());
    running_ = &*loop_;
    if (run_.stop) loop_->request_stop();  // asked for before there was a loop to ask
    loop_->run();
    take_results();
}

void LiveClient::take_results() {
    LiveResult& result = run_.result;
    result.app_frames = loop_->records();
    result.shells = loop_->shell_records();
    if (run_.options.shells.on) {
        for (const ClientFrameRecord& frame : result.app_frames) {
            result.source_views.push_back({frame.view, frame.scene_time_s});
        }
    }
    result.app_failure = loop_->failure();
    if (!result.app_failure.empty()) {
        print_warnings({fmt::format("the client stopped ({}): its last frame stays", result.app_failure)}, false);
    }
}

void LiveClient::set_frozen(bool frozen) {
    if (ClientLoop* loop = running_) loop->set_frozen(frozen);
}

void LiveClient::set_max_hz(double hz) {
    if (ClientLoop* loop = running_) loop->set_max_hz(hz);
}

void LiveClient::request_stop() {
    if (ClientLoop* loop = running_) loop->request_stop();
}

}  // namespace lw
