#include "apps/replay_report.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "apps/shell_report.h"
#include "apps/skip_report.h"

namespace lw {

namespace {

/// In the order of AttributedError's members.
constexpr const char* kCauses[] = {"resampled", "disoccluded", "out_of_frame", "stale_shading"};

/// One figure of one method per refresh; nothing for a picture without a PSNR.
using Figure = std::optional<double> (*)(const ImageErrors&);

std::optional<double> flip_of(const ImageErrors& errors) { return errors.flip; }
std::optional<double> ssim_of(const ImageErrors& errors) { return errors.ssim; }
std::optional<double> psnr_of(const ImageErrors& errors) { return errors.psnr_db; }
std::optional<double> holes_of(const ImageErrors& errors) { return errors.hole_fraction; }
std::optional<double> behind_of(const ImageErrors& errors) { return errors.behind_fraction; }
std::optional<double> flicker_of(const ImageErrors& errors) { return errors.flicker; }
std::optional<double> resampled_of(const ImageErrors& errors) { return errors.attribution.resampled; }
std::optional<double> disoccluded_of(const ImageErrors& errors) { return errors.attribution.disoccluded; }
std::optional<double> out_of_frame_of(const ImageErrors& errors) { return errors.attribution.out_of_frame; }
std::optional<double> stale_shading_of(const ImageErrors& errors) { return errors.attribution.stale_shading; }

std::optional<double> ssim_to_same_of(const ImageErrors& errors) { return errors.ssim_to_same; }

std::vector<double> known_values(const ReplayResult& result, std::size_t method, Figure figure,
                                 std::optional<std::size_t> only_eye) {
    std::vector<double> values;
    for (const RefreshRecord& record : result.refreshes) {
        for (std::size_t eye = 0; eye < record.eyes.size(); ++eye) {
            if (only_eye && *only_eye != eye) continue;
            const std::optional<double> value = figure(record.eyes[eye].errors[method]);
            if (value) values.push_back(*value);
        }
    }
    return values;
}

/// Of both eyes, where one refresh has one value.
std::optional<double> mean_over_eyes(const RefreshRecord& record, std::size_t method, Figure figure) {
    double sum = 0.0;
    double count = 0.0;
    for (const EyeRecord& eye : record.eyes) {
        const std::optional<double> value = figure(eye.errors[method]);
        if (!value) continue;
        sum += *value;
        count += 1.0;
    }
    if (count == 0.0) return std::nullopt;
    return sum / count;
}

bool has_two_eyes(const ReplayResult& result) { return result.refreshes.front().eyes.size() == 2; }

std::uint64_t picture_count(const ReplayResult& result, std::optional<std::size_t> only_eye) {
    const std::size_t eyes = result.refreshes.empty() ? 1 : result.refreshes.front().eyes.size();
    return result.refreshes.size() * (only_eye ? 1 : eyes);
}

/// The first value warmed caches up and grew buffers; with only one there is nothing better.
std::optional<Distribution> cost_of(const std::vector<double>& values_ms) {
    const std::span<const double> values{values_ms};
    return distribution_of(values.size() > 1 ? values.subspan(1) : values);
}

void add_errors(Report& report, const std::string& path, const ErrorSummary& summary) {
    report.set(path + "/flip", summary.flip);
    report.set(path + "/ssim", summary.ssim);
    report.set(path + "/psnr_db", summary.psnr_db);
    report.set(path + "/hole_fraction", summary.hole_fraction);
    report.set(path + "/behind_fraction", summary.behind_fraction);
    report.set(path + "/flicker", summary.flicker);
    if (summary.ssim_to_same) report.set(path + "/ssim_to_fresh_same", summary.ssim_to_same);
    report.set(path + "/attribution/resampled", summary.attribution.resampled);
    report.set(path + "/attribution/disoccluded", summary.attribution.disoccluded);
    report.set(path + "/attribution/out_of_frame", summary.attribution.out_of_frame);
    report.set(path + "/attribution/stale_shading", summary.attribution.stale_shading);
}

void add_cause_shares(Report& report, const ReplayResult& result) {
    const auto add = [&](const char* key, double AttributedError::*part) {
        std::vector<double> shares;
        for (const RefreshRecord& record : result.refreshes) {
            for (const EyeRecord& eye : record.eyes) shares.push_back(eye.cause_shares.*part);
        }
        report.set(fmt::format("cause_shares/{}", key), distribution_of(shares));
    };
    add("resampled", &AttributedError::resampled);
    add("disoccluded", &AttributedError::disoccluded);
    add("out_of_frame", &AttributedError::out_of_frame);
    add("stale_shading", &AttributedError::stale_shading);
}

std::string csv_of(const AttributedError& parts) {
    return fmt::format(",{},{},{},{}", parts.resampled, parts.disoccluded, parts.out_of_frame, parts.stale_shading);
}

void add_costs(Report& report, const ReplayResult& result) {
    const ReplayCosts& costs = result.costs;
    report.set("cost_ms/warp", cost_of(costs.warp_ms.front()));
    report.set("cost_ms/warp_cpu", cost_of(costs.warp_cpu_ms.front()));
    report.set("cost_ms/prepare", cost_of(costs.prepare_ms.front()));
    report.set("cost_ms/app", cost_of(costs.app_ms.front()));
    if (!costs.main_view_ms.empty()) report.set("cost_ms/main_view", cost_of(costs.main_view_ms));
    for (std::size_t i = 1; i < result.labels.size(); ++i) {
        const std::string path = "cost_ms/baselines/" + result.labels[i];
        report.set(path + "/warp", cost_of(costs.warp_ms[i]));
        report.set(path + "/warp_cpu", cost_of(costs.warp_cpu_ms[i]));
        report.set(path + "/prepare", cost_of(costs.prepare_ms[i]));
        if (has_two_eyes(result)) report.set(path + "/app", cost_of(costs.app_ms[i]));
    }
}

void add_stereo(Report& report, const std::string& path, const ReplayResult& result, std::size_t method) {
    const StereoSummary stereo = stereo_summary_of(result, method);
    report.set(path + "/rivalry_fraction", stereo.rivalry_fraction);
    report.set(path + "/vertical_disparity_px", stereo.vertical_disparity_px);
    report.set(path + "/colour_excess", stereo.colour_excess);
    for (const Eye eye : kEyes) {
        add_errors(report, fmt::format("{}/{}/error", path, name_of(eye)),
                   summary_of(result, method, static_cast<std::size_t>(eye)));
    }
}

/// A label may hold commas ("points:size_px=2,x=1").
std::string csv_field(const std::string& text) {
    return text.find(',') == std::string::npos ? text : fmt::format("\"{}\"", text);
}

std::string csv_of(const std::optional<double>& number) { return number ? fmt::format("{}", *number) : ""; }

std::string csv_columns(const std::string& label, bool two_eyes) {
    std::string columns;
    const auto add = [&](std::string_view figure) { columns += "," + csv_field(fmt::format("{}.{}", label, figure)); };
    for (const char* figure : {"flip", "ssim", "psnr_db", "hole_fraction"}) add(figure);
    for (const char* cause : kCauses) add(fmt::format("attribution.{}", cause));
    add("flicker");
    if (!two_eyes) return columns;
    for (const char* figure : {"rivalry_fraction", "vertical_disparity_px", "colour_excess"}) add(figure);
    return columns;
}

/// One method's figures of one eye, then, with two eyes, those of both.
std::string csv_of(const RefreshRecord& record, std::size_t eye, std::size_t method) {
    const ImageErrors& errors = record.eyes[eye].errors[method];
    std::string csv =
        fmt::format(",{},{},{},{}", errors.flip, errors.ssim, csv_of(errors.psnr_db), errors.hole_fraction);
    csv += csv_of(errors.attribution) + "," + csv_of(errors.flicker);
    if (record.consistency.empty()) return csv;
    const std::optional<EyeConsistency>& eyes = record.consistency[method];
    if (!eyes) return csv + ",,,";
    return csv +
           fmt::format(",{},{},{}", eyes->rivalry_fraction, csv_of(eyes->vertical_disparity_px), eyes->colour_excess);
}

LinePlot plot_of(const ReplayResult& result, std::string title, std::string y_label, Figure figure) {
    LinePlot plot{std::move(title), "photon time, s", std::move(y_label), {}, {}};
    for (const RefreshRecord& record : result.refreshes) plot.x.push_back(record.photon_s);
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        PlotSeries series{result.labels[i], {}};
        for (const RefreshRecord& record : result.refreshes) {
            series.values.push_back(
                mean_over_eyes(record, i, figure).value_or(std::numeric_limits<double>::quiet_NaN()));
        }
        plot.series.push_back(std::move(series));
    }
    return plot;
}

std::vector<std::string> table_row(const std::string& label, const ErrorSummary& summary,
                                   const std::optional<Distribution>& warp_ms) {
    const auto mean_and = [](const std::optional<Distribution>& d, double Distribution::*tail) {
        if (!d) return std::string{"-"};
        return fmt::format("{} ({})", short_number(d->mean), short_number((*d).*tail));
    };
    return {label,
            mean_and(summary.flip, &Distribution::p95),
            mean_and(summary.psnr_db, &Distribution::p5),
            mean_and(summary.ssim, &Distribution::p5),
            mean_and(summary.hole_fraction, &Distribution::p95),
            mean_and(summary.flicker, &Distribution::p95),
            mean_and(warp_ms, &Distribution::p99)};
}

std::vector<std::vector<std::string>> attribution_table(const ReplayResult& result) {
    std::vector<std::vector<std::string>> rows = {
        {"method", "FLIP", "resampled", "disoccluded", "out of frame", "stale shading"}};
    const auto mean = [](const std::optional<Distribution>& d) { return d ? short_number(d->mean) : std::string{"-"}; };
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        const ErrorSummary summary = summary_of(result, i);
        const ErrorSummary::Parts& parts = summary.attribution;
        rows.push_back({result.labels[i], mean(summary.flip), mean(parts.resampled), mean(parts.disoccluded),
                        mean(parts.out_of_frame), mean(parts.stale_shading)});
    }
    AttributedError shares;
    const auto count = static_cast<double>(picture_count(result, {}));
    for (const RefreshRecord& record : result.refreshes) {
        for (const EyeRecord& eye : record.eyes) {
            shares.resampled += eye.cause_shares.resampled / count;
            shares.disoccluded += eye.cause_shares.disoccluded / count;
            shares.out_of_frame += eye.cause_shares.out_of_frame / count;
            shares.stale_shading += eye.cause_shares.stale_shading / count;
        }
    }
    rows.push_back({"(share of the pixels)", short_number(shares.sum()), short_number(shares.resampled),
                    short_number(shares.disoccluded), short_number(shares.out_of_frame),
                    short_number(shares.stale_shading)});
    return rows;
}

void add_stereo_table(HtmlReport& page, const ReplayResult& result) {
    page.add_heading("How well both eyes agree: mean over the run (p95)");
    page.add_paragraph(
        "Over pixel pairs that see the same point. Rivalry: one of both was made up, the other seen. Vertical "
        "disparity: pixels beyond the truth's. Colour excess: difference beyond the truth's, sRGB in [0, 1].");
    std::vector<std::vector<std::string>> rows = {{"method", "rivalry", "vertical disparity, px", "colour excess"}};
    const auto text = [](const std::optional<Distribution>& d) {
        return d ? fmt::format("{} ({})", short_number(d->mean), short_number(d->p95)) : std::string{"-"};
    };
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        const StereoSummary stereo = stereo_summary_of(result, i);
        rows.push_back({result.labels[i], text(stereo.rivalry_fraction), text(stereo.vertical_disparity_px),
                        text(stereo.colour_excess)});
    }
    page.add_table(rows);
}

}  // namespace

ErrorSummary summary_of(const ReplayResult& result, std::size_t method, std::optional<std::size_t> eye) {
    const std::vector<double> psnr_db = known_values(result, method, psnr_of, eye);
    const auto over_run = [&](Figure figure) { return distribution_of(known_values(result, method, figure, eye)); };
    return {over_run(flip_of),
            over_run(ssim_of),
            distribution_of(psnr_db),
            over_run(holes_of),
            over_run(behind_of),
            over_run(flicker_of),
            over_run(ssim_to_same_of),
            {over_run(resampled_of), over_run(disoccluded_of), over_run(out_of_frame_of), over_run(stale_shading_of)},
            picture_count(result, eye) - psnr_db.size()};
}

StereoSummary stereo_summary_of(const ReplayResult& result, std::size_t method) {
    std::vector<double> rivalry;
    std::vector<double> vertical_px;
    std::vector<double> excess;
    for (const RefreshRecord& record : result.refreshes) {
        if (record.consistency.empty() || !record.consistency[method]) continue;
        const EyeConsistency& eyes = *record.consistency[method];
        rivalry.push_back(eyes.rivalry_fraction);
        excess.push_back(eyes.colour_excess);
        if (eyes.vertical_disparity_px) vertical_px.push_back(*eyes.vertical_disparity_px);
    }
    return {distribution_of(rivalry), distribution_of(vertical_px), distribution_of(excess)};
}

std::size_t typical_refresh(const ReplayResult& result) {
    std::vector<std::size_t> order(result.refreshes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>((order.size() - 1) / 2);
    std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
        const std::optional<double> flip_a = mean_over_eyes(result.refreshes[a], 0, flip_of);
        const std::optional<double> flip_b = mean_over_eyes(result.refreshes[b], 0, flip_of);
        return flip_a != flip_b ? flip_a < flip_b : a < b;
    });
    return *middle;
}

void add_replay_results(Report& report, const ReplayResult& result) {
    report.set("frames", static_cast<std::uint64_t>(result.refreshes.size()));
    report.set("first_refresh", result.refreshes.front().refresh);
    report.set("pixels_per_degree", result.pixels_per_degree);
    report.set("settings/source_pixels_ratio", result.source_pixels_ratio);
    const ErrorSummary summary = summary_of(result, 0);
    add_errors(report, "error", summary);
    add_cause_shares(report, result);
    report.set("equal_frames", summary.equal_frames);
    report.set("bad_depth_pixels", result.bad_depth_pixels);
    for (std::size_t i = 1; i < result.labels.size(); ++i) {
        const ErrorSummary baseline = summary_of(result, i);
        add_errors(report, fmt::format("baselines/{}/error", result.labels[i]), baseline);
        report.set(fmt::format("baselines/{}/equal_frames", result.labels[i]), baseline.equal_frames);
        if (has_two_eyes(result)) add_stereo(report, fmt::format("baselines/{}/stereo", result.labels[i]), result, i);
    }
    if (has_two_eyes(result)) add_stereo(report, "stereo", result, 0);
    std::vector<double> ages_ms;
    for (const RefreshRecord& record : result.refreshes) ages_ms.push_back(record.frame_age_ms());
    report.set("frame_age_ms", distribution_of(ages_ms));
    report.set("app_model_ms", cost_of(result.costs.app_model_ms));
    if (!result.shells.empty()) describe_shells(report, result.shells);
    add_costs(report, result);
    describe_skipped(report, result.client_draws);
}

std::string replay_csv(const ReplayResult& result) {
    const bool two_eyes = has_two_eyes(result);
    std::string csv = "refresh,frame,latched_s,scanout_begin_s,photon_s,pose_sampled_s,frame_age_ms";
    if (two_eyes) csv += ",eye";
    for (const char* cause : kCauses) csv += fmt::format(",cause_shares.{}", cause);
    for (const std::string& label : result.labels) csv += csv_columns(label, two_eyes);
    csv += "\n";
    for (const RefreshRecord& record : result.refreshes) {
        for (std::size_t eye = 0; eye < record.eyes.size(); ++eye) {
            csv += fmt::format("{},{},{},{},{},{},{:.6f}", record.refresh, record.frame, record.latched_s,
                               record.scanout_begin_s, record.photon_s, record.pose_sampled_s, record.frame_age_ms());
            if (two_eyes) csv += fmt::format(",{}", name_of(static_cast<Eye>(eye)));
            csv += csv_of(record.eyes[eye].cause_shares);
            for (std::size_t i = 0; i < result.labels.size(); ++i) csv += csv_of(record, eye, i);
            csv += "\n";
        }
    }
    return csv;
}

std::string replay_html(const ReplayResult& result, const std::string& title, const std::string& description,
                        std::span<const std::uint8_t> strip_png) {
    HtmlReport page{title};
    page.add_paragraph(description);
    if (!strip_png.empty()) page.add_png(strip_png, "The display frame whose FLIP is the median of the run.");
    page.add_heading("Error against the antialiased truth at photon time: mean (bad tail)");
    std::vector<std::vector<std::string>> rows = {
        {"method", "FLIP (p95)", "PSNR, dB (p5)", "SSIM (p5)", "holes (p95)", "flicker (p95)", "warp, ms (p99)"}};
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        rows.push_back(table_row(result.labels[i], summary_of(result, i), cost_of(result.costs.warp_ms[i])));
    }
    page.add_table(rows);
    if (has_two_eyes(result)) add_stereo_table(page, result);
    page.add_heading("Where FLIP comes from: mean over the run, and the share of the pixels");
    page.add_paragraph(
        "Disoccluded: the source saw something else in the surface's place. Out of frame: the place lies outside of "
        "the "
        "source picture. Stale shading: the source shows the surface in another light. Resampled: everything else, "
        "which is sampling. The parts sum to the whole.");
    page.add_table(attribution_table(result));
    page.add_plot(plot_of(result, "FLIP", "lower is better", flip_of));
    page.add_plot(plot_of(result, "PSNR", "dB, higher is better", psnr_of));
    page.add_plot(plot_of(result, "SSIM", "higher is better", ssim_of));
    page.add_plot(plot_of(result, "FLIP of disoccluded pixels", "part of the whole", disoccluded_of));
    page.add_plot(plot_of(result, "Flicker", "change of the error on its surface, sRGB", flicker_of));
    page.add_plot(plot_of(result, "Holes before fill", "fraction of the picture", holes_of));
    LinePlot age{"Frame age", "photon time, s", "ms", {}, {{"frame age", {}}}};
    for (const RefreshRecord& record : result.refreshes) {
        age.x.push_back(record.photon_s);
        age.series.front().values.push_back(record.frame_age_ms());
    }
    page.add_plot(age);
    return page.text();
}

}  // namespace lw
