#pragma once
/// What the measurements of the suite `billboards` come down to.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "apps/billboard_bench_runs.h"

namespace lw {

/// The figures that the whole suite comes down to.
struct BillboardFigures {
    /// Least speed-up of the best hundred frames (of all, where there are fewer), by wall and by processor time.
    double speedup_best_100 = 0.0;
    double speedup_best_100_processor = 0.0;
    /// Over frames with 80 % of the triangles replaceable and 64 redraws at most.
    double speedup_min_eligible = 0.0;
    double speedup_min_eligible_processor = 0.0;
    std::size_t eligible = 0;
    double ssim_mean = 1.0;
    double ssim_min = 1.0;
    /// Share of the frames in which warped quads are nearer to the meshes than flat ones drawn anew at the same times,
    /// by the angles and by the error of warped ones, over all rates of the client; frames with nothing but fresh quads
    /// do not count. And how much SSIM is lost where they are not nearer.
    double warped_better = 0.0;
    double warped_better_by_error = 0.0;
    double warped_loss = 0.0;
    double redraw_ratio = 0.0;         ///< redraws of warped to flat ones at the FLIP of flat ones with the default cap
    double redraw_ratio_beside = 0.0;  ///< the same on the walk to the side
    double flicker_ratio = 0.0;        ///< what updates change in a frame, with cross-fade to without, warped
    double flicker_ratio_per_update = 0.0;
    double worst_to_median = 0.0;  ///< the median frame with the costliest updates to the median frame, with a budget
};

/// Pure.
[[nodiscard]] BillboardFigures figures_of(const BillboardBench& bench);

/// Share of the frames of `points` in which warped quads are nearer, of those with quads that are not fresh; 0 without
/// any. Pure.
[[nodiscard]] double share_better(std::span<const LikenessPoint> points);

/// The fewest redraws per frame with which one curve is as near to the truth as `flip`, by linear interpolation between
/// its points in order of their redraws. Nothing where it never is. Pure.
[[nodiscard]] std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip);

/// A setting of flat billboards and what warped ones need for the same FLIP to the truth.
struct RedrawShare {
    SweepPoint flat;
    std::optional<double> warped_redraws;  ///< per frame; nothing: they do not get as near

    /// Infinite where it is not reached.
    [[nodiscard]] double share() const {
        return warped_redraws ? *warped_redraws / flat.redraws_per_frame : std::numeric_limits<double>::infinity();
    }
};

/// Of all settings of flat billboards among `points`. Pure.
[[nodiscard]] std::vector<RedrawShare> redraw_shares(std::span<const SweepPoint> points);

/// The points of one mode and criterion, in their order. Pure.
[[nodiscard]] std::vector<SweepPoint> curve_of(std::span<const SweepPoint> points, const char* mode,
                                               const char* criterion);

/// Whether a frame counts for speedup_min_eligible. Pure.
[[nodiscard]] bool is_eligible(const TrialFrame& frame);

/// Frames of ours that were drawn right after the same frame of meshes.
struct FramePair {
    const TrialFrame* meshes;
    const TrialFrame* ours;

    [[nodiscard]] double speedup(double TrialFrame::*ms) const { return meshes->*ms / ours->*ms; }
};

/// As many as both have; they point into both, which outlive them. Pure.
[[nodiscard]] std::vector<FramePair> pairs_of(const std::vector<TrialFrame>& meshes,
                                              const std::vector<TrialFrame>& ours);

}  // namespace lw
