#pragma once
/// Layers for tests that ask where one source pixel went.

#include <cstdint>
#include <memory>
#include <string_view>

#include "frame_link/rendered_frame.h"
#include "warp_server/methods/registry.h"
#include "warp_server/warp_method.h"

namespace lw::test {

/// A colour that names a source pixel; index below 2^24.
[[nodiscard]] Rgba8 colour_of_index(std::uint32_t index);
[[nodiscard]] std::uint32_t index_of_colour(Rgba8 colour);

/// All pixels at one depth and object 0, each with its index as its colour.
[[nodiscard]] Layer indexed_layer(const Camera& camera, float depth);

/// Depths and colours from a fixed sequence, with some background; object 0.
[[nodiscard]] Layer noise_layer(const Camera& camera);

/// Replaces the colours by the pixels' indices.
void colour_by_index(Layer& layer);

/// The method of a specification that must be valid.
[[nodiscard]] std::unique_ptr<WarpMethod> method_named(std::string_view specification);

/// Warps once with a fresh method.
[[nodiscard]] DisplayFrame warp_once(std::string_view specification, const Layer& layer, const WarpTarget& target);

}  // namespace lw::test
