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
/// At the first camera of a stretch quads are made, or drawn anew where they are due, kUpdates a frame; then they grow
/// old for some frames that are not judged.
constexpr int kFramesToMakeAll = 4;
constexpr int kFramesBefore = 3;

struct Plan {
    glm::ivec2 size_px{1024, 1024};
    std::vector<double> rates_hz{60.0, 30.0, 20.0, 10.0, 5.0};
    /// Slowly over the overview, down, and out: where billboards are many and the eye moves.
    std::vector<double> stretches_from_s{11.0, 22.0, 48.0};
    int frames = 5;  ///< judged ones of a stretch
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

/// The ways to draw of one schedule, frame by frame beside each other.
class Pair {
public:
    /// `with_blended`: flat quads that blend texels are compared with too.
    static Result<Pair> create(const BillboardStage& stage, PairSchedule schedule, bool with_blended) {
        auto warped = stage.trial("warped", settings_of(BillboardMode::warped, schedule, false));
        if (!warped.ok()) return warped.error();
        Pair pair{std::move(*warped), schedule};
        for (const bool blended : {false, true}) {
            if (blended && !with_blended) continue;
            auto flat = stage.trial("flat", settings_of(BillboardMode::flat, schedule, blended));
            if (!flat.ok()) return flat.error();
            pair.flat_.push_back(std::move(*flat));
        }
        return pair;
    }

    void draw(const Camera& camera) {
        (void)warped_.draw(camera, 0.0);
        for (BillboardTrial& trial : flat_) (void)trial.draw(camera, 0.0);
    }

    /// Draws too. Adds to the points of that rate.
    void judge(const Camera& camera, const ColourImage& meshes, double client_hz) {
        draw(camera);
        const double likeness = ssim(meshes, warped_.picture());
        for (std::size_t i = 0; i < flat_.size(); ++i) {
            add(ssim(meshes, flat_[i].picture()), likeness, point_at(i == 1, client_hz));
        }
    }

    [[nodiscard]] const std::vector<LikenessPoint>& points() const { return points_; }

private:
    Pair(BillboardTrial warped, PairSchedule schedule) : warped_{std::move(warped)}, schedule_{schedule} {}

    LikenessPoint& point_at(bool flat_blended, double client_hz) {
        const auto found = std::ranges::find_if(points_, [&](const LikenessPoint& point) {
            return point.flat_blended == flat_blended && point.client_hz == client_hz;
        });
        if (found != points_.end()) return *found;
        LikenessPoint point;
        point.schedule = schedule_;
        point.flat_blended = flat_blended;
        point.client_hz = client_hz;
        return points_.emplace_back(point);
    }

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

    BillboardTrial warped_;
    PairSchedule schedule_;
    std::vector<BillboardTrial> flat_;  ///< as they are, then with blended texels
    std::vector<LikenessPoint> points_;
};

/// A stretch at one rate, the meshes drawn once for all pairs.
void fly(const std::vector<Camera>& cameras, double client_hz, BillboardTrial& meshes, std::vector<Pair>& pairs) {
    for (Pair& pair : pairs) {
        for (int k = 0; k < kFramesToMakeAll; ++k) pair.draw(cameras.front());
    }
    for (int k = 1; k < static_cast<int>(cameras.size()); ++k) {
        const Camera& camera = cameras[static_cast<std::size_t>(k)];
        const bool judged = k > kFramesBefore;
        if (judged) (void)meshes.draw(camera, 0.0);
        for (Pair& pair : pairs) {
            if (judged) {
                pair.judge(camera, meshes.picture(), client_hz);
            } else {
                pair.draw(camera);
            }
        }
    }
}

}  // namespace

const char* name_of(PairSchedule schedule) { return schedule == PairSchedule::angles ? "angles" : "error of warped"; }

Status measure_likeness(const BillboardStage& stage, bool quick, BillboardBench& bench) {
    const Plan plan = plan_of(quick);
    auto meshes = stage.trial("meshes", {});
    if (!meshes.ok()) return meshes.error();
    std::vector<Pair> pairs;
    for (const PairSchedule schedule : {PairSchedule::angles, PairSchedule::warped_error}) {
        auto pair = Pair::create(stage, schedule, schedule == PairSchedule::angles);
        if (!pair.ok()) return pair.error();
        pairs.push_back(std::move(*pair));
    }
    Progress progress{"billboards: likeness", plan.rates_hz.size() * plan.stretches_from_s.size(), stage.quiet()};
    std::uint64_t done = 0;
    for (const double from_s : plan.stretches_from_s) {
        for (const double client_hz : plan.rates_hz) {
            const double step_s = 1.0 / client_hz;
            const double to_s = from_s + (kFramesBefore + plan.frames + 0.5) * step_s;
            fly(stage.cameras(from_s, to_s, step_s, plan.size_px), client_hz, *meshes, pairs);
            progress.show(++done);
        }
    }
    for (const Pair& pair : pairs) {
        bench.likeness.insert(bench.likeness.end(), pair.points().begin(), pair.points().end());
    }
    return Done{};
}

}  // namespace lw
