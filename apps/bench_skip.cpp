/// The suite `skip`: what leaving out costs and saves, and that nothing is missed.

#include <algorithm>

#include "apps/bench_point.h"
#include "apps/bench_suites.h"
#include "apps/progress.h"
#include "apps/skip_measure.h"
#include "apps/skip_orders.h"
#include "frame_link/trace.h"
#include "gl/context.h"
#include "scene/built_in.h"

namespace lw {

namespace {

struct Findings {
    std::vector<FrustumTiming> frustum;
    std::vector<FrameTiming> town;   ///< without skipping, with, and with its culling on one thread
    std::vector<FrameTiming> rooms;  ///< by the field of view only, through portals
    std::vector<FrameTiming> parts;  ///< the default town: nothing skipped, and one way of skipping after the other
    std::vector<RevealCheck> checks;
    std::vector<BufferChanges> buffers;
    std::vector<FrameTiming> orders;  ///< the default town, grouped and through buffers
};

Result<scene::Scene> scene_of(const char* name, const char* key, double value) {
    return scene::make_built_in(name, {{key, value}});
}

Status measure_town(bool quick, Findings& findings) {
    const auto town = scene_of("city", "buildings", quick ? 2000.0 : 20000.0);
    if (!town) return town.error();
    const auto all = time_frames(*town, {.skip = false}, "nothing skipped", 1);
    if (!all) return all.error();
    const auto some = time_frames(*town, {}, "skipping", 40);
    if (!some) return some.error();
    const auto alone = time_frames(*town, {.threads = 1}, "skipping, one thread", 40);
    if (!alone) return alone.error();
    findings.town = {*all, *some, *alone};
    return Done{};
}

Status measure_parts(bool quick, Findings& findings) {
    const auto town = scene_of("city", "buildings", 120.0);
    if (!town) return town.error();
    struct Step {
        const char* label;
        CullingSettings settings;
        int frames;
    };
    const int frames = quick ? 10 : 30;
    const std::vector<Step> steps{{"nothing skipped", {.skip = false}, frames / 2},
                                  {"field of view", {.occlusion = false, .clusters = false}, frames},
                                  {"and hidden objects", {.clusters = false}, frames},
                                  {"and clusters", {}, frames}};
    for (const Step& step : steps) {
        const auto timing = time_frames(*town, step.settings, step.label, step.frames);
        if (!timing) return timing.error();
        findings.parts.push_back(*timing);
    }
    return Done{};
}

Status measure_rooms(bool quick, Findings& findings) {
    const auto rooms = scene_of("rooms", "rooms", 240.0);
    if (!rooms) return rooms.error();
    const int frames = quick ? 10 : 30;
    const auto by_view =
        time_frames(*rooms, {.occlusion = false, .portals = false, .clusters = false}, "field of view", frames);
    if (!by_view) return by_view.error();
    const auto portals = time_frames(*rooms, {.occlusion = false, .clusters = false}, "and portals", frames);
    if (!portals) return portals.error();
    const auto everything = time_frames(*rooms, {}, "and hidden objects and clusters", frames);
    if (!everything) return everything.error();
    findings.rooms = {*by_view, *portals, *everything};
    return Done{};
}

Status measure_orders(bool quick, Findings& findings) {
    const auto town = scene_of("city", "buildings", 120.0);
    if (!town) return town.error();
    const auto buffers = compare_buffers(*town);
    if (!buffers) return buffers.error();
    findings.buffers = *buffers;
    const int frames = quick ? 4 : 12;
    const auto grouped = time_frames(*town, {}, "grouped", frames);
    if (!grouped) return grouped.error();
    findings.orders.push_back(*grouped);
    for (std::size_t s = 0; s < sorting_strategy_names().size(); ++s) {
        const DrawOrder order{false, static_cast<SortingStrategy>(s)};
        const auto timing = time_frames(*town, {}, sorting_strategy_names()[s], frames, order);
        if (!timing) return timing.error();
        findings.orders.push_back(*timing);
    }
    return Done{};
}

/// Every recording in the folder, and the built-in walk.
std::vector<std::string> trace_names(const std::filesystem::path& data, bool quick) {
    std::vector<std::string> names{"walk"};
    std::error_code none;
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator{data / "head_traces", none}) {
        const std::string extension = entry.path().extension().string();
        if (entry.is_regular_file() && (extension == ".csv" || extension == ".txt" || extension == ".bag")) {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    if (quick && files.size() > 2) files.resize(2);
    names.insert(names.end(), files.begin(), files.end());
    return names;
}

Status check_all(const Options& options, Findings& findings) {
    const auto town = scene_of("city", "buildings", options.quick ? 60.0 : 200.0);
    if (!town) return town.error();
    const auto rooms = scene_of("rooms", "rooms", 120.0);
    if (!rooms) return rooms.error();
    const auto walk = load_trace("walk");
    if (!walk) return walk.error();
    for (const double margin_m : {0.0, 0.05, 0.15, 0.3, 0.6}) {
        const auto check = check_reveal(*town, *walk, options.quick ? 2 : 3, 2.3, margin_m);
        if (!check) return check.error();
        findings.checks.push_back(*check);
    }
    const std::vector<std::string> names = trace_names(options.data, options.quick);
    Progress progress{"bench skip, reveal checks", names.size(), options.quiet};
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto trace = load_trace(names[i]);
        progress.show(i + 1);
        if (!trace) continue;  // not a trace: its README, say
        // Places in the town and in the rooms in turn: the recordings are many.
        const auto check = check_reveal(i % 2 == 0 ? *town : *rooms, *trace, 1, 3.1, std::nullopt);
        if (!check) return check.error();
        findings.checks.push_back(*check);
    }
    return Done{};
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

struct Totals {
    double recall = 0.0;
    double wrongly_skipped = 0.0;
};

Totals totals_of(const std::vector<RevealCheck>& checks) {
    double hidden = 0.0;
    double skipped = 0.0;
    Totals totals;
    for (const RevealCheck& check : checks) {
        hidden += static_cast<double>(check.hidden);
        skipped += static_cast<double>(check.skipped_hidden);
        totals.wrongly_skipped += static_cast<double>(check.wrongly_skipped);
    }
    totals.recall = ratio(skipped, hidden);
    return totals;
}

void add_frames(Report& report, const std::string& path, const std::vector<FrameTiming>& timings) {
    for (const FrameTiming& timing : timings) {
        Report entry;
        entry.set("label", timing.label);
        entry.set("objects", timing.objects);
        entry.set("triangles", timing.triangles);
        entry.set("objects_drawn", timing.objects_drawn);
        entry.set("triangles_drawn", timing.triangles_drawn);
        entry.set("draw_calls", timing.draw_calls);
        entry.set("frame_ms", timing.frame_ms);
        entry.set("culling_ms", timing.culling_ms.p50);
        entry.set("culling_p99_ms", timing.culling_ms.p99);
        report.append(path, entry);
    }
}

void add_buffer(Report& report, const BufferChanges& buffer) {
    Report entry;
    entry.set("capacity", static_cast<std::uint64_t>(buffer.capacity));
    entry.set("draws", static_cast<std::uint64_t>(buffer.draws));
    entry.set("states", static_cast<std::uint64_t>(buffer.states));
    entry.set("piece_draws", static_cast<std::uint64_t>(buffer.piece_draws));
    for (std::size_t s = 0; s < buffer.changes.size(); ++s) {
        const std::string& name = sorting_strategy_names()[s];
        entry.set("changes/" + name, static_cast<std::uint64_t>(buffer.changes[s]));
        entry.set("piece_changes/" + name, static_cast<std::uint64_t>(buffer.piece_changes[s]));
    }
    if (buffer.piece_fewest > 0) entry.set("piece_changes/fewest", static_cast<std::uint64_t>(buffer.piece_fewest));
    report.append("sorting_buffer", entry);
}

/// Objects from which on the hierarchy is faster at every larger count measured.
double cross_over(const std::vector<FrustumTiming>& timings) {
    double from = 0.0;
    for (auto timing = timings.rbegin(); timing != timings.rend(); ++timing) {
        if (timing->hierarchical_ns > timing->linear_ns) break;
        from = static_cast<double>(timing->objects);
    }
    return from;
}

void describe_findings(Report& report, const Findings& findings) {
    report.set("skip/frame_speedup_20k", ratio(findings.town[0].frame_ms, findings.town[1].frame_ms));
    report.set("skip/culling_ms", findings.town[1].culling_ms.p50);
    report.set("skip/culling_one_thread_ms", findings.town[2].culling_ms.p50);
    const Totals totals = totals_of(findings.checks);
    report.set("skip/occlusion_recall", totals.recall);
    report.set("skip/wrongly_skipped", totals.wrongly_skipped);
    const FrustumTiming& largest = findings.frustum.back();
    report.set("skip/frustum_ns_per_object/linear", largest.linear_ns);
    report.set("skip/frustum_ns_per_object/hierarchical", largest.hierarchical_ns);
    report.set("skip/frustum_ns_per_object/read_only", largest.read_ns);
    report.set("skip/frustum_cross_over_objects", cross_over(findings.frustum));
    report.set("skip/rooms_triangles_ratio", ratio(static_cast<double>(findings.rooms[0].triangles_drawn),
                                                   static_cast<double>(findings.rooms[1].triangles_drawn)));
    report.set("skip/rooms_speedup", ratio(findings.rooms[0].frame_ms, findings.rooms[1].frame_ms));
    add_frames(report, "town", findings.town);
    add_frames(report, "default_town", findings.parts);
    add_frames(report, "rooms", findings.rooms);
    for (const FrustumTiming& timing : findings.frustum) {
        Report entry;
        entry.set("objects", static_cast<std::uint64_t>(timing.objects));
        entry.set("seen_fraction", timing.seen_fraction);
        entry.set("linear_ns", timing.linear_ns);
        entry.set("hierarchical_ns", timing.hierarchical_ns);
        entry.set("read_only_ns", timing.read_ns);
        entry.set("six_at_once_ns", timing.several_ns);
        entry.set("six_one_by_one_ns", timing.one_by_one_ns);
        report.append("frustum", entry);
    }
    add_frames(report, "draw_orders", findings.orders);
    for (const BufferChanges& buffer : findings.buffers) add_buffer(report, buffer);
    for (const RevealCheck& check : findings.checks) {
        Report entry;
        entry.set("scene", check.scene);
        entry.set("trace", check.trace);
        entry.set("margin_m", check.margin_m);
        entry.set("views", check.views);
        entry.set("objects_in_view", check.in_view);
        entry.set("hidden", check.hidden);
        entry.set("skipped", check.skipped_hidden);
        entry.set("wrongly_skipped", check.wrongly_skipped);
        report.append("reveal_checks", entry);
    }
}

SvgPlot frustum_plot(const Findings& findings) {
    SvgPlot plot{"Frustum test by number of objects", "objects", "ns per object"};
    plot.log_x = true;
    plot.log_y = true;
    SvgSeries linear{"list", {}, {}};
    SvgSeries tree{"hierarchy", {}, {}};
    SvgSeries read{"reading the list's bytes", {}, {}, SvgMarks::line, true};
    for (const FrustumTiming& timing : findings.frustum) {
        const auto objects = static_cast<double>(timing.objects);
        for (SvgSeries* series : {&linear, &tree, &read}) series->x.push_back(objects);
        linear.y.push_back(timing.linear_ns);
        tree.y.push_back(timing.hierarchical_ns);
        read.y.push_back(timing.read_ns);
    }
    plot.series = {linear, tree, read};
    return plot;
}

SvgPlot buffer_plot(const Findings& findings) {
    SvgPlot plot{"Changes of state by size of the sorting buffer", "draws in the buffer", "changes of state"};
    plot.log_x = true;
    plot.log_y = true;
    for (std::size_t s = 1; s < sorting_strategy_names().size(); ++s) {
        SvgSeries series{sorting_strategy_names()[s], {}, {}};
        for (const BufferChanges& buffer : findings.buffers) {
            series.x.push_back(static_cast<double>(buffer.capacity));
            series.y.push_back(static_cast<double>(buffer.changes[s]));
        }
        plot.series.push_back(series);
    }
    return plot;
}

SvgPlot recall_plot(const Findings& findings) {
    SvgPlot plot{"Hidden objects that are skipped, by reveal margin", "margin, m", "share"};
    plot.y_from_zero = true;
    SvgSeries walk{"town, walking", {}, {}};
    for (const RevealCheck& check : findings.checks) {
        if (walk.x.size() == 5) break;
        walk.x.push_back(check.margin_m);
        walk.y.push_back(ratio(static_cast<double>(check.skipped_hidden), static_cast<double>(check.hidden)));
    }
    plot.series = {walk};
    return plot;
}

std::vector<std::vector<std::string>> frame_table(const std::vector<FrameTiming>& timings) {
    std::vector<std::vector<std::string>> rows{
        {"", "objects drawn", "of", "triangles drawn", "of", "draw calls", "frame, ms", "culling, ms", "p99"}};
    for (const FrameTiming& timing : timings) {
        rows.push_back({timing.label, fmt::format("{}", timing.objects_drawn), fmt::format("{}", timing.objects),
                        fmt::format("{}", timing.triangles_drawn), fmt::format("{}", timing.triangles),
                        fmt::format("{}", timing.draw_calls), short_number(timing.frame_ms),
                        short_number(timing.culling_ms.p50), short_number(timing.culling_ms.p99)});
    }
    return rows;
}

HtmlReport page_of(const Findings& findings, const std::vector<std::pair<std::string, SvgPlot>>& plots,
                   const std::string& machine) {
    HtmlReport page{"Latewarp bench: skip"};
    page.add_paragraph(machine);
    page.add_heading("A town of 20,000 buildings, from the street, 1024x1024");
    page.add_table(frame_table(findings.town));
    page.add_heading("The default town");
    page.add_table(frame_table(findings.parts));
    page.add_heading("The default town, draws in different orders (the draw calls are changes of state)");
    page.add_table(frame_table(findings.orders));
    page.add_heading("Rooms");
    page.add_table(frame_table(findings.rooms));
    for (const auto& [name, plot] : plots) page.add_plot(plot);
    page.add_heading("Hidden objects against all eyes within the margin");
    std::vector<std::vector<std::string>> rows{
        {"scene, trace", "margin, m", "in view", "hidden", "skipped", "wrongly"}};
    for (const RevealCheck& check : findings.checks) {
        rows.push_back({check.scene + ", " + check.trace, short_number(check.margin_m),
                        fmt::format("{}", check.in_view), fmt::format("{}", check.hidden),
                        fmt::format("{}", check.skipped_hidden), fmt::format("{}", check.wrongly_skipped)});
    }
    page.add_table(rows);
    return page;
}

std::string csv_of(const Findings& findings) {
    std::string csv = "objects,seen_fraction,linear_ns,hierarchical_ns,read_only_ns,six_at_once_ns,six_one_by_one_ns\n";
    for (const FrustumTiming& t : findings.frustum) {
        csv += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", t.objects, t.seen_fraction, t.linear_ns,
                           t.hierarchical_ns, t.read_ns, t.several_ns, t.one_by_one_ns);
    }
    return csv;
}

std::string summary_of(const Findings& findings) {
    const Totals totals = totals_of(findings.checks);
    const FrustumTiming& largest = findings.frustum.back();
    std::string text;
    for (const auto* timings : {&findings.town, &findings.parts, &findings.orders, &findings.rooms}) {
        for (const FrameTiming& t : *timings) {
            text += fmt::format("{:<34} {:>9.1f} ms, culling {:>6.2f} ms, {:>9} triangles, {:>7} of {} objects\n",
                                t.label, t.frame_ms, t.culling_ms.p50, t.triangles_drawn, t.objects_drawn, t.objects);
        }
    }
    text += fmt::format("frustum, {} objects: list {:.2f} ns, hierarchy {:.3f} ns, reading {:.2f} ns; cross-over {}\n",
                        largest.objects, largest.linear_ns, largest.hierarchical_ns, largest.read_ns,
                        cross_over(findings.frustum));
    return text + fmt::format("hidden objects skipped: {:.1f} %, wrongly: {}\n", 100.0 * totals.recall,
                              totals.wrongly_skipped);
}

}  // namespace

Result<BenchOutput> bench_skip(const Options& options) {
    auto context = gl::Context::create();
    if (!context) return context.error();
    (*context)->make_current();
    Findings findings;
    for (std::size_t objects = 64; objects <= 524288; objects *= options.quick ? 8 : 2) {
        findings.frustum.push_back(time_frustum(objects));
    }
    if (findings.frustum.back().objects != 524288) findings.frustum.push_back(time_frustum(524288));
    if (Status done = measure_parts(options.quick, findings); !done) return done.error();
    if (Status done = measure_orders(options.quick, findings); !done) return done.error();
    if (Status done = measure_rooms(options.quick, findings); !done) return done.error();
    if (Status done = check_all(options, findings); !done) return done.error();
    if (Status done = measure_town(options.quick, findings); !done) return done.error();

    BenchOutput output;
    const Machine machine = this_machine();
    describe_machine(output.report, machine);
    describe_findings(output.report, findings);
    output.plots = {{"frustum", frustum_plot(findings)},
                    {"recall", recall_plot(findings)},
                    {"sorting_buffer", buffer_plot(findings)}};
    output.csv = csv_of(findings);
    output.page = page_of(findings, output.plots, text_of(machine));
    output.summary = summary_of(findings);
    return output;
}

}  // namespace lw
