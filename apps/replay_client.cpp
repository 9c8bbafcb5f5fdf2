#include "apps/replay_client.h"

#include <memory>
#include <utility>

#include "client_renderer/hidden_layer.h"
#include "client_renderer/layer_statistics.h"
#include "client_renderer/reveal_margin.h"
#include "client_renderer/shell_budget.h"
#include "core/stopwatch.h"

namespace lw {

ReplayClient::ReplayClient(const Options& options, std::vector<DrawnView> views) : options_{options} {
    for (DrawnView& view : views) {
        SourceCameras cameras{view.camera, options.source};
        views_.push_back({std::move(view), std::move(cameras), {}});
    }
}

TimePoint ReplayClient::drawn_for(std::uint64_t frame, const ReplayHead& head) const {
    const bool predicts = options_.source_pose == SourcePose::predicted;
    return predicts ? head.clock.middle_of_life(frame) : head.clock.sampled(frame);
}

const Camera& ReplayClient::camera_of(View& view, std::uint64_t frame, const ReplayHead& head) {
    for (std::uint64_t next = view.of_frames.size(); next <= frame; ++next) {
        const TimePoint begin = head.clock.sampled(next);
        view.of_frames.push_back(view.cameras.next(head.feed, begin, head.clock.end_of_life(next) - begin));
    }
    return view.of_frames[frame];
}

void ReplayClient::draw_view(View& view, std::uint64_t frame, const PredictedPose& pose, const ReplayHead& head,
                             SceneRenderer& renderer, std::vector<std::shared_ptr<Layer>>& layers) {
    auto layer = std::make_shared<Layer>();
    layer->name = view.drawn.name;
    layer->for_eye = view.drawn.for_eye;
    layer->camera = camera_of(view, frame, head);
    layer->camera.world_from_eye = compose(pose.world_from_head, view.drawn.head_from_view);
    layer->pose_sampled = pose.newest_sample;
    layer->scene_time_s = seconds_of(drawn_for(frame, head));
    const double eye_motion_m =
        view.drawn.eye_distance_m + reveal_margin_m(options_.reveal_margin_m, head.client_predictor, head.feed,
                                                    head.clock.sampled(frame), pose.world_from_head,
                                                    head.clock.published(frame), head.clock.end_of_life(frame));
    renderer.set_reveal_margin(eye_motion_m);
    renderer.use_billboards(true);  // by the client alone: truth and fresh pictures are meshes
    renderer.draw_resolved(layer->camera, layer->scene_time_s, options_.source.samples_per_axis, layer->cpu());
    counters_.push_back(renderer.counters());
    model_ms_.back() += modelled_ms(renderer, *layer);
    renderer.use_billboards(false);
    renderer.mover_placements(layer->scene_time_s, layer->movers);
    layers.push_back(std::move(layer));
    if (options_.source.layers < 2) return;
    auto hidden = std::make_shared<Layer>();
    draw_hidden_layer(renderer, *layers.back(), options_.source.samples_per_axis, eye_motion_m, *hidden);
    hidden->for_eye = view.drawn.for_eye;
    model_ms_.back() += modelled_ms(renderer, *hidden);
    layers.push_back(std::move(hidden));
}

void ReplayClient::draw(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer,
                        const std::function<void(std::span<const std::shared_ptr<Layer>>)>& prepare) {
    if (drawn_frame_ == frame) return;
    const TimePoint begin = head.clock.sampled(frame);
    const PredictedPose pose = head.client_predictor.predict(head.feed, begin, drawn_for(frame, head));
    renderer.set_viewer_moves(options_.culling.min_pixels > 0.0 &&
                              viewer_moves(head.client_predictor, head.feed, begin, head.clock.end_of_life(frame)));
    std::vector<std::shared_ptr<Layer>> layers;
    if (options_.shells.on) {
        draw_shells(frame, head, renderer);
        renderer.set_viewer_moves(false);
        prepare(shells_->drawn());
        const TimePoint published = head.clock.published(frame);
        frame_ = {frame + 1, shells_->layers(), {pose.newest_sample, begin, published, published}};
        drawn_frame_ = frame;
        return;
    }
    model_ms_.push_back(0.0);
    const Stopwatch drawing;
    for (View& view : views_) draw_view(view, frame, pose, head, renderer, layers);
    draw_ms_.push_back(drawing.ms());
    renderer.set_viewer_moves(false);  // the truth shows the smallest things
    prepare(layers);
    const TimePoint published = head.clock.published(frame);
    frame_ = {frame + 1, {layers.begin(), layers.end()}, {pose.newest_sample, begin, published, published}};
    drawn_frame_ = frame;
}

// Frames of shells depend on those before them.
ShellMoment ReplayClient::moment_of(std::uint64_t frame, const ReplayHead& head) {
    const TimePoint begin = head.clock.sampled(frame);
    View& view = views_.front();
    const auto head_at = [&](TimePoint time) { return head.client_predictor.predict(head.feed, begin, time); };
    const auto view_at = [&](const PredictedPose& pose) {
        return compose(pose.world_from_head, view.drawn.head_from_view);
    };
    const PredictedPose middle = head_at(drawn_for(frame, head));
    ShellMoment moment;
    moment.now_s = seconds_of(begin);
    moment.scene_time_s = seconds_of(drawn_for(frame, head));
    moment.pose_sampled = middle.newest_sample;
    moment.shown_from = view_at(head_at(head.clock.published(frame)));
    moment.shown_middle = view_at(middle);
    moment.shown_until = view_at(head_at(head.clock.end_of_life(frame)));
    moment.source = camera_of(view, frame, head);
    if (frame < main_view_model_ms_.size()) moment.main_view_ms = main_view_model_ms_[frame];
    moment.head_motion_m =
        view.drawn.eye_distance_m + reveal_margin_m(options_.reveal_margin_m, head.client_predictor, head.feed, begin,
                                                    middle.world_from_head, head.clock.published(frame),
                                                    head.clock.end_of_life(frame));
    return moment;
}

// What one layer with everything would cost in each frame up to this one: the budget of its shells.
void ReplayClient::learn_main_view(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer) {
    for (std::uint64_t next = main_view_model_ms_.size(); next <= frame; ++next) {
        const ShellMoment moment = moment_of(next, head);
        Layer layer;
        layer.camera = moment.source;
        layer.camera.world_from_eye = moment.shown_middle;
        renderer.set_reveal_margin(moment.head_motion_m);
        const Stopwatch drawing;
        renderer.draw_resolved(layer.camera, moment.scene_time_s, options_.source.samples_per_axis, layer.cpu());
        main_view_ms_.push_back(drawing.ms());
        main_view_model_ms_.push_back(modelled_ms(renderer, layer));
    }
}

void ReplayClient::draw_shells(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer) {
    if (!shells_) shells_ = std::make_unique<ReplayShells>(renderer, views_.front().drawn.camera, options_);
    if (!options_.shells.budget_ms) learn_main_view(frame, head, renderer);
    const Stopwatch drawing;
    shells_->draw(frame, [&](std::uint64_t k) { return moment_of(k, head); });
    draw_ms_.push_back(drawing.ms());
    model_ms_.push_back(shells_->records().back().spent_ms);
    counters_.push_back(shells_->counters());
}

void ReplayClient::report(HoleFeedback feedback) {
    if (shells_) shells_->report(std::move(feedback));
}

// What the renderer's last picture is modelled to cost.
double ReplayClient::modelled_ms(const SceneRenderer& renderer, const Layer& layer) const {
    const double samples = options_.source.samples_per_axis * options_.source.samples_per_axis;
    const double pixels = static_cast<double>(layer.camera.size_px.x) * layer.camera.size_px.y;
    return modelled_cost_ms(static_cast<double>(renderer.counters().triangles_drawn), samples * pixels,
                            samples * statistics_of(layer).surface_px);
}

const Layer& ReplayClient::layer_for(Eye eye) const {
    for (const auto& layer : frame_.layers) {
        if (!layer->for_eye || *layer->for_eye == eye) return *layer;
    }
    return *frame_.layers.front();
}

double ReplayClient::source_pixels_ratio(glm::ivec2 display_px) const {
    const auto count = [](glm::ivec2 size_px) { return static_cast<double>(size_px.x) * size_px.y; };
    double sum = 0.0;
    for (const View& view : views_) {
        for (const Camera& camera : view.of_frames) sum += count(camera.size_px) / count(display_px);
    }
    const std::size_t frames = views_.front().of_frames.size();
    return frames == 0 ? 0.0 : sum / static_cast<double>(frames);
}

}  // namespace lw
