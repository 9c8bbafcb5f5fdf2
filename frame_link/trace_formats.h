#pragma once
/// The recorded formats, one reader each. docs/formats.md describes them; load_trace() tells them apart.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"
#include "frame_link/trace.h"

namespace lw {

/// A trace file in memory.
struct TraceFile {
    std::filesystem::path path;
    std::string_view text;  ///< the whole file, whatever it is

    [[nodiscard]] std::string name() const { return path.filename().string(); }
    [[nodiscard]] std::string where() const { return path.string(); }
};

/// One format: does the file look like it, and read it. Both pure but for read_eyenavgs_trace(), which looks for
/// scene_setting.csv near the file.
struct TraceFormat {
    std::string_view name;
    bool (*recognises)(std::string_view text);
    Result<Trace> (*read)(const TraceFile& file);
};

/// Every format, in the order they are tried.
[[nodiscard]] std::span<const TraceFormat> trace_formats();

// The project's own CSV: time_s,px_m,py_m,pz_m,qx,qy,qz,qw.
[[nodiscard]] bool is_latewarp_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_latewarp_trace(const TraceFile& file);

// EyeNavGS: one row per eye, in the tilted and scaled world of a Gaussian-splat scene.
[[nodiscard]] bool is_eyenavgs_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_eyenavgs_trace(const TraceFile& file);

// Questset: head and both controllers, quaternions w first.
[[nodiscard]] bool is_questset_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_questset_trace(const TraceFile& file);

// Sixteen columns without a header, logged by a Unity program: left-handed.
[[nodiscard]] bool is_unity_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_unity_trace(const TraceFile& file);

// ROS 1 bag with PoseStamped messages, and their plain extraction t_s,x,y,z,qx,qy,qz,qw.
[[nodiscard]] bool is_rosbag_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_rosbag_trace(const TraceFile& file);
[[nodiscard]] bool is_pose_stamped_csv_trace(std::string_view text);
[[nodiscard]] Result<Trace> read_pose_stamped_csv_trace(const TraceFile& file);

}  // namespace lw
