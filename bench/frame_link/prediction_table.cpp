/// Prints how far each predictor is from what recorded heads did, as the tables of docs/latency.md.
/// Usage: lw_bench_frame_link TRACE...

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "frame_link/prediction_error.h"
#include "frame_link/trace.h"

namespace {

using namespace std::chrono_literals;
using lw::Duration;

constexpr double kTracker_hz = 1000.0;
constexpr std::array<Duration, 8> kHorizons{5ms, 10ms, 15ms, 25ms, 40ms, 60ms, 80ms, 100ms};
constexpr std::size_t kDetailed = 3;  // 25 ms
constexpr std::array<std::string_view, 5> kPredictors{"none", "constant-velocity", "double-exponential", "kalman",
                                                      "adaptive"};

struct Row {
    std::string trace;
    std::size_t stops = 0;
    std::array<std::vector<lw::PredictionError>, kPredictors.size()> errors;
};

Row measure(const lw::Trace& trace) {
    const lw::TraceFeed feed{trace, lw::TimePoint{}, kTracker_hz};
    const lw::TimePoint end = lw::at_seconds(trace.duration_s());
    Row row;
    row.trace = std::filesystem::path{trace.name()}.stem().string();
    row.stops = lw::stops_of(feed, lw::TimePoint{}, end).size();
    for (std::size_t i = 0; i < kPredictors.size(); ++i) {
        const auto predictor = *lw::make_predictor(kPredictors[i]);
        row.errors[i] = lw::prediction_errors(*predictor, feed, feed, lw::TimePoint{}, end, kHorizons);
    }
    return row;
}

std::string three(const lw::Distribution& d) { return fmt::format("{:.2f} / {:.2f} / {:.1f}", d.p50, d.p95, d.max); }

template <class Cell>
void print_table(const char* title, const std::vector<Row>& rows, Cell cell) {
    fmt::print("{}\n\n| trace |", title);
    for (const auto name : kPredictors) fmt::print(" `{}` |", name);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < kPredictors.size(); ++i) fmt::print("---|");
    fmt::print("\n");
    for (const Row& row : rows) {
        fmt::print("| {} |", row.trace);
        for (const auto& errors : row.errors) fmt::print(" {} |", cell(row, errors));
        fmt::print("\n");
    }
    fmt::print("\n");
}

/// By horizon: the mean over the traces of p95, as a share of what no prediction has.
void print_horizons(const std::vector<Row>& rows, const char* title, lw::Distribution lw::PredictionError::*what) {
    fmt::print("{}\n\n| horizon |", title);
    for (const auto name : kPredictors) fmt::print(" `{}` |", name);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < kPredictors.size(); ++i) fmt::print("---|");
    fmt::print("\n");
    for (std::size_t h = 0; h < kHorizons.size(); ++h) {
        fmt::print("| {:.0f} ms |", lw::to_ms(kHorizons[h]));
        for (std::size_t p = 0; p < kPredictors.size(); ++p) {
            double sum = 0.0;
            for (const Row& row : rows) sum += (row.errors[p][h].*what).p95 / (row.errors[0][h].*what).p95;
            fmt::print(" {:.2f} |", sum / static_cast<double>(rows.size()));
        }
        fmt::print("\n");
    }
    fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<Row> rows;
    for (int i = 1; i < argc; ++i) {
        const auto trace = lw::load_trace(argv[i]);
        if (!trace) {
            fmt::print(stderr, "{}\n", trace.error().message());
            return 1;
        }
        rows.push_back(measure(*trace));
    }
    if (rows.empty()) {
        fmt::print(stderr, "usage: lw_bench_frame_link TRACE...\n");
        return 2;
    }
    print_horizons(rows, "Angle, p95 as a share of `none`'s, mean over the traces:", &lw::PredictionError::turn_deg);
    print_horizons(rows, "Position, p95 as a share of `none`'s, mean over the traces:", &lw::PredictionError::move_mm);
    print_table("Angle at 25 ms, degrees, p50 / p95 / max:", rows,
                [](const Row&, const auto& errors) { return three(errors[kDetailed].turn_deg); });
    print_table("Position at 25 ms, millimetres, p50 / p95 / max:", rows,
                [](const Row&, const auto& errors) { return three(errors[kDetailed].move_mm); });
    print_table("Angle at 25 ms in the 200 ms after a stop, degrees, p95 / max (stops):", rows,
                [](const Row& row, const auto& errors) {
                    const auto& after = errors[kDetailed].turn_after_stop_deg;
                    return after ? fmt::format("{:.2f} / {:.2f} ({})", after->p95, after->max, row.stops)
                                 : std::string{"-"};
                });
    return 0;
}
