#pragma once
/// Head traces: recorded or scripted poses over time, in the project's own CSV or in the formats of the public
/// recordings (frame_link/trace_import.cpp lists them with their axes and units).

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "frame_link/feeds.h"

namespace lw {

struct TimedPose {
    double time_s = 0.0;
    Pose world_from_head;
};

/// A trace with strictly increasing times, unit quaternions, right-handed +Y up metres, looking along -Z.
class Trace {
public:
    /// `poses` is not empty, sanitised, and strictly increasing in time (programmer error otherwise).
    explicit Trace(std::string name, std::vector<TimedPose> poses, std::vector<std::string> warnings = {});

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::vector<TimedPose>& poses() const { return poses_; }
    [[nodiscard]] double duration_s() const { return poses_.back().time_s - poses_.front().time_s; }
    /// What the importer mended or passed over, one line each.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

    /// Interpolated on the sphere; the first and last pose hold outside. `time_s` counts from the first sample.
    [[nodiscard]] Pose at(double time_s) const;

    /// The trace as it plays from `start`: applied relative to its first sample in yaw and position, cut to begin at
    /// `skip_s` (which is then the new first sample). Pitch and roll stay as recorded.
    [[nodiscard]] Trace placed_at(const Pose& start, double skip_s) const;

private:
    std::string name_;
    std::vector<TimedPose> poses_;
    std::vector<std::string> warnings_;
};

/// Built-in names: still, look-around, walk, shake. Deterministic.
[[nodiscard]] std::vector<std::string_view> built_in_trace_names();

/// A built-in name or a file in any known format, told apart by its content.
[[nodiscard]] Result<Trace> load_trace(const std::string& name_or_path);

/// Writes the project's own CSV (time_s,px_m,py_m,pz_m,qx,qy,qz,qw).
[[nodiscard]] Status save_trace(const Trace& trace, const std::filesystem::path& path);

/// Plays a trace as a tracker with `rate_hz` samples per second: sample k is stamped start + k / rate_hz. Immutable,
/// any thread.
class TraceFeed final : public ForeseeingHeadPoseFeed {
public:
    TraceFeed(Trace trace, TimePoint start, double rate_hz);

    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override;
    [[nodiscard]] Pose pose_at(TimePoint time) const override;

private:
    Trace trace_;
    TimePoint start_;
    double rate_hz_;
};

}  // namespace lw
