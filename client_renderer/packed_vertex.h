#pragma once
/// Vertices as the GPU reads them: two streams, so that what needs no texture fetches 24 bytes per vertex.

#include <cstdint>
#include <glm/glm.hpp>

#include "core/image.h"
#include "gl/handle.h"
#include "scene/scene.h"

namespace lw {

/// Stream 0, read by every draw.
struct PackedSurfaceVertex {
    glm::vec3 position_object{0.0f};
    std::int16_t normal_snorm[4] = {};  ///< w: handedness of the tangent
    Rgba8 colour;
};
static_assert(sizeof(PackedSurfaceVertex) == 24);

/// Stream 1, read by draws with textures.
struct PackedTextureVertex {
    glm::vec2 uv{0.0f};
    std::int16_t tangent_snorm[4] = {};
};
static_assert(sizeof(PackedTextureVertex) == 16);

/// Stream 2, one per instance.
struct PackedInstance {
    glm::vec4 relative_from_object_rows[3];  ///< origin in the eye, axes of the world
    std::uint32_t object_id = 0;
};
static_assert(sizeof(PackedInstance) == 52);

/// Composed in double relative to the eye, rounded once.
[[nodiscard]] PackedInstance packed_instance(const glm::dmat4& world_from_object, const glm::dvec3& eye_world,
                                             std::uint32_t object_id);
[[nodiscard]] PackedSurfaceVertex pack_surface(const scene::Vertex& vertex);
[[nodiscard]] PackedTextureVertex pack_texture(const scene::Vertex& vertex);

/// A vertex array that reads the three streams from these buffers.
[[nodiscard]] gl::VertexArray make_vertex_array(const gl::Buffer& surface, const gl::Buffer& texture,
                                                const gl::Buffer& instances, const gl::Buffer& indices);

}  // namespace lw
