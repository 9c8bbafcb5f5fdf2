#include "frame_link/eyenavgs_scene.h"

#include <array>
#include <cmath>

#include "core/pose.h"
#include "frame_link/csv_reader.h"

namespace lw {
namespace {

std::optional<glm::dquat> parse_xyzw(std::string_view field) {
    std::vector<std::string_view> parts;
    split_fields(field, parts);
    std::array<double, 4> v{};
    if (parts.size() != v.size()) return std::nullopt;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const auto number = parse_number(parts[i]);
        if (!number) return std::nullopt;
        v[i] = *number;
    }
    const auto unit = sanitised(Pose{{}, {v[3], v[0], v[1], v[2]}});
    return unit ? std::optional{unit->orientation} : std::nullopt;
}

}  // namespace

std::optional<EyenavgsScene> find_eyenavgs_scene(std::string_view setting_csv, std::string_view scene) {
    CsvReader csv{setting_csv};
    if (!csv.next()) return std::nullopt;
    const auto columns = csv.columns({"Scene_Name", "Quaternion", "Scale"});
    if (!columns) return std::nullopt;
    while (csv.next()) {
        const auto& fields = csv.fields();
        if (fields.size() <= (*columns)[2] || fields[(*columns)[0]] != scene) continue;
        const auto quaternion = parse_xyzw(fields[(*columns)[1]]);
        const auto scale = csv.number((*columns)[2]);
        if (!quaternion || !scale || !(*scale > 1e-6) || !std::isfinite(*scale)) return std::nullopt;
        return EyenavgsScene{*quaternion, *scale};
    }
    return std::nullopt;
}

std::string eyenavgs_scene_name(const std::filesystem::path& recording) {
    const std::string stem = recording.stem().string();
    const std::size_t underscore = stem.rfind('_');
    return underscore == std::string::npos ? stem : stem.substr(underscore + 1);
}

std::filesystem::path find_scene_setting(const std::filesystem::path& recording) {
    std::error_code ignored;
    std::filesystem::path folder = std::filesystem::absolute(recording, ignored).parent_path();
    for (int level = 0; level < 3; ++level) {
        std::filesystem::path file = folder / "scene_setting.csv";
        if (std::filesystem::is_regular_file(file, ignored)) return file;
        folder = folder.parent_path();
    }
    return {};
}

}  // namespace lw
