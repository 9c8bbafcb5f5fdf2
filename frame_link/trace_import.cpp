#include <array>
#include <filesystem>

#include "core/image_io.h"
#include "frame_link/built_in_traces.h"
#include "frame_link/trace_formats.h"

namespace lw {
namespace {

// A day of 1 kHz samples in our own CSV is below this; more is a mistake or an attack.
constexpr std::uint64_t kMaxTraceBytes = std::uint64_t{1} << 30;

constexpr std::array<TraceFormat, 6> kFormats{{
    {"latewarp CSV", is_latewarp_trace, read_latewarp_trace},
    {"EyeNavGS CSV", is_eyenavgs_trace, read_eyenavgs_trace},
    {"Questset CSV", is_questset_trace, read_questset_trace},
    {"Unity log", is_unity_trace, read_unity_trace},
    {"ROS 1 bag", is_rosbag_trace, read_rosbag_trace},
    {"PoseStamped CSV", is_pose_stamped_csv_trace, read_pose_stamped_csv_trace},
}};

template <class Names>
std::string joined(const Names& names) {
    std::string text;
    for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string{name};
    return text;
}

std::string format_names() {
    std::vector<std::string_view> names;
    names.reserve(kFormats.size());
    for (const TraceFormat& format : kFormats) names.push_back(format.name);
    return joined(names);
}

}  // namespace

std::span<const TraceFormat> trace_formats() { return kFormats; }

Result<Trace> load_trace(const std::string& name_or_path) {
    if (auto trace = built_in_trace(name_or_path)) return std::move(*trace);
    std::error_code ignored;
    if (!std::filesystem::exists(name_or_path, ignored)) {
        return Error{"no such trace", name_or_path, "give a file or one of " + joined(built_in_trace_names())};
    }
    const auto bytes = read_file(name_or_path, kMaxTraceBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Error{"the trace file is empty", name_or_path, "give a recording"};
    const TraceFile file{name_or_path, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}};
    for (const TraceFormat& format : kFormats) {
        if (format.recognises(file.text)) return format.read(file);
    }
    return Error{"not a head trace in a known format", name_or_path, "known are " + format_names()};
}

}  // namespace lw
