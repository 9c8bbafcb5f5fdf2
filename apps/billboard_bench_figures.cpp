#include "apps/billboard_bench_figures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace lw {
namespace {

constexpr double kEligibleShare = 0.8;
constexpr std::uint64_t kEligibleRedraws = 64;
const double kDefaultCap_px = BillboardSettings{}.error_cap_px;

std::uint64_t redraws(const TrialFrame& frame) { return frame.counters.created + frame.counters.updated; }

double flicker_of(std::span<const FlickerPoint> points, bool fades, double FlickerPoint::*value) {
    for (const FlickerPoint& point : points) {
        if (point.mode == "warped" && (point.fade_frames > 0) == fades) return point.*value;
    }
    return 0.0;
}

/// With fades to without, of warped billboards.
double flicker_ratio(std::span<const FlickerPoint> points, double FlickerPoint::*value) {
    const double without = flicker_of(points, false, value);
    return without > 0.0 ? flicker_of(points, true, value) / without : 0.0;
}

double share_at_default_cap(std::span<const SweepPoint> points) {
    for (const RedrawShare& share : redraw_shares(points)) {
        if (share.flat.criterion == "error" && share.flat.value == kDefaultCap_px) return share.share();
    }
    return 0.0;
}

std::vector<LikenessPoint> likeness_of(std::span<const LikenessPoint> points, PairSchedule schedule,
                                       bool flat_blended) {
    std::vector<LikenessPoint> some;
    for (const LikenessPoint& point : points) {
        if (point.schedule == schedule && point.flat_blended == flat_blended) some.push_back(point);
    }
    return some;
}

/// Against flat ones as they are.
void set_likeness(std::span<const LikenessPoint> points, BillboardFigures& figures) {
    figures.warped_better = share_better(likeness_of(points, PairSchedule::angles, false));
    figures.warped_better_by_error = share_better(likeness_of(points, PairSchedule::warped_error, false));
    for (const LikenessPoint& point : points) {
        if (!point.flat_blended) figures.warped_loss = std::max(figures.warped_loss, point.worst_loss);
    }
}

double least_of_best_100(const PairRun& overview, double TrialFrame::*ms) {
    std::vector<double> speedups;
    for (const FramePair& pair : pairs_of(overview.meshes, overview.ours)) speedups.push_back(pair.speedup(ms));
    std::ranges::sort(speedups, std::greater{});
    return speedups.empty() ? 0.0 : speedups[std::min<std::size_t>(speedups.size(), 100) - 1];
}

double least_of(std::span<const FramePair> pairs, double TrialFrame::*ms) {
    double least = std::numeric_limits<double>::infinity();
    for (const FramePair& pair : pairs) least = std::min(least, pair.speedup(ms));
    return least;
}

void set_speedups(const BillboardBench& bench, BillboardFigures& figures) {
    figures.speedup_best_100 = least_of_best_100(bench.overview, &TrialFrame::wall_ms);
    figures.speedup_best_100_processor = least_of_best_100(bench.overview, &TrialFrame::frame_ms);
    std::vector<FramePair> pairs = pairs_of(bench.path.meshes, bench.path.ours());
    std::ranges::copy(pairs_of(bench.overview.meshes, bench.overview.ours), std::back_inserter(pairs));
    std::erase_if(pairs, [](const FramePair& pair) { return !is_eligible(*pair.ours); });
    figures.eligible = pairs.size();
    figures.speedup_min_eligible = least_of(pairs, &TrialFrame::wall_ms);
    figures.speedup_min_eligible_processor = least_of(pairs, &TrialFrame::frame_ms);
}

}  // namespace

BillboardFigures figures_of(const BillboardBench& bench) {
    BillboardFigures figures;
    set_speedups(bench, figures);
    figures.ssim_mean = 0.0;
    for (const PathQuality& quality : bench.path.quality) {
        const auto count = static_cast<double>(bench.path.quality.size());
        figures.ssim_mean += quality.ssim_ours / count;
        figures.ssim_min = std::min(figures.ssim_min, quality.ssim_ours);
    }
    set_likeness(bench.likeness, figures);
    figures.redraw_ratio = share_at_default_cap(bench.caps);
    figures.redraw_ratio_beside = share_at_default_cap(bench.beside);
    figures.flicker_ratio = flicker_ratio(bench.flicker, &FlickerPoint::pop);
    figures.flicker_ratio_per_update = flicker_ratio(bench.flicker, &FlickerPoint::pop_per_update);
    if (!bench.budgets.empty()) figures.worst_to_median = bench.budgets.back().worst_to_median;
    return figures;
}

std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip) {
    std::vector<SweepPoint> sorted{curve.begin(), curve.end()};
    std::ranges::stable_sort(sorted, {}, &SweepPoint::redraws_per_frame);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const SweepPoint& b = sorted[i];
        if (b.flip_truth > flip) continue;
        if (i == 0) return b.redraws_per_frame;
        const SweepPoint& a = sorted[i - 1];
        return std::lerp(a.redraws_per_frame, b.redraws_per_frame,
                         (flip - a.flip_truth) / (b.flip_truth - a.flip_truth));
    }
    return std::nullopt;
}

double share_better(std::span<const LikenessPoint> points) {
    int better = 0;
    int judged = 0;
    for (const LikenessPoint& point : points) {
        better += point.better;
        judged += point.frames() - point.fresh;
    }
    return judged == 0 ? 0.0 : static_cast<double>(better) / judged;
}

std::vector<RedrawShare> redraw_shares(std::span<const SweepPoint> points) {
    const std::vector<SweepPoint> warped = curve_of(points, "warped", "error");
    std::vector<RedrawShare> shares;
    for (const SweepPoint& flat : points) {
        if (flat.mode != "flat") continue;
        shares.push_back({flat, redraws_for_flip(warped, flat.flip_truth)});
    }
    return shares;
}

std::vector<SweepPoint> curve_of(std::span<const SweepPoint> points, const char* mode, const char* criterion) {
    std::vector<SweepPoint> curve;
    for (const SweepPoint& point : points) {
        if (point.mode == mode && point.criterion == criterion) curve.push_back(point);
    }
    return curve;
}

bool is_eligible(const TrialFrame& frame) {
    const auto in_view = static_cast<double>(frame.counters.triangles_in_view);
    const auto replaceable = static_cast<double>(frame.counters.triangles_replaceable);
    return in_view > 0.0 && replaceable >= kEligibleShare * in_view && redraws(frame) <= kEligibleRedraws;
}

std::vector<FramePair> pairs_of(const std::vector<TrialFrame>& meshes, const std::vector<TrialFrame>& ours) {
    std::vector<FramePair> pairs;
    for (std::size_t k = 0; k < std::min(meshes.size(), ours.size()); ++k) pairs.push_back({&meshes[k], &ours[k]});
    return pairs;
}

}  // namespace lw
