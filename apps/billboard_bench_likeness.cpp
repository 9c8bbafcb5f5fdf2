/// Flat against warped quads that are drawn anew at the same times, in every frame of stretches of the flight, for
/// clients of several rates.

#include <algorithm>

#include "apps/billboard_bench_runs.h"
#include "apps/progress.h"
#include "core/metrics.h"

namespace lw {

namespace {

constexpr int kUpdates = 256;
constexpr double kCap_px = 2.0;
/// Quads are made at the first camera, kUpdates a frame, then grow old for some frames that are not judged.
constexpr int kFramesToMakeAll = 5;
constexpr int kFramesBefore = 4;

struct Plan {
    glm::ivec2 size_px{1024, 1024};
    std::vector<double> rates_hz{5.0, 10.0, 20.0, 30.0, 60.0};
    /// Slowly over the overview, down, and out: where billboards are many and the eye moves.
    std::vector<double> stretches_from_s{11.0, 22.0, 48.0};
    int frames = 8;  ///< judged ones of a stretch
};

Plan plan_of(bool quick) {
    Plan plan;
    if (!quick) return plan;
    plan.size_px = {512, 512};
    plan.rates_hz = {10.0};
    plan.stretches_from_s = {22.0};
    plan.frames = 3;
    return plan;
}

bool all_fresh(const BillboardCounters& counters) { return counters.created + counters.updated == counters.active; }

/// The ways to draw of one schedule, in every frame of one rate.
class Pair {
public:
    static Result<Pair> create(const BillboardStage& stage, PairSchedule schedule, double client_hz) {
        auto flat = stage.trial("flat", settings_of(BillboardMode::flat, schedule, false));
        if (!flat.ok()) return flat.error();
        auto blended = stage.trial("flat, blended", settings_of(BillboardMode::flat, schedule, true));
        if (!blended.ok()) return blended.error();
        auto warped = stage.trial("warped", settings_of(BillboardMode::warped, schedule, false));
        if (!warped.ok()) return warped.error();
        Pair pair{std::move(*flat), std::move(*blended), std::move(*warped)};
        for (const bool is_blended : {false, true}) {
            LikenessPoint& point = pair.points_[is_blended ? 1 : 0];
            point.schedule = schedule;
            point.flat_blended = is_blended;
            point.client_hz = client_hz;
        }
        return pair;
    }

    void draw(const Camera& camera) {
        for (BillboardTrial* trial : {&flat_, &blended_, &warped_}) (void)trial->draw(camera, 0.0);
    }

    void judge(const Camera& camera, const ColourImage& meshes) {
        const double likeness = ssim(meshes, warped_.draw(camera, 0.0));
        add(ssim(meshes, flat_.draw(camera, 0.0)), likeness, points_[0]);
        add(ssim(meshes, blended_.draw(camera, 0.0)), likeness, points_[1]);
    }

    [[nodiscard]] const std::array<LikenessPoint, 2>& points() const { return points_; }

private:
    Pair(BillboardTrial flat, BillboardTrial blended, BillboardTrial warped)
        : flat_{std::move(flat)}, blended_{std::move(blended)}, warped_{std::move(warped)} {}

    static BillboardSettings settings_of(BillboardMode mode, PairSchedule schedule, bool blend_flat) {
        BillboardSettings settings = by_angles(mode, kUpdates);
        settings.blend_flat = blend_flat;
        if (schedule == PairSchedule::warped_error) {
            settings.criterion = UpdateCriterion::warped_error;
            settings.error_cap_px = kCap_px;
        }
        return settings;
    }

    /// Of the frame drawn last.
    void add(double ssim_flat, double ssim_warped, LikenessPoint& point) const {
        const BillboardCounters& counters = warped_.frames().back().counters;
        const auto before = static_cast<double>(point.frames());
        const auto mean = [before](double of_before, double value) {
            return (of_before * before + value) / (before + 1.0);
        };
        point.ssim_flat = mean(point.ssim_flat, ssim_flat);
        point.ssim_warped = mean(point.ssim_warped, ssim_warped);
        const auto fresh = static_cast<double>(counters.created + counters.updated);
        point.fresh_share = mean(point.fresh_share, fresh / std::max(1.0, static_cast<double>(counters.active)));
        point.worst_loss = std::max(point.worst_loss, ssim_flat - ssim_warped);
        if (all_fresh(counters)) {
            ++point.fresh;
        } else if (ssim_flat == ssim_warped) {
            ++point.equal;
        } else {
            ++(ssim_warped > ssim_flat ? point.better : point.worse);
        }
    }

    BillboardTrial flat_;
    BillboardTrial blended_;
    BillboardTrial warped_;
    std::array<LikenessPoint, 2> points_;
};

/// One stretch of the flight, the meshes drawn once for all pairs.
void fly(const std::vector<Camera>& cameras, BillboardTrial& meshes, std::vector<Pair>& pairs) {
    for (Pair& pair : pairs) {
        for (int k = 0; k < kFramesToMakeAll; ++k) pair.draw(cameras.front());
    }
    for (std::size_t k = 1; k < cameras.size(); ++k) {
        const bool judged = k > kFramesBefore;
        if (judged) (void)meshes.draw(cameras[k], 0.0);
        for (Pair& pair : pairs) {
            if (judged) {
                pair.judge(cameras[k], meshes.picture());
            } else {
                pair.draw(cameras[k]);
            }
        }
    }
}

}  // namespace

Status measure_likeness(const BillboardStage& stage, bool quick, BillboardBench& bench) {
    const Plan plan = plan_of(quick);
    auto meshes = stage.trial("meshes", {});
    if (!meshes.ok()) return meshes.error();
    Progress progress{"billboards: likeness", plan.rates_hz.size() * plan.stretches_from_s.size(), stage.quiet()};
    std::uint64_t done = 0;
    for (const double client_hz : plan.rates_hz) {
        std::vector<Pair> pairs;
        for (const PairSchedule schedule : {PairSchedule::angles, PairSchedule::warped_error}) {
            auto pair = Pair::create(stage, schedule, client_hz);
            if (!pair.ok()) return pair.error();
            pairs.push_back(std::move(*pair));
        }
        const double step_s = 1.0 / client_hz;
        for (const double from_s : plan.stretches_from_s) {
            const double to_s = from_s + (1 + kFramesBefore + plan.frames - 0.5) * step_s;
            fly(stage.cameras(from_s, to_s, step_s, plan.size_px), *meshes, pairs);
            progress.show(++done);
        }
        for (const Pair& pair : pairs)
            bench.likeness.insert(bench.likeness.end(), pair.points().begin(), pair.points().end());
    }
    return Done{};
}

}  // namespace lw
