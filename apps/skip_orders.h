#pragma once
/// Orders of draws compared: changes of state through a sorting buffer, against the fewest that any can make.

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace lw {

/// Changes of state of what a view draws, nearest object first, through a buffer of one size.
struct BufferChanges {
    std::size_t capacity = 0;
    std::size_t draws = 0;
    std::size_t states = 0;              ///< different ones: no order changes state less often
    std::vector<std::size_t> changes{};  ///< by SortingStrategy
    /// Over pieces of the sequence short enough for the search.
    std::size_t piece_draws = 0;
    std::vector<std::size_t> piece_changes{};  ///< by SortingStrategy; summed over the pieces
    std::size_t piece_fewest = 0;              ///< of any strategy that knows the piece; 0: not searched
};

/// Names of the strategies as --draw-order has them, by SortingStrategy.
[[nodiscard]] const std::vector<std::string>& sorting_strategy_names();

/// From the start pose of the scene. The current context holds its meshes meanwhile.
[[nodiscard]] Result<std::vector<BufferChanges>> compare_buffers(const scene::Scene& scene);

}  // namespace lw
