#pragma once
/// What a Draco stream claims to hold, read before its decoder allocates for it.

#include <cstdint>
#include <span>
#include <string>

namespace lw::scene {

struct DracoClaims {
    std::uint32_t triangles = 0;
    std::uint32_t vertices = 0;
};

/// Reads the first fields of a triangle mesh (Draco bitstream specification, "Draco decoder" and "Connectivity").
/// Refuses other kinds of data (GltfRefusal). `place` names the extension.
[[nodiscard]] DracoClaims read_draco_claims(std::span<const std::uint8_t> bytes, const std::string& place);

}  // namespace lw::scene
