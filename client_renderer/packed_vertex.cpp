#include "client_renderer/packed_vertex.h"

#include <cmath>
#include <cstddef>

#include "shaders/client_blocks.h"

namespace lw {

namespace {

std::int16_t snorm16(float value) {
    const float clamped = std::isfinite(value) ? glm::clamp(value, -1.0f, 1.0f) : 0.0f;
    return static_cast<std::int16_t>(std::lround(clamped * 32767.0f));
}

struct Attribute {
    int location;
    GLint size;
    GLenum type;
    GLboolean normalised;
    std::size_t offset;
    GLuint stream;
};

}  // namespace

PackedInstance packed_instance(const glm::dmat4& world_from_object, const glm::dvec3& eye_world,
                               std::uint32_t object_id) {
    glm::dmat4 relative_from_object = world_from_object;
    relative_from_object[3] -= glm::dvec4{eye_world, 0.0};
    PackedInstance instance;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            instance.relative_from_object_rows[row][column] = static_cast<float>(relative_from_object[column][row]);
        }
    }
    instance.object_id = object_id;
    return instance;
}

PackedSurfaceVertex pack_surface(const scene::Vertex& vertex) {
    PackedSurfaceVertex packed;
    packed.position_object = vertex.position_object;
    for (int i = 0; i < 3; ++i) packed.normal_snorm[i] = snorm16(vertex.normal_object[i]);
    packed.normal_snorm[3] = snorm16(vertex.tangent_object.w < 0.0f ? -1.0f : 1.0f);
    packed.colour = vertex.colour;
    return packed;
}

PackedTextureVertex pack_texture(const scene::Vertex& vertex) {
    PackedTextureVertex packed;
    packed.uv = vertex.uv;
    for (int i = 0; i < 3; ++i) packed.tangent_snorm[i] = snorm16(vertex.tangent_object[i]);
    return packed;
}

gl::VertexArray make_vertex_array(const gl::Buffer& surface, const gl::Buffer& texture, const gl::Buffer& instances,
                                  const gl::Buffer& indices) {
    constexpr std::size_t kRow = sizeof(glm::vec4);
    const Attribute attributes[] = {
        {shader::kAttributePosition, 3, GL_FLOAT, GL_FALSE, offsetof(PackedSurfaceVertex, position_object), 0},
        {shader::kAttributeNormal, 4, GL_SHORT, GL_TRUE, offsetof(PackedSurfaceVertex, normal_snorm), 0},
        {shader::kAttributeColour, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(PackedSurfaceVertex, colour), 0},
        {shader::kAttributeUv, 2, GL_FLOAT, GL_FALSE, offsetof(PackedTextureVertex, uv), 1},
        {shader::kAttributeTangent, 3, GL_SHORT, GL_TRUE, offsetof(PackedTextureVertex, tangent_snorm), 1},
        {shader::kAttributeRow0, 4, GL_FLOAT, GL_FALSE, 0 * kRow, 2},
        {shader::kAttributeRow1, 4, GL_FLOAT, GL_FALSE, 1 * kRow, 2},
        {shader::kAttributeRow2, 4, GL_FLOAT, GL_FALSE, 2 * kRow, 2},
    };
    gl::VertexArray array = gl::make_vertex_array();
    const GLuint id = array.id();
    glVertexArrayElementBuffer(id, indices.id());
    glVertexArrayVertexBuffer(id, 0, surface.id(), 0, sizeof(PackedSurfaceVertex));
    glVertexArrayVertexBuffer(id, 1, texture.id(), 0, sizeof(PackedTextureVertex));
    glVertexArrayVertexBuffer(id, 2, instances.id(), 0, sizeof(PackedInstance));
    glVertexArrayBindingDivisor(id, 2, 1);
    for (const Attribute& attribute : attributes) {
        const auto location = static_cast<GLuint>(attribute.location);
        glEnableVertexArrayAttrib(id, location);
        glVertexArrayAttribFormat(id, location, attribute.size, attribute.type, attribute.normalised,
                                  static_cast<GLuint>(attribute.offset));
        glVertexArrayAttribBinding(id, location, attribute.stream);
    }
    constexpr auto kObjectId = static_cast<GLuint>(shader::kAttributeObjectId);
    glEnableVertexArrayAttrib(id, kObjectId);
    glVertexArrayAttribIFormat(id, kObjectId, 1, GL_UNSIGNED_INT, offsetof(PackedInstance, object_id));
    glVertexArrayAttribBinding(id, kObjectId, 2);
    return array;
}

}  // namespace lw
