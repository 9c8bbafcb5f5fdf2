#pragma once
/// What a JSON text would cost as a tree, found without building it.

#include <cstdint>
#include <span>

#include "scene/gltf_refusal.h"

namespace lw::scene {

struct JsonCost {
    std::uint64_t structure_bytes = 0;  ///< values, arrays, and objects with their keys
    std::uint64_t text_bytes = 0;       ///< string values

    [[nodiscard]] std::uint64_t bytes() const { return structure_bytes + text_bytes; }
};

/// Walks over the text once. Refuses (GltfRefusal) broken JSON, nesting deeper than `max_depth`, and what passes
/// `max_bytes`.
[[nodiscard]] JsonCost json_cost(std::span<const std::uint8_t> text, int max_depth, std::uint64_t max_bytes);

}  // namespace lw::scene
