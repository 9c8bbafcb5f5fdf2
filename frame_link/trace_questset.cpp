#include "frame_link/trace_formats.h"
#include "frame_link/trace_rows.h"

namespace lw {
namespace {

// By name, since the log also carries buttons and controllers. +X right, +Y up, +Z backward: our own axes.
std::optional<std::vector<std::size_t>> head_columns(const CsvReader& csv) {
    return csv.columns({"time", "HeadPosX", "HeadPosY", "HeadPosZ", "HeadOrientationW", "HeadOrientationX",
                        "HeadOrientationY", "HeadOrientationZ"});
}

}  // namespace

bool is_questset_trace(std::string_view text) {
    CsvReader csv{text.substr(0, 4096)};  // a header line is below 1 KB
    return csv.next() && head_columns(csv).has_value();
}

Result<Trace> read_questset_trace(const TraceFile& file) {
    CsvReader csv{file.text};
    csv.next();
    const auto columns = *head_columns(csv);
    TraceRows rows;
    std::vector<double> v(columns.size());
    read_csv_rows(csv, rows, [&] {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const auto number = csv.number(columns[i]);
            if (!number) return false;
            v[i] = *number;
        }
        rows.add(v[0], Pose{{v[1], v[2], v[3]}, {v[4], v[5], v[6], v[7]}});
        return true;
    });
    return rows.finish(file.name(), file.where());
}

}  // namespace lw
