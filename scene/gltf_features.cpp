#include <algorithm>
#include <array>
#include <string_view>

#include "scene/gltf_schema.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 8> kSupportedExtensions = {
    "EXT_mesh_gpu_instancing",         "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",      "KHR_lights_punctual",
    "KHR_materials_emissive_strength", "KHR_materials_unlit",
    "KHR_mesh_quantization",           "KHR_texture_transform"};

bool supported(const std::string& extension) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), extension) != kSupportedExtensions.end();
}

/// "2.0" -> {2, 0}; anything else than digits around one dot is refused.
std::pair<int, int> version_of(const json& asset, const char* name) {
    const std::string place = fmt::format("asset.{}", name);
    const auto found = asset.find(name);
    if (found == asset.end() || !found->is_string()) refuse("the glTF version is missing", place);
    const auto& text = found->get_ref<const std::string&>();
    const std::size_t dot = text.find('.');
    const auto digits = [](std::string_view part) {
        return !part.empty() && part.size() < 4 &&
               std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (dot == std::string::npos || !digits(std::string_view{text}.substr(0, dot)) ||
        !digits(std::string_view{text}.substr(dot + 1))) {
        refuse(fmt::format("\"{}\" is not a glTF version", text.substr(0, 16)), place);
    }
    return {std::stoi(text.substr(0, dot)), std::stoi(text.substr(dot + 1))};
}

void check_version(const json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object()) refuse("a required property is missing", "asset");
    const auto version = version_of(*asset, "version");
    if (version.first != 2) {
        refuse(fmt::format("glTF version {}.{} is not 2.0", version.first, version.second), "asset.version",
               "convert the model to glTF 2.0");
    }
    if (asset->contains("minVersion") && version_of(*asset, "minVersion") > std::pair{2, 0}) {
        refuse("the file needs a newer glTF version than 2.0", "asset.minVersion", "convert the model to glTF 2.0");
    }
}

/// Calls `visit(name, place)` for every text of a root array.
template <class Visit>
void for_each_text(const json& root, const char* array_name, const Visit& visit) {
    const auto array = root.find(array_name);
    if (array == root.end()) return;
    if (!array->is_array()) refuse("expected an array", array_name);
    for (std::size_t i = 0; i < array->size(); ++i) {
        const std::string place = fmt::format("{}[{}]", array_name, i);
        if (!(*array)[i].is_string()) refuse("expected a text", place);
        visit((*array)[i].get_ref<const std::string&>(), place);
    }
}

bool any_morph_targets(const json& root) {
    const auto meshes = root.find("meshes");
    if (meshes == root.end() || !meshes->is_array()) return false;
    for (const json& mesh : *meshes) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (const json& primitive : mesh["primitives"]) {
            if (primitive.is_object() && primitive.contains("targets")) return true;
        }
    }
    return false;
}

bool any_with(const json& root, const char* array_name, const char* property) {
    const auto array = root.find(array_name);
    if (array == root.end() || !array->is_array()) return false;
    return std::any_of(array->begin(), array->end(),
                       [&](const json& entry) { return entry.is_object() && entry.contains(property); });
}

}  // namespace

void check_gltf_features(const json& root, std::vector<std::string>& warnings) {
    check_version(root);
    for_each_text(root, "extensionsRequired", [](const std::string& name, const std::string& place) {
        if (!supported(name)) {
            refuse(fmt::format("the required extension {} is not supported", name.substr(0, 64)), place,
                   "export the model without it");
        }
    });
    for_each_text(root, "extensionsUsed", [&](const std::string& name, const std::string&) {
        if (!supported(name)) warnings.push_back(fmt::format("extension {} is ignored", name.substr(0, 64)));
    });
    if (any_with(root, "nodes", "skin")) warnings.emplace_back("skins are shown in their bind pose");
    if (any_morph_targets(root)) warnings.emplace_back("morph targets are shown in their base shape");
    if (any_with(root, "materials", "occlusionTexture")) warnings.emplace_back("occlusion textures are ignored");
}

}  // namespace lw::scene
