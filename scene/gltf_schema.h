#pragma once
/// The part of the glTF 2.0 schema that the importer uses, as tables, and the check against it.

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_refusal.h"

namespace lw::scene {

/// Takes what the tables know from `root` and drops the rest (extras, unknown properties and extensions). Afterwards
/// every known property has its type, every required one is there, every index is inside the array it points into,
/// and every integer is one (1.0 becomes 1) and fits 31 bits, and no text but URIs is longer than 64 KB. Refuses with
/// the place otherwise.
[[nodiscard]] nlohmann::json checked_gltf(nlohmann::json root);

/// Refuses files of other glTF versions and files that require an extension we do not have; reports extensions in use
/// that we do not have, and what will be drawn differently than written, in `warnings`.
void check_gltf_features(const nlohmann::json& root, std::vector<std::string>& warnings);

}  // namespace lw::scene
