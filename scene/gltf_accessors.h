#pragma once
/// Reads accessors: every component type, normalised or not, strided, sparse, compressed.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_source.h"

namespace lw::scene {

/// "accessors[3]".
[[nodiscard]] std::string accessor_place(int accessor);

/// Elements of an accessor; nothing is read.
[[nodiscard]] std::size_t accessor_count(const GltfSource& source, int accessor);
/// 1 for SCALAR, 2-4 for VECn; matrices are refused (nothing we import is one).
[[nodiscard]] int accessor_components(const GltfSource& source, int accessor);

/// All elements as floats, `accessor_components` each, without gaps. Normalised integers become [0, 1] or [-1, 1].
/// @param components  how many the caller expects; another type is refused
[[nodiscard]] std::vector<float> read_floats(GltfSource& source, int accessor, int components);

/// All elements of a SCALAR accessor of unsigned integers.
[[nodiscard]] std::vector<std::uint32_t> read_indices(GltfSource& source, int accessor);

/// The bytes of a buffer view, decompressed if need be. The span lives as long as `source`.
[[nodiscard]] std::span<const std::uint8_t> view_bytes(GltfSource& source, int view);

/// `length` bytes at `offset` of a buffer; refuses what lies outside.
[[nodiscard]] std::span<const std::uint8_t> buffer_bytes(const GltfSource& source, int buffer, std::uint64_t offset,
                                                         std::uint64_t length, const std::string& place);

}  // namespace lw::scene
