#include <algorithm>
#include <map>
#include <memory>

#include "apps/image_errors.h"
#include "apps/parallel.h"
#include "apps/progress.h"
#include "apps/warp_sweep_run.h"
#include "apps/warp_sweep_stage.h"
#include "warp_server/frame_warper.h"

namespace lw {

namespace {

/// Sums up errors of several pictures.
class ErrorSum {
public:
    void add(const ImageErrors& errors) {
        flip_ += errors.flip;
        ssim_ += errors.ssim;
        hole_fraction_ += errors.hole_fraction;
        ++count_;
        if (!errors.psnr_db) return;
        psnr_db_ += *errors.psnr_db;
        ++psnr_count_;
    }
    [[nodiscard]] ImageErrors mean() const {
        const double n = count_;
        return {flip_ / n, ssim_ / n, psnr_count_ > 0 ? std::optional<double>{psnr_db_ / psnr_count_} : std::nullopt,
                hole_fraction_ / n};
    }

private:
    double flip_ = 0.0;
    double ssim_ = 0.0;
    double psnr_db_ = 0.0;
    double hole_fraction_ = 0.0;
    int count_ = 0;
    int psnr_count_ = 0;
};

/// Methods with their scratch memory, kept over all sources. One picture for all settings that show the same.
class Warpers {
public:
    Result<FrameWarper*> of(const WarpSetting& setting) {
        const auto key = std::pair{picture_label(setting.method), setting.fill};
        const auto found = made_.find(key);
        if (found != made_.end()) return found->second.get();
        Result<FrameWarper> warper = FrameWarper::create(key.first, key.second);
        if (!warper) return warper.error();
        return made_.emplace(key, std::make_unique<FrameWarper>(*std::move(warper))).first->second.get();
    }

private:
    std::map<std::pair<std::string, std::string>, std::unique_ptr<FrameWarper>> made_;
};

/// What is the same for all cells of a size: the truth and the fresh pictures of one moment.
struct Moment {
    ColourImage truth;
    std::map<int, ImageErrors> fresh;  ///< by samples per axis
};

using SizeKey = std::pair<int, int>;
SizeKey key_of(glm::ivec2 size_px) { return {size_px.x, size_px.y}; }

class ErrorRun {
public:
    ErrorRun(const SweepPlan& plan, const SweepSettings& settings, std::vector<BenchPoint>& points)
        : plan_{plan},
          settings_{settings},
          points_{points},
          progress_{"errors", plan.judgement_count(), settings.quiet} {}

    Status run_pair(std::size_t pair, SweepStage& stage) {
        pair_ = pair;
        sums_.assign(points_.size(), {});
        fresh_sums_.clear();
        std::size_t frames = 0;
        for (const SweepCell& cell : plan_.cells) frames = std::max(frames, cell.frames);
        for (std::size_t frame = 0; frame < frames; ++frame) {
            const Status status = run_moment(frame, stage);
            if (!status) return status;
        }
        keep();
        return Done{};
    }

    [[nodiscard]] std::vector<FreshErrors> fresh() const { return fresh_; }

private:
    Status run_moment(std::size_t frame, SweepStage& stage) {
        std::map<SizeKey, Moment> moments;
        std::size_t first_point = 0;
        for (const SweepCell& cell : plan_.cells) {
            if (pair_ < cell.pairs && frame < cell.frames) {
                const double photon_s = photon_s_of(plan_, frame);
                Moment& moment = moments[key_of(cell.conditions.size_px)];
                draw_moment(cell.conditions, photon_s, stage, moment);
                const Status status = run_cell(cell, first_point, photon_s, moment.truth, stage);
                if (!status) return status;
            }
            first_point += cell.settings.size();
        }
        for (const auto& [size_key, moment] : moments) {
            for (const auto& [samples, errors] : moment.fresh) fresh_sums_[{size_key, samples}].add(errors);
        }
        return Done{};
    }

    void draw_moment(const BenchConditions& conditions, double photon_s, SweepStage& stage, Moment& moment) {
        const Camera camera = stage.target_camera(conditions.size_px, photon_s);
        if (moment.truth.size_px() != conditions.size_px) {
            stage.renderer().draw_supersampled(camera, photon_s, plan_.truth_samples, moment.truth);
        }
        for (const int samples : {1, conditions.source_samples}) {
            if (moment.fresh.count(samples) > 0) continue;
            stage.renderer().draw_resolved(camera, photon_s, samples, fresh_pixels_);
            moment.fresh[samples] = errors_against(moment.truth, fresh_pixels_.colour, pixels_per_degree(camera));
        }
    }

    Status run_cell(const SweepCell& cell, std::size_t first_point, double photon_s, const ColourImage& truth,
                    SweepStage& stage) {
        const std::shared_ptr<Layer> layer = stage.source(cell.conditions, photon_s);
        const Camera camera = stage.target_camera(cell.conditions.size_px, photon_s);
        const std::vector<ObjectTransform> movers = stage.target_movers(photon_s);
        std::map<FrameWarper*, std::size_t> picture_of;
        std::vector<ColourImage> shown;
        std::vector<ImageErrors> errors;
        std::vector<std::size_t> pictures;  // per setting
        for (const WarpSetting& setting : cell.settings) {
            Result<FrameWarper*> warper = warpers_.of(setting);
            if (!warper) return warper.error();
            const auto [place, is_new] = picture_of.emplace(*warper, shown.size());
            pictures.push_back(place->second);
            if (!is_new) continue;
            if (layer->prepared_for((*warper)->method().label()) == nullptr) (*warper)->prepare(*layer);
            shown.push_back((*warper)->warp({1, {layer}, {}}, {camera, movers}).colour);
            errors.emplace_back().hole_fraction = (*warper)->hole_fraction();
        }
        for_each_in_parallel(shown.size(), settings_.threads, [&](std::size_t i) {
            const double hole_fraction = errors[i].hole_fraction;
            errors[i] = errors_against(truth, shown[i], pixels_per_degree(camera));
            errors[i].hole_fraction = hole_fraction;
        });
        for (std::size_t i = 0; i < pictures.size(); ++i) sums_[first_point + i].add(errors[pictures[i]]);
        judged_ += pictures.size();
        progress_.show(judged_);
        return Done{};
    }

    void keep() {
        const auto entry = [&](const ErrorSum& sum) {
            return PairErrors{plan_.pairs[pair_].scene_label, plan_.pairs[pair_].trace_label, sum.mean()};
        };
        std::size_t point = 0;
        for (const SweepCell& cell : plan_.cells) {
            for (std::size_t i = 0; i < cell.settings.size(); ++i, ++point) {
                if (pair_ < cell.pairs) points_[point].pairs.push_back(entry(sums_[point]));
            }
        }
        for (const auto& [key, sum] : fresh_sums_) {
            const glm::ivec2 size_px{key.first.first, key.first.second};
            const int samples = key.second;
            auto found = std::find_if(fresh_.begin(), fresh_.end(), [&](const FreshErrors& errors) {
                return errors.size_px == size_px && errors.samples == samples;
            });
            if (found == fresh_.end()) found = fresh_.insert(fresh_.end(), {size_px, samples, {}});
            found->pairs.push_back(entry(sum));
        }
    }

    const SweepPlan& plan_;
    SweepSettings settings_;
    std::vector<BenchPoint>& points_;
    Progress progress_;
    std::size_t judged_ = 0;
    Warpers warpers_;
    std::size_t pair_ = 0;
    std::vector<ErrorSum> sums_;                              // per point, of the pair
    std::map<std::pair<SizeKey, int>, ErrorSum> fresh_sums_;  // by size and samples
    std::vector<FreshErrors> fresh_;
    CpuPixels fresh_pixels_;
};

}  // namespace

Result<std::vector<FreshErrors>> measure_errors(const SweepPlan& plan, const SweepSettings& settings,
                                                std::vector<BenchPoint>& points) {
    for (BenchPoint& point : points) point.pairs.clear();
    std::optional<SweepStage> stage;
    std::unique_ptr<ErrorRun> run;  // its methods' GL objects live on the stage's context, so it dies first
    for (std::size_t pair = 0; pair < plan.pairs.size(); ++pair) {
        Result<SweepStage> made = SweepStage::create(plan.pairs[pair], std::exchange(stage, std::nullopt));
        if (!made) return made.error();
        stage = *std::move(made);
        if (run == nullptr) run = std::make_unique<ErrorRun>(plan, settings, points);
        const Status status = run->run_pair(pair, *stage);
        if (!status) return status.error();
    }
    return run->fresh();
}

}  // namespace lw
