#pragma once
/// glTF's primitive modes as triangle lists.

#include <cstdint>
#include <string>
#include <vector>

namespace lw::scene {

/// Whether a mode (0-6) draws triangles, not points or lines. Other numbers are refused (GltfRefusal).
[[nodiscard]] bool draws_triangles(int mode, const std::string& place);

/// Corners of a triangle mode as a triangle list with the same winding; corners that make no whole triangle are left
/// out. A strip or fan of n corners makes n - 2 triangles, the degenerate ones of strips included.
[[nodiscard]] std::vector<std::uint32_t> triangle_list(int mode, std::vector<std::uint32_t> corners);

}  // namespace lw::scene
