#include "apps/replay_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "apps/parallel.h"

#include "client_renderer/hidden_layer.h"
#include "client_renderer/reveal_margin.h"

namespace lw {

namespace {

constexpr double kDefaultAppHz = 10.0;

/// Wall time for the cost figures only; the run itself knows nothing but its virtual clock.
class Stopwatch {
public:
    [[nodiscard]] double ms() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

ReplayTiming timing_of(const Options& options) {
    ReplayTiming timing;
    timing.app_hz = options.app_hz.value_or(kDefaultAppHz);
    timing.display_hz = options.display_hz;
    timing.app_latency = options.app_latency_ms ? from_ms(*options.app_latency_ms) : from_seconds(1.0 / timing.app_hz);
    timing.lead = from_ms(options.lead_ms);
    return timing;
}

Camera camera_at(const Options& options, const Pose& world_from_eye) {
    Camera camera = options.camera();
    camera.world_from_eye = world_from_eye;
    return camera;
}

}  // namespace

ReplayRun::ReplayRun(const Options& options, const ReplayTiming& timing, TraceFeed feed, const SceneStage& stage)
    : options_{options},
      clock_{timing},
      feed_{std::move(feed)},
      renderer_{stage.renderer.get()},
      refresh_count_{static_cast<std::uint64_t>(std::max(1.0, std::round(options.seconds * options.display_hz)))},
      source_cameras_{options.camera(), options.source} {}

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
    const Status made = run.make_methods();
    if (!made) return made.error();
    return run;
}

Status ReplayRun::make_methods() {
    labels_ = {options_.method};
    labels_.insert(labels_.end(), options_.baselines.begin(), options_.baselines.end());
    for (const std::string& label : labels_) {
        if (is_fresh_baseline(label)) {
            warpers_.emplace_back();
            continue;
        }
        Result<FrameWarper> warper = FrameWarper::create(label, options_.fill);
        if (!warper) return warper.error();
        warpers_.emplace_back(*std::move(warper));
    }
    for (RefreshPictures* pictures : {&pictures_, &pictures_before_}) {
        pictures->shown.resize(labels_.size());
        pictures->hole_fraction.resize(labels_.size());
    }
    costs_.prepare_ms.resize(labels_.size());
    costs_.warp_ms.resize(labels_.size());
    return Done{};
}

double ReplayRun::pixels_per_degree() const { return lw::pixels_per_degree(options_.camera()); }

double ReplayRun::source_pixels_ratio() const {
    double sum = 0.0;
    for (const Camera& view : source_views_) sum += pixels_ratio(view, options_.camera());
    return source_views_.empty() ? 0.0 : sum / static_cast<double>(source_views_.size());
}

const Camera& ReplayRun::source_camera_of(std::uint64_t frame) {
    for (std::uint64_t next = source_views_.size(); next <= frame; ++next) {
        const TimePoint begin = clock_.sampled(next);
        source_views_.push_back(source_cameras_.next(feed_, begin, clock_.end_of_life(next) - begin));
    }
    return source_views_[frame];
}

void ReplayRun::draw_client_frame(std::uint64_t frame) {
    const TimePoint begin = clock_.sampled(frame);
    const bool predicts = options_.source_pose == SourcePose::predicted;
    const TimePoint drawn_for = predicts ? clock_.middle_of_life(frame) : begin;
    const PredictedPose pose = client_predictor_->predict(feed_, begin, drawn_for);

    auto layer = std::make_shared<Layer>();
    layer->camera = source_camera_of(frame);
    layer->camera.world_from_eye = pose.world_from_head;
    layer->pose_sampled = pose.newest_sample;
    layer->scene_time_s = seconds_of(drawn_for);
    const double head_motion_m =
        reveal_margin_m(options_.reveal_margin_m, *client_predictor_, feed_, begin, pose.world_from_head,
                        clock_.published(frame), clock_.end_of_life(frame));
    renderer_->set_reveal_margin(head_motion_m);
    renderer_->set_viewer_moves(options_.culling.min_pixels > 0.0 &&
                                viewer_moves(*client_predictor_, feed_, begin, clock_.end_of_life(frame)));
    const Stopwatch drawing;
    renderer_->use_billboards(true);  // by the client alone: truth and fresh pictures are meshes
    renderer_->draw_resolved(layer->camera, layer->scene_time_s, options_.source.samples_per_axis, layer->cpu());
    client_draws_.push_back(renderer_->counters());
    renderer_->use_billboards(false);
    renderer_->mover_placements(layer->scene_time_s, layer->movers);
    std::vector<std::shared_ptr<Layer>> layers{std::move(layer)};
    if (options_.source.layers == 2) {
        auto hidden = std::make_shared<Layer>();
        draw_hidden_layer(*renderer_, *layers.front(), options_.source.samples_per_axis, head_motion_m, *hidden);
        layers.push_back(std::move(hidden));
    }
    costs_.app_ms.push_back(drawing.ms());
    prepare(layers);
    const TimePoint published = clock_.published(frame);
    frame_ = {frame + 1, {layers.begin(), layers.end()}, {pose.newest_sample, begin, published, published}};
    drawn_frame_ = frame;
}

void ReplayRun::prepare(std::span<const std::shared_ptr<Layer>> layers) {
    for (std::size_t i = 0; i < warpers_.size(); ++i) {
        if (!warpers_[i]) continue;
        const Stopwatch preparing;
        for (const auto& layer : layers) warpers_[i]->prepare(*layer);
        costs_.prepare_ms[i].push_back(preparing.ms());
    }
}

void ReplayRun::show(std::size_t method, const WarpTarget& target, const Camera& true_camera, double photon_s) {
    if (labels_[method] == "fresh") {
        pictures_.shown[method] = truth_.colour();
        pictures_.hole_fraction[method] = 0.0;
        return;
    }
    if (!warpers_[method]) {
        // `fresh-same` has the source's samples, neither its density nor its guard band: what it shows is the display's
        // picture, drawn as well as the source was.
        renderer_->draw_resolved(true_camera, photon_s, options_.source.samples_per_axis, fresh_pixels_);
        pictures_.shown[method] = fresh_pixels_.colour;
        pictures_.hole_fraction[method] = 0.0;
        return;
    }
    FrameWarper& warper = *warpers_[method];
    const Stopwatch warping;
    const DisplayFrame& shown = warper.warp(frame_, target);
    costs_.warp_ms[method].push_back(warping.ms());
    pictures_.shown[method] = shown.colour;
    pictures_.hole_fraction[method] = warper.hole_fraction();
    if (method == 0) bad_depth_count_ += warper.counters().bad_depth;
}

const RefreshPictures& ReplayRun::draw(std::uint64_t refresh) {
    has_before_ = !truth_.colour().empty() && record_.refresh + 1 == refresh;
    std::swap(pictures_, pictures_before_);
    std::swap(truth_, truth_before_);
    const std::uint64_t frame = clock_.frame_shown_at(refresh);
    if (drawn_frame_ != frame) draw_client_frame(frame);
    renderer_->set_viewer_moves(false);  // the truth shows the smallest things

    const Refresh times = clock_.refresh(refresh);
    const TimePoint photon = times.photon();
    const double photon_s = seconds_of(photon);
    const PredictedPose pose = server_predictor_->predict(feed_, clock_.latched(refresh), photon);
    const Camera true_camera = camera_at(options_, feed_.pose_at(photon));
    renderer_->draw_supersampled(true_camera, photon_s, options_.truth_samples, pictures_.truth);
    truth_.draw(*renderer_, true_camera, photon_s);
    for (std::size_t i = 0; i < labels_.size(); ++i) {
        show(i, {camera_at(options_, pose.world_from_head), truth_.movers()}, true_camera, photon_s);
    }
    record_ = {refresh,
               frame,
               seconds_of(clock_.latched(refresh)),
               seconds_of(times.scanout_begin),
               photon_s,
               seconds_of(frame_.layers.front()->pose_sampled),
               {},
               {}};
    return pictures_;
}

std::optional<double> ReplayRun::flicker_of(std::size_t method, const Image<int>& pixels_before) const {
    if (!has_before_) return std::nullopt;
    return flicker(pictures_.truth, pictures_.shown[method], pictures_before_.truth, pictures_before_.shown[method],
                   pixels_before);
}

RefreshRecord ReplayRun::judge() const {
    RefreshRecord record = record_;
    record.errors.resize(labels_.size());
    const double ppd = pixels_per_degree();
    const int threads = options_.threads;
    const Image<ErrorCause> causes = truth_.causes(*frame_.layers.front(), threads);
    const Image<int> pixels_before = has_before_ ? truth_.pixels_in(truth_before_, threads) : Image<int>{};
    record.cause_shares = shares_of(causes);
    for_each_in_parallel(labels_.size(), threads, [&](std::size_t i) {
        record.errors[i] = errors_against(pictures_.truth, pictures_.shown[i], ppd, &causes);
        record.errors[i].hole_fraction = pictures_.hole_fraction[i];
        record.errors[i].flicker = flicker_of(i, pixels_before);
    });
    return record;
}

}  // namespace lw
