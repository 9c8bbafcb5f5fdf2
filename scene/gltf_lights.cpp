#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/gltf_nodes.h"
#include "scene/placement.h"

namespace lw::scene {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";

// Where a light without a range ends: where it gives this much, which no 8-bit pixel shows.
constexpr float kFaintest = 0.01f;
constexpr float kLongestRange_m = 100.0f;
// Files state real lux and candela (sunlight is 100 000 lux), others numbers around 1. Our exposure is fixed for the
// latter, so brighter suns are brought down to this and all other lights by the same factor.
constexpr float kBrightestSun = 4.0f;
constexpr float kBrightestPoint = 1000.0f;

glm::dmat4 world_from_attachment(const GltfSource& source, const NodeOrder::Attachment& attachment,
                                 const SceneState& state) {
    const tinygltf::Node& from = source.model.nodes[static_cast<std::size_t>(attachment.gltf_node)];
    glm::dmat4 matrix{1.0};
    if (from.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = from.matrix[static_cast<std::size_t>(i)];
    } else {
        Placement placement;
        if (from.translation.size() == 3) {
            placement.translation = {from.translation[0], from.translation[1], from.translation[2]};
        }
        if (from.rotation.size() == 4) {
            placement.rotation = {from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]};
        }
        if (from.scale.size() == 3) placement.scale = {from.scale[0], from.scale[1], from.scale[2]};
        matrix = matrix_of(placement);
    }
    return attachment.parent == kNone ? matrix : state.world_from_node(attachment.parent) * matrix;
}

glm::vec3 colour_of(const tinygltf::Light& light) {
    glm::vec3 colour{1.0f};
    for (int i = 0; i < 3 && light.color.size() == 3; ++i) {
        colour[i] = static_cast<float>(std::clamp(light.color[static_cast<std::size_t>(i)], 0.0, 1.0));
    }
    return colour * static_cast<float>(std::clamp(light.intensity, 0.0, 1e9));
}

float brightest(const glm::vec3& colour) { return std::max({colour.x, colour.y, colour.z}); }

/// Rigid part of a camera's matrix; nothing when it has none.
std::optional<Pose> pose_of(const glm::dmat4& world_from_camera) {
    const glm::dvec3 back{world_from_camera[2]};
    const glm::dvec3 up{world_from_camera[1]};
    const glm::dvec3 right = glm::cross(up, back);
    if (!(glm::length(back) > 1e-12) || !(glm::length(right) > 1e-12)) return std::nullopt;
    const glm::dvec3 unit_back = glm::normalize(back);
    const glm::dvec3 unit_right = glm::normalize(right);
    const glm::dmat3 rotation{unit_right, glm::cross(unit_back, unit_right), unit_back};
    return sanitised({glm::dvec3{world_from_camera[3]}, glm::quat_cast(rotation)});
}

/// Brings photometric units down to our exposure.
void normalise_brightness(GltfSource& source, bool has_sun, Scene& scene) {
    float factor = has_sun ? std::min(1.0f, kBrightestSun / std::max(brightest(scene.sun.irradiance), 1e-6f)) : 1.0f;
    for (const PointLight& light : scene.point_lights) {
        factor = std::min(factor, kBrightestPoint / std::max(brightest(light.intensity), 1e-6f));
    }
    if (factor == 1.0f) return;
    warn_once(source, "lights are dimmed together to a fixed exposure");
    if (has_sun) scene.sun.irradiance *= factor;
    for (PointLight& light : scene.point_lights) light.intensity *= factor;
}

void add_point_light(const tinygltf::Light& light, const glm::dvec3& position_world, Scene& scene) {
    PointLight point;
    point.position_world = position_world;
    point.intensity = colour_of(light);
    const float visible_m = std::sqrt(brightest(point.intensity) / kFaintest);
    point.range_m = light.range > 0.0 ? static_cast<float>(light.range) : std::min(visible_m, kLongestRange_m);
    scene.point_lights.push_back(point);
}

}  // namespace

void import_lights_and_camera(GltfSource& source, const NodeOrder& order, Scene& scene) {
    SceneState state{scene};
    state.set_time(0.0);
    bool has_sun = false;
    for (const NodeOrder::Attachment& attachment : order.attachments) {
        const tinygltf::Node& from = source.model.nodes[static_cast<std::size_t>(attachment.gltf_node)];
        const glm::dmat4 world_from_node = world_from_attachment(source, attachment, state);
        if (from.camera >= 0 && !scene.start_pose) scene.start_pose = pose_of(world_from_node);
        const auto extension = from.extensions.find(kLights);
        if (extension == from.extensions.end()) continue;
        const tinygltf::Light& light =
            source.model.lights[static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt())];
        if (light.type == "directional") {
            if (has_sun) {
                warn_once(source, "of several directional lights the first one shines");
                continue;
            }
            has_sun = true;
            scene.sun.direction_to_sun_world = glm::dvec3{world_from_node[2]};  // lights shine along -Z
            scene.sun.irradiance = colour_of(light);
        } else {
            if (light.type == "spot") warn_once(source, "spot lights shine in all directions");
            add_point_light(light, glm::dvec3{world_from_node[3]}, scene);
        }
    }
    if (scene.point_lights.size() > static_cast<std::size_t>(kMaxPointLights)) {
        warn_once(source, fmt::format("only the first {} point lights shine", kMaxPointLights));
        scene.point_lights.resize(static_cast<std::size_t>(kMaxPointLights));
    }
    normalise_brightness(source, has_sun, scene);
}

}  // namespace lw::scene
