#include <array>
#include <iterator>
#include <span>

#include "core/image_io.h"
#include "frame_link/trace_formats.h"
#include "frame_link/trace_rows.h"

namespace lw {
namespace {

constexpr std::string_view kHeader = "time_s,px_m,py_m,pz_m,qx,qy,qz,qw";
constexpr std::size_t kColumns = 8;

bool read_row(const CsvReader& csv, TraceRows& rows) {
    if (csv.fields().size() != kColumns) return false;
    std::array<double, kColumns> v{};
    for (std::size_t i = 0; i < kColumns; ++i) {
        const auto number = csv.number(i);
        if (!number) return false;
        v[i] = *number;
    }
    rows.add(v[0], Pose{{v[1], v[2], v[3]}, {v[7], v[4], v[5], v[6]}});
    return true;
}

}  // namespace

bool is_latewarp_trace(std::string_view text) {
    return without_byte_order_mark(text).substr(0, kHeader.size()) == kHeader;
}

Result<Trace> read_latewarp_trace(const TraceFile& file) {
    CsvReader csv{file.text};
    TraceRows rows;
    csv.next();  // the header
    read_csv_rows(csv, rows, [&] { return read_row(csv, rows); });
    return rows.finish(file.name(), file.where());
}

Status save_trace(const Trace& trace, const std::filesystem::path& path) {
    std::string text{kHeader};
    text += '\n';
    for (const TimedPose& pose : trace.poses()) {
        const glm::dvec3& p = pose.world_from_head.position_m;
        const glm::dquat& q = pose.world_from_head.orientation;
        // {} prints the shortest digits that read back as the same double.
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", pose.time_s, p.x, p.y, p.z, q.x, q.y, q.z,
                       q.w);
    }
    return write_file_atomically(path, std::as_bytes(std::span{text}));
}

}  // namespace lw
