#pragma once
/// Head traces: recorded or scripted poses over time, in the project's own CSV or in the formats of the public
/// recordings (docs/formats.md lists them with their axes and units).

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
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
    /// `poses` is not empty, sanitised, finite and strictly increasing in time (programmer error otherwise).
    explicit Trace(std::string name, std::vector<TimedPose> poses, std::vector<std::string> warnings = {});

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::vector<TimedPose>& poses() const { return poses_; }
    [[nodiscard]] double duration_s() const { return poses_.back().time_s - poses_.front().time_s; }
    /// What the importer mended or passed over, one line each.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

    /// What each eye of the recorded headset sees, left and right; nothing where the recording does not say.
    [[nodiscard]] const std::optional<std::array<FovTangents, 2>>& eye_fovs() const { return eye_fovs_; }
    void set_eye_fovs(const std::array<FovTangents, 2>& fovs) { eye_fovs_ = fovs; }

    /// Interpolated on the sphere; the first and last pose hold outside. `time_s` counts from the first sample, whose
    /// own stamp may be anything. O(log n), no allocation.
    [[nodiscard]] Pose at(double time_s) const;

    /// The trace as it plays from `start`: applied relative to its first sample in yaw and position, cut to begin at
    /// `skip_s` (which is then the new first sample, at time 0; skipping past the end leaves the last pose). Pitch and
    /// roll stay as recorded, those of `start` do not matter. A head that looks within 10 degrees of straight up or
    /// down has the heading of its crown or chin, so a trace may begin there.
    [[nodiscard]] Trace placed_at(const Pose& start, double skip_s) const;

private:
    std::string name_;
    std::vector<TimedPose> poses_;
    std::vector<std::string> warnings_;
    std::optional<std::array<FovTangents, 2>> eye_fovs_;
};

/// Built-in names: still, look-around, walk, shake, dive. One minute each, deterministic, from (0, 1.6, 0) along -Z.
[[nodiscard]] std::vector<std::string_view> built_in_trace_names();

/// Heading of a pose: the yaw about +Y (radians, in (-pi, pi], 0 looks along -Z, positive to the left) of where it
/// looks; near straight up or down, of its crown or chin. Pure, any thread.
[[nodiscard]] double heading_rad(const glm::dquat& orientation);

/// A built-in name or a file in any known format, told apart by its content. What could be mended is in the trace's
/// warnings; a file that is none of the formats, or more than half bad, is an error.
[[nodiscard]] Result<Trace> load_trace(const std::string& name_or_path);

/// Writes the project's own CSV (time_s,px_m,py_m,pz_m,qx,qy,qz,qw).
[[nodiscard]] Status save_trace(const Trace& trace, const std::filesystem::path& path);

/// Plays a trace as a tracker with `rate_hz` samples per second: sample k is stamped start + k / rate_hz, rounded to
/// the nanosecond, and numbered k + 1. It goes on after the trace's end, with the last pose. Immutable, any thread.
class TraceFeed final : public ForeseeingHeadPoseFeed {
public:
    /// 0 < rate_hz <= 1e6. `start` is when the trace's first pose is measured.
    TraceFeed(Trace trace, TimePoint start, double rate_hz);

    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override;
    [[nodiscard]] Pose pose_at(TimePoint time) const override;

private:
    [[nodiscard]] Duration since_start(std::int64_t k) const;

    Trace trace_;
    TimePoint start_;
    double rate_hz_;
};

}  // namespace lw
