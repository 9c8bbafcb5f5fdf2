#include <array>
#include <cmath>

#include "core/image_io.h"
#include "frame_link/eyenavgs_scene.h"
#include "frame_link/trace_formats.h"
#include "frame_link/trace_rows.h"

namespace lw {
namespace {

struct EyeRow {
    int view = 0;  ///< 0 left, 1 right
    double time_ms = 0.0;
    Pose scene_from_eye;  ///< in scene units
    std::optional<FovTangents> fov;
};

// The right eye of a frame is logged 3-5 ms after the left one, in a hiccup up to 36 ms. Both rows of a frame carry the
// same orientation, digit for digit, because both come from one tracked pose.
constexpr double kMaxEyeDelay_ms = 100.0;

bool are_of_one_frame(const EyeRow& left, const EyeRow& right) {
    const double delay_ms = right.time_ms - left.time_ms;
    return delay_ms >= 0.0 && delay_ms <= kMaxEyeDelay_ms &&
           left.scene_from_eye.orientation == right.scene_from_eye.orientation;
}

std::optional<std::vector<std::size_t>> eye_columns(const CsvReader& csv) {
    return csv.columns({"ViewIndex", "Timestamp", "PositionX", "PositionY", "PositionZ", "QuaternionX", "QuaternionY",
                        "QuaternionZ", "QuaternionW"});
}

std::optional<std::vector<std::size_t>> fov_columns(const CsvReader& csv) {
    return csv.columns({"FOV1", "FOV2", "FOV3", "FOV4"});
}

// Signed angles to the left, right, bottom and top edge, radians. (The data set's own description calls the third one
// top; by its sign, and by headsets' larger field below, it is the bottom.)
std::optional<FovTangents> parse_fov(const CsvReader& csv, const std::optional<std::vector<std::size_t>>& columns) {
    if (!columns) return std::nullopt;
    constexpr double kWidest_rad = 1.48;
    std::array<double, 4> tangents{};
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const auto angle_rad = csv.number((*columns)[i]);
        if (!angle_rad || !(std::abs(*angle_rad) <= kWidest_rad)) return std::nullopt;
        tangents[i] = std::tan(*angle_rad);
    }
    const FovTangents fov{tangents[0], tangents[1], tangents[2], tangents[3]};
    if (!(fov.left < fov.right && fov.down < fov.up)) return std::nullopt;
    return fov;
}

std::optional<EyeRow> parse_row(const CsvReader& csv, const std::vector<std::size_t>& columns,
                                const std::optional<std::vector<std::size_t>>& fovs) {
    std::array<double, 9> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
        const auto number = csv.number(columns[i]);
        if (!number) return std::nullopt;
        v[i] = *number;
    }
    if (v[0] != 0.0 && v[0] != 1.0) return std::nullopt;
    return EyeRow{static_cast<int>(v[0]), v[1], Pose{{v[2], v[3], v[4]}, {v[8], v[5], v[6], v[7]}},
                  parse_fov(csv, fovs)};
}

// The head is in the middle of the eyes.
Pose scene_from_head(const EyeRow& left, const EyeRow& right) {
    return {0.5 * (left.scene_from_eye.position_m + right.scene_from_eye.position_m), left.scene_from_eye.orientation};
}

Pose placed_upright(const EyenavgsScene& scene, const Pose& pose) {
    return {scene.upright_from_scene * (pose.position_m / scene.units_per_m),
            scene.upright_from_scene * pose.orientation};
}

/// Puts the rows of both eyes together.
class EyePairs {
public:
    EyePairs(const EyenavgsScene& scene, TraceRows& rows) : scene_{scene}, rows_{rows} {}

    void add(const EyeRow& row) {
        if (row.view == 0) {
            end();
            left_ = row;
            has_left_ = true;
        } else if (has_left_ && are_of_one_frame(left_, row)) {
            has_left_ = false;
            if (!fovs_ && left_.fov && row.fov) fovs_ = {*left_.fov, *row.fov};
            rows_.add(left_.time_ms / 1e3, placed_upright(scene_, scene_from_head(left_, row)));
        } else {
            end();
            rows_.drop(kAlone);
        }
    }

    void end() {
        if (has_left_) rows_.drop(kAlone);
        has_left_ = false;
    }

    /// Of the first pair that says; a headset's does not change.
    [[nodiscard]] const std::optional<std::array<FovTangents, 2>>& fovs() const { return fovs_; }

private:
    static constexpr std::string_view kAlone = "one eye without the other";

    EyenavgsScene scene_;
    TraceRows& rows_;
    EyeRow left_;
    bool has_left_ = false;
    std::optional<std::array<FovTangents, 2>> fovs_;
};

EyenavgsScene scene_of(const TraceFile& file, TraceRows& rows) {
    const std::string name = eyenavgs_scene_name(file.path);
    const std::filesystem::path setting = find_scene_setting(file.path);
    if (!setting.empty()) {
        const auto bytes = read_file(setting, 1U << 20);
        const std::string_view text =
            bytes ? std::string_view{reinterpret_cast<const char*>(bytes->data()), bytes->size()} : std::string_view{};
        if (const auto scene = find_eyenavgs_scene(text, name)) return *scene;
    }
    rows.warn(fmt::format("{}: taken as upright with scale 1",
                          setting.empty() ? "no scene_setting.csv near the recording"
                                          : fmt::format("scene '{}' is not in scene_setting.csv", name)));
    return {};
}

}  // namespace

bool is_eyenavgs_trace(std::string_view text) {
    CsvReader csv{text.substr(0, 4096)};
    return csv.next() && eye_columns(csv).has_value();
}

Result<Trace> read_eyenavgs_trace(const TraceFile& file) {
    CsvReader csv{file.text};
    csv.next();
    const auto columns = *eye_columns(csv);
    const auto fovs = fov_columns(csv);
    TraceRows rows;
    EyePairs pairs{scene_of(file, rows), rows};
    read_csv_rows(csv, rows, [&] {
        const auto row = parse_row(csv, columns, fovs);
        if (row) pairs.add(*row);
        return row.has_value();
    });
    pairs.end();
    Result<Trace> trace = rows.finish(file.name(), file.where());
    if (trace && pairs.fovs()) trace->set_eye_fovs(*pairs.fovs());
    return trace;
}

}  // namespace lw
