#include "apps/billboard_bench_tables.h"

#include "apps/html_report.h"

namespace lw {
namespace {

TableRows sweep_rows(std::span<const SweepPoint> points, const char* value_name) {
    TableRows rows{{"billboards", "criterion", value_name, "redraws per frame", "FLIP to truth", "FLIP to meshes",
                    "SSIM to meshes", "worst SSIM", "active", "frame ms", "worst update to median"}};
    for (const SweepPoint& p : points) {
        rows.push_back({p.mode, p.criterion, short_number(p.value), short_number(p.redraws_per_frame),
                        fmt::format("{:.5f}", p.flip_truth), fmt::format("{:.5f}", p.flip),
                        fmt::format("{:.4f}", p.ssim), fmt::format("{:.4f}", p.worst_ssim), short_number(p.active),
                        short_number(p.frame_ms), short_number(p.worst_to_median)});
    }
    return rows;
}

TableRows criteria_rows(const SweepPoint& meshes, std::span<const SweepPoint> settings) {
    std::vector<SweepPoint> points{meshes};
    points.insert(points.end(), settings.begin(), settings.end());
    return sweep_rows(points, "cap, px, or times the angles");
}

TableRows redraw_rows(std::span<const SweepPoint> points) {
    TableRows rows{{"flat, by", "value", "FLIP to truth", "redraws per frame", "warped, as good with", "share"}};
    for (const RedrawShare& share : redraw_shares(points)) {
        rows.push_back({share.flat.criterion, short_number(share.flat.value),
                        fmt::format("{:.5f}", share.flat.flip_truth), short_number(share.flat.redraws_per_frame),
                        share.warped_redraws ? short_number(*share.warped_redraws) : "not reached",
                        short_number(share.share())});
    }
    return rows;
}

TableRows likeness_rows(std::span<const LikenessPoint> points) {
    TableRows rows{{"drawn anew by", "flat", "client, Hz", "frames", "all fresh", "equal", "warped nearer",
                    "fresh quads", "SSIM, flat", "SSIM, warped", "lost at most"}};
    for (const LikenessPoint& p : points) {
        rows.push_back({name_of(p.schedule), p.flat_blended ? "blended" : "nearest", short_number(p.client_hz),
                        fmt::format("{}", p.frames()), fmt::format("{}", p.fresh), fmt::format("{}", p.equal),
                        fmt::format("{}", p.better), fmt::format("{:.0f} %", 100.0 * p.fresh_share),
                        fmt::format("{:.5f}", p.ssim_flat), fmt::format("{:.5f}", p.ssim_warped),
                        fmt::format("{:.6f}", p.worst_loss)});
    }
    return rows;
}

TableRows still_rows(std::span<const StillPoint> points) {
    TableRows rows{{"", "SSIM", "FLIP", "updates", "choosing ms", "drawing ms", "bytes per texel"}};
    for (const StillPoint& p : points) {
        rows.push_back({p.label, fmt::format("{:.5f}", p.ssim), fmt::format("{:.5f}", p.flip),
                        fmt::format("{}", p.updates), short_number(p.choose_ms), short_number(p.draw_ms),
                        fmt::format("{}", p.bytes_per_texel)});
    }
    return rows;
}

TableRows flicker_rows(std::span<const FlickerPoint> points) {
    TableRows rows{
        {"billboards", "fade, frames", "updates", "updates alone", "per update", "by pixel", "flicker", "worst frame"}};
    for (const FlickerPoint& p : points) {
        rows.push_back({p.mode, fmt::format("{}", p.fade_frames), fmt::format("{}", p.updates), short_number(p.pop),
                        short_number(p.pop_per_update), short_number(p.pop_by_pixel), short_number(p.flicker),
                        short_number(p.worst_flicker)});
    }
    return rows;
}

TableRows memory_rows(const PathRun& path) {
    TableRows rows{{"slot", "MB, 10 bytes per texel", "MB, 13 bytes", "MB, 16 bytes"}};
    std::size_t sum = 0;
    const auto row = [&rows](std::string label, std::size_t bytes) {
        const double megabytes = static_cast<double>(bytes) * 1e-6;
        rows.push_back(
            {std::move(label), short_number(megabytes), short_number(1.3 * megabytes), short_number(1.6 * megabytes)});
    };
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        row(fmt::format("{0} x {0}", kBillboardDimensions[level]), path.bytes[level]);
        sum += path.bytes[level];
    }
    row("in all", sum);
    return rows;
}

}  // namespace

TableRows figure_rows(const BillboardFigures& f) {
    return {{"figure", "value"},
            {"speed-up, best 100 frames at least", short_number(f.speedup_best_100)},
            {"the same by processor time", short_number(f.speedup_best_100_processor)},
            {fmt::format("speed-up, {} eligible frames at least", f.eligible), short_number(f.speedup_min_eligible)},
            {"the same by processor time", short_number(f.speedup_min_eligible_processor)},
            {"SSIM, mean", fmt::format("{:.4f}", f.ssim_mean)},
            {"SSIM, worst", fmt::format("{:.4f}", f.ssim_min)},
            {"frames with warped nearer than flat, by angles", fmt::format("{:.1f} %", 100.0 * f.warped_better)},
            {"the same by the error of warped ones", fmt::format("{:.1f} %", 100.0 * f.warped_better_by_error)},
            {"SSIM lost in the others, at most", fmt::format("{:.6f}", f.warped_loss)},
            {"redraws, warped to flat at equal FLIP", short_number(f.redraw_ratio)},
            {"the same on a walk to the side", short_number(f.redraw_ratio_beside)},
            {"flicker of updates, with fade to without", short_number(f.flicker_ratio)},
            {"the same per update", short_number(f.flicker_ratio_per_update)},
            {"worst update to median, with a budget", short_number(f.worst_to_median)}};
}

std::vector<BenchTable> tables_of(const BillboardBench& bench) {
    return {{"Flat against warped with the same redraws", likeness_rows(bench.likeness)},
            {"Error and redraws by criterion, on the dive", criteria_rows(bench.meshes, bench.caps)},
            {"Redraws for the same error, on the dive", redraw_rows(bench.caps)},
            {"Error and redraws by criterion, on a walk to the side", criteria_rows(bench.meshes_beside, bench.beside)},
            {"Redraws for the same error, on a walk to the side", redraw_rows(bench.beside)},
            {"Share of the scene within which objects stay meshes", sweep_rows(bench.thresholds, "share")},
            {"Time for updates", sweep_rows(bench.budgets, "budget, ms")},
            {"Flicker while the eye moves", flicker_rows(bench.flicker)},
            {"A still camera: layouts", still_rows(bench.still)},
            {"Layouts, 3 m beside where the billboards were drawn", still_rows(bench.layouts)},
            {"Ways to make quads", still_rows(bench.expansions)},
            {"Touching objects, 3 m beside where the billboards were drawn", still_rows(bench.groups)},
            {"Flat billboards without depth, 3 m beside where they were drawn", still_rows(bench.depthless)},
            {"Flat and warped, after motion without updates", still_rows(bench.motions)},
            {"Memory", memory_rows(bench.path)}};
}

}  // namespace lw
