#include "apps/shell_report.h"

#include <algorithm>
#include <map>

#include "apps/svg_plot.h"
#include "core/statistics.h"

namespace lw {
namespace {

std::span<const ShellFrameRecord> after_warm_up(const std::vector<ShellFrameRecord>& records) {
    const std::span<const ShellFrameRecord> all{records};
    return all.size() > 1 ? all.subspan(1) : all;
}

}  // namespace

void describe_shells(Report& report, const std::vector<ShellFrameRecord>& records) {
    std::vector<double> drawn;
    std::vector<double> fraction;
    std::vector<double> invalid;
    std::vector<double> spent;
    std::vector<double> budget;
    double over = 0.0;
    double idle = 0.0;
    const std::span<const ShellFrameRecord> counted = after_warm_up(records);
    for (const ShellFrameRecord& record : counted) {
        drawn.push_back(static_cast<double>(record.draws.size()));
        fraction.push_back(record.all_ms > 0.0 ? record.spent_ms / record.all_ms : 0.0);
        invalid.push_back(record.invalid);
        spent.push_back(record.spent_ms);
        budget.push_back(record.budget_ms);
        over += record.spent_ms > record.budget_ms ? 1.0 : 0.0;
        idle += record.draws.empty() ? 1.0 : 0.0;
    }
    const double frames = std::max<double>(static_cast<double>(counted.size()), 1.0);
    report.set("shells/items_drawn", distribution_of(drawn));
    report.set("shells/redraw_fraction", distribution_of(fraction));
    report.set("shells/invalid_items", distribution_of(invalid));
    report.set("shells/spent_ms", distribution_of(spent));
    report.set("shells/budget_ms", distribution_of(budget));
    report.set("shells/frames_over_budget", over / frames);
    report.set("shells/frames_without_redraw", idle / frames);
}

std::string shell_timeline_csv(const std::vector<ShellFrameRecord>& records) {
    std::string csv = "frame,time_s,item,reason,error_px,cost_ms,age_s,budget_ms\n";
    for (std::size_t i = 0; i < records.size(); ++i) {
        const ShellFrameRecord& record = records[i];
        if (record.draws.empty()) csv += fmt::format("{},{},,,,,,{}\n", i, record.now_s, record.budget_ms);
        for (const ShellDraw& draw : record.draws) {
            csv += fmt::format("{},{},{},{},{},{},{},{}\n", i, record.now_s, draw.name, draw.reason, draw.error_px,
                               draw.cost_ms, draw.age_s, record.budget_ms);
        }
    }
    return csv;
}

std::string shell_timeline_svg(const std::vector<ShellFrameRecord>& records) {
    SvgPlot plot{"What was drawn when, and why", "time, s", "item (0: the view, then tiles shell by shell)"};
    std::map<std::string, SvgSeries> by_reason;
    for (const ShellFrameRecord& record : after_warm_up(records)) {
        for (const ShellDraw& draw : record.draws) {
            SvgSeries& series = by_reason[draw.reason];
            series.label = draw.reason;
            series.marks = SvgMarks::points;
            series.x.push_back(record.now_s);
            series.y.push_back(draw.item);
        }
    }
    for (auto& [reason, series] : by_reason) plot.series.push_back(std::move(series));
    return svg_of(plot, SvgUse::standalone);
}

}  // namespace lw
