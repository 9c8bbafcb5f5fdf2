#include <array>

#include "frame_link/trace_formats.h"
#include "frame_link/trace_rows.h"

namespace lw {
namespace {

constexpr std::size_t kColumns = 16;   // ticks local, ticks UTC, year .. ms, x, y, z, qx, qy, qz, qw
constexpr std::size_t kUtcColumn = 1;  // local ticks jump when daylight saving begins
constexpr std::size_t kPoseColumn = 9;
constexpr double kTicks_per_s = 1e7;
// Ticks of 100 ns since the year 1: these are the years 1600 and 2900, which tells such a log from any other numbers.
constexpr std::int64_t kFirstTick = 504'000'000'000'000'000;
constexpr std::int64_t kLastTick = 914'000'000'000'000'000;

std::optional<std::int64_t> utc_ticks(const CsvReader& csv) {
    if (csv.fields().size() != kColumns) return std::nullopt;
    const auto ticks = parse_integer(csv.fields()[kUtcColumn]);
    if (!ticks || *ticks < kFirstTick || *ticks > kLastTick) return std::nullopt;
    return ticks;
}

// Unity's axes are left-handed: +X right, +Y up, +Z forward. Mirroring z makes them ours; an axis of rotation, which a
// mirror turns the other way round, keeps its z and negates x and y.
Pose right_handed(const std::array<double, 7>& v) { return {{v[0], v[1], -v[2]}, {v[6], -v[3], -v[4], v[5]}}; }

}  // namespace

bool is_unity_trace(std::string_view text) {
    CsvReader csv{text.substr(0, 4096)};
    return csv.next() && utc_ticks(csv).has_value();
}

Result<Trace> read_unity_trace(const TraceFile& file) {
    CsvReader csv{file.text};
    TraceRows rows;
    std::optional<std::int64_t> first_ticks;
    read_csv_rows(csv, rows, [&] {
        const auto ticks = utc_ticks(csv);
        if (!ticks) return false;
        std::array<double, 7> v{};
        for (std::size_t i = 0; i < v.size(); ++i) {
            const auto number = csv.number(kPoseColumn + i);
            if (!number) return false;
            v[i] = *number;
        }
        if (!first_ticks) first_ticks = ticks;
        rows.add(static_cast<double>(*ticks - *first_ticks) / kTicks_per_s, right_handed(v));
        return true;
    });
    return rows.finish(file.name(), file.where());
}

}  // namespace lw
