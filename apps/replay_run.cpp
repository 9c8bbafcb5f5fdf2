#include "apps/replay_run.h"

#include <algorithm>
#include <cmath>

#include "apps/parallel.h"
#include "core/metrics.h"
#include "core/stopwatch.h"

namespace lw {

namespace {

constexpr double kDefaultAppHz = 10.0;

ReplayTiming timing_of(const Options& options) {
    ReplayTiming timing;
    timing.app_hz = options.app_hz.value_or(kDefaultAppHz);
    timing.display_hz = options.display_hz;
    timing.app_latency = options.app_latency_ms ? from_ms(*options.app_latency_ms) : from_seconds(1.0 / timing.app_hz);
    timing.lead = from_ms(options.lead_ms);
    return timing;
}

std::string label_of(const Options& options) {
    const bool by_rows = options.stereo.on && options.stereo.mode == StereoMode::scanline;
    return by_rows ? std::string{name_of(StereoMode::scanline)} : options.method;
}

void mark_invented(const Image<Coverage>& coverage, Image<std::uint8_t>& invented) {
    invented.resize(coverage.size_px());
    std::ranges::transform(coverage.pixels(), invented.pixels().begin(),
                           [](Coverage c) { return c == Coverage::reached ? std::uint8_t{0} : std::uint8_t{1}; });
}

}  // namespace

ReplayRun::ReplayRun(const Options& options, const ReplayTiming& timing, TraceFeed feed, const SceneStage& stage)
    : options_{options},
      clock_{timing},
      feed_{std::move(feed)},
      renderer_{stage.renderer.get()},
      refresh_count_{static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds * options.display_hz)))} {}

Result<ReplayRun> ReplayRun::create(const Options& options, const Trace& trace, const SceneStage& stage) {
    // The run's clock starts at zero, and with it the trace and the tracker.
    TraceFeed feed{trace.placed_at(start_pose_of(*stage.scene), options.trace_start_s), TimePoint{},
                   options.tracker_hz};
    ReplayRun run{options, timing_of(options), std::move(feed), stage};
    const bool predicts = options.source_pose == SourcePose::predicted;
    auto client = make_predictor(predicts ? "constant-velocity" : "none");
    if (!client) return client.error();
    run.client_predictor_ = *std::move(client);
    auto server = make_predictor(options.predict.value_or("oracle"));
    if (!server) return server.error();
    run.server_predictor_ = *std::move(server);
    run.make_eyes(trace);
    const Status made = run.make_methods(trace);
    if (!made) return made.error();
    return run;
}

void ReplayRun::make_eyes(const Trace& trace) {
    if (!options_.stereo.on) {
        eyes_.emplace_back().view.fov = options_.camera().fov;
        return;
    }
    rig_ = stereo_rig_of(options_, &trace);
    for (const EyeView& view : rig_->eyes) eyes_.emplace_back().view = view;
}

Status ReplayRun::make_methods(const Trace& trace) {
    labels_ = {label_of(options_)};
    labels_.insert(labels_.end(), options_.baselines.begin(), options_.baselines.end());
    for (const std::string& label : labels_) {
        Result<ReplayMethod> method = ReplayMethod::create(label, options_, rig_);
        if (!method) return method.error();
        methods_.push_back(*std::move(method));
        const Status found = find_client(methods_.size() - 1, trace);
        if (!found) return found;
    }
    for (ReplayEye& eye : eyes_) {
        for (RefreshPictures* pictures : {&eye.pictures, &eye.pictures_before}) {
            pictures->shown.resize(labels_.size());
            pictures->hole_fraction.resize(labels_.size());
            pictures->behind_fraction.resize(labels_.size());
            pictures->invented.resize(labels_.size());
        }
    }
    costs_.prepare_ms.resize(labels_.size());
    costs_.warp_ms.resize(labels_.size());
    costs_.warp_cpu_ms.resize(labels_.size());
    return Done{};
}

// The client that draws what the method needs; pictures that need none are judged by --method's.
Status ReplayRun::find_client(std::size_t method, const Trace& trace) {
    const std::optional<StereoMode> mode = methods_[method].stereo_mode();
    const auto known = std::ranges::find(client_modes_, mode);
    client_index_.push_back(static_cast<std::size_t>(known - client_modes_.begin()));
    if (known != client_modes_.end()) return Done{};
    Options drawn = options_;
    drawn.stereo.mode = mode.value_or(options_.stereo.mode);
    // Shells are drawn from between the eyes; the other ways to make stereo are compared as they are.
    drawn.shells.on = drawn.shells.on && (!rig_ || drawn.stereo.mode == StereoMode::one_render);
    Result<std::vector<DrawnView>> views = drawn_views_of(drawn, &trace);
    if (!views) return views.error();
    clients_.emplace_back(drawn, *std::move(views));
    client_modes_.push_back(mode);
    return Done{};
}

double ReplayRun::pixels_per_degree() const { return lw::pixels_per_degree(camera_at(eyes_.front(), {})); }

ReplayCosts ReplayRun::costs() const {
    ReplayCosts costs = costs_;
    for (std::size_t i = 0; i < labels_.size(); ++i) costs.app_ms.push_back(client_of(i).draw_ms());
    costs.app_model_ms = client_of(0).model_ms();
    costs.main_view_ms = client_of(0).main_view_ms();
    return costs;
}

Camera ReplayRun::camera_at(const ReplayEye& eye, const Pose& world_from_head) const {
    return eye_camera(options_.camera(), eye.view, world_from_head);
}

void ReplayRun::draw_client_frames(std::uint64_t frame) {
    const ReplayHead head{clock_, feed_, *client_predictor_};
    for (std::size_t i = 0; i < clients_.size(); ++i) {
        clients_[i].draw(frame, head, *renderer_,
                         [&](std::span<const std::shared_ptr<Layer>> layers) { prepare(i, layers); });
    }
}

void ReplayRun::prepare(std::size_t client, std::span<const std::shared_ptr<Layer>> layers) {
    for (std::size_t i = 0; i < methods_.size(); ++i) {
        if (!methods_[i].warps() || client_index_[i] != client) continue;
        const Stopwatch preparing;
        for (const auto& layer : layers) methods_[i].prepare(*layer);
        costs_.prepare_ms[i].push_back(preparing.ms());
    }
}

void ReplayRun::draw_truth(ReplayEye& eye, const Pose& world_from_head, double photon_s) {
    std::swap(eye.pictures, eye.pictures_before);
    std::swap(eye.truth, eye.truth_before);
    const Camera camera = camera_at(eye, world_from_head);
    renderer_->draw_supersampled(camera, photon_s, options_.truth_samples, eye.pictures.truth);
    eye.truth.draw(*renderer_, camera, photon_s);
}

// `fresh-same` has the source's samples, neither its density nor its guard band: what it shows is the display's
// picture, drawn as well as the source was.
void ReplayRun::show_fresh(std::size_t method, const Pose& true_head, double photon_s) {
    for (ReplayEye& eye : eyes_) {
        eye.pictures.hole_fraction[method] = 0.0;
        if (rig_) eye.pictures.invented[method] = Image<std::uint8_t>{options_.size_px};
        if (labels_[method] == "fresh") {
            eye.pictures.shown[method] = eye.truth.colour();
            continue;
        }
        renderer_->draw_resolved(camera_at(eye, true_head), photon_s, options_.source.samples_per_axis, fresh_pixels_);
        eye.pictures.shown[method] = fresh_pixels_.colour;
    }
}

void ReplayRun::show(std::size_t method, const Pose& predicted_head, const Pose& true_head, double photon_s) {
    if (!methods_[method].warps()) return show_fresh(method, true_head, photon_s);
    WarpTarget target;
    target.camera = options_.camera();
    target.camera.world_from_eye = predicted_head;
    target.movers = eyes_.front().truth.movers();
    const Stopwatch warping;
    const ProcessorStopwatch working;
    methods_[method].warp(client_of(method).frame(), target);
    costs_.warp_cpu_ms[method].push_back(working.ms());
    costs_.warp_ms[method].push_back(warping.ms());
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
        const FrameWarper& shown = methods_[method].eye(i);
        eyes_[i].pictures.shown[method] = shown.display_frame().colour;
        eyes_[i].pictures.hole_fraction[method] = shown.hole_fraction();
        eyes_[i].pictures.behind_fraction[method] = eyes_[i].truth.share_shown_behind(shown.display_frame());
        if (rig_) mark_invented(shown.display_frame().coverage, eyes_[i].pictures.invented[method]);
    }
    if (method != 0) return;
    bad_depth_count_ += methods_[method].counters().bad_depth;
    ReplayClient& client = clients_[client_index_[method]];
    if (!client.draws_shells()) return;
    HoleFeedback feedback;
    feedback.shown = shown_at_;
    methods_[method].report_holes(client.frame(), target.camera, feedback);
    client.report(std::move(feedback));
}

void ReplayRun::draw(std::uint64_t refresh) {
    has_before_ = !eyes_.front().truth.colour().empty() && record_.refresh + 1 == refresh;
    const std::uint64_t frame = clock_.frame_shown_at(refresh);
    draw_client_frames(frame);

    const Refresh times = clock_.refresh(refresh);
    const TimePoint photon = times.photon();
    shown_at_ = times.scanout_begin;
    const double photon_s = seconds_of(photon);
    const PredictedPose head = server_predictor_->predict(feed_, clock_.latched(refresh), photon);
    const Pose true_head = feed_.pose_at(photon);
    for (ReplayEye& eye : eyes_) draw_truth(eye, true_head, photon_s);
    for (std::size_t i = 0; i < labels_.size(); ++i) show(i, head.world_from_head, true_head, photon_s);
    record_ = {refresh,
               frame,
               seconds_of(clock_.latched(refresh)),
               seconds_of(times.scanout_begin),
               photon_s,
               seconds_of(client_of(0).frame().layers.front()->pose_sampled),
               {},
               {}};
}

EyeRecord ReplayRun::judge_eye(std::size_t index) const {
    const ReplayEye& eye = eyes_[index];
    const int threads = options_.threads;
    EyeRecord record;
    record.errors.resize(labels_.size());
    std::vector<Image<ErrorCause>> causes;  // by client
    for (const ReplayClient& client : clients_) {
        causes.push_back(eye.truth.causes(client.layer_for(static_cast<Eye>(index)), threads));
    }
    record.cause_shares = shares_of(causes[client_index_.front()]);
    const Image<int> pixels_before = has_before_ ? eye.truth.pixels_in(eye.truth_before, threads) : Image<int>{};
    const auto same = std::ranges::find(labels_, "fresh-same") - labels_.begin();
    const double ppd = pixels_per_degree();
    for_each_in_parallel(labels_.size(), threads, [&](std::size_t i) {
        const ColourImage& shown = eye.pictures.shown[i];
        ImageErrors& errors = record.errors[i];
        errors = errors_against(eye.pictures.truth, shown, ppd, &causes[client_index_[i]]);
        errors.hole_fraction = eye.pictures.hole_fraction[i];
        errors.behind_fraction = eye.pictures.behind_fraction[i];
        if (has_before_) {
            errors.flicker = flicker(eye.pictures.truth, shown, eye.pictures_before.truth, eye.pictures_before.shown[i],
                                     pixels_before);
        }
        const auto same_index = static_cast<std::size_t>(same);
        if (same_index < labels_.size()) {
            errors.ssim_to_same = ssim(eye.pictures.shown[same_index], shown);
        }
    });
    return record;
}

std::optional<EyeConsistency> ReplayRun::consistency_of(std::size_t method) const {
    const SampledView views[] = {eyes_[0].truth.view(), eyes_[1].truth.view()};
    const auto shown = [&](std::size_t i) -> ShownEye {
        const RefreshPictures& pictures = eyes_[i].pictures;
        return {views[i], pictures.truth, pictures.shown[method], pictures.invented[method]};
    };
    return eye_consistency(shown(0), shown(1), options_.threads);
}

RefreshRecord ReplayRun::judge() const {
    RefreshRecord record = record_;
    for (std::size_t i = 0; i < eyes_.size(); ++i) record.eyes.push_back(judge_eye(i));
    if (!rig_) return record;
    for (std::size_t i = 0; i < labels_.size(); ++i) record.consistency.push_back(consistency_of(i));
    return record;
}

}  // namespace lw
