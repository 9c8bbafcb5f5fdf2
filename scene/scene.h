#pragma once
/// A scene as the client draws it, and as glTF can hold it: meshes, materials, nodes with animations, instances.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/object_transform.h"

namespace lw::scene {

inline constexpr int kNone = -1;  ///< "no index"

struct Vertex {
    glm::vec3 position_object{0.0f};
    glm::vec3 normal_object{0.0f, 1.0f, 0.0f};         ///< unit
    glm::vec4 tangent_object{1.0f, 0.0f, 0.0f, 1.0f};  ///< xyz unit, w the handedness of the bitangent
    glm::vec2 uv{0.0f};
    Rgba8 colour{255, 255, 255, 255};  ///< linear multiplier, as glTF's COLOR_0 (not sRGB)
};

/// Axis-aligned box; empty while min > max.
struct Bounds {
    glm::dvec3 min{1e300};
    glm::dvec3 max{-1e300};

    [[nodiscard]] bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (min + max); }
    [[nodiscard]] glm::dvec3 half_size() const { return 0.5 * (max - min); }
    void include(const glm::dvec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void include(const Bounds& other) {
        if (other.empty()) return;
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
};

/// The box around a transformed box. Pure.
[[nodiscard]] Bounds transformed(const Bounds& bounds, const glm::dmat4& to_from);

/// Triangles of one material: a range of the mesh's index list.
struct Primitive {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;  ///< multiple of 3
    int material = kNone;           ///< kNone: glTF's default material
};

struct Mesh {
    std::string name;
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;  ///< triangle list, counter-clockwise fronts, every index < vertices.size()
    std::vector<Primitive> primitives;
    Bounds bounds;  ///< of the vertices, object space
};

enum class TextureWrap : std::uint8_t { repeat, clamp, mirror };

struct TextureImage {
    std::string name;
    ColourImage pixels;
};

/// A use of an image by a material.
struct TextureUse {
    int image = kNone;
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    bool nearest = false;
    glm::mat3 uv_transform{1.0f};  ///< KHR_texture_transform, applied to (u, v, 1)
};

struct Material {
    std::string name;
    glm::vec4 base_colour{1.0f};  ///< linear
    float metallic = 1.0f;
    float roughness = 1.0f;
    glm::vec3 emissive{0.0f};  ///< linear
    float normal_scale = 1.0f;
    std::optional<float> alpha_cutoff;  ///< set: pixels below it are left out (mask, and blend drawn as mask)
    bool double_sided = false;
    bool unlit = false;
    TextureUse base_colour_texture;         ///< sRGB, alpha linear
    TextureUse metallic_roughness_texture;  ///< roughness in G, metallic in B, linear
    TextureUse normal_texture;              ///< tangent space, linear
    TextureUse emissive_texture;            ///< sRGB
};

enum class Interpolation : std::uint8_t { step, linear, cubic };
enum class AnimatedProperty : std::uint8_t { translation, rotation, scale };

/// Keyframes of one property of one node. All animations of a file play together, each looped over its own length.
struct AnimationChannel {
    int node = kNone;
    AnimatedProperty property = AnimatedProperty::translation;
    Interpolation interpolation = Interpolation::linear;
    double loop_s = 0.0;         ///< length of the animation the channel belongs to, > 0
    std::vector<float> times_s;  ///< strictly increasing, first >= 0
    std::vector<glm::vec4>
        values;  ///< one per key (xyz, or quaternion xyzw); three for cubic: in-tangent, value, out-tangent
};

struct Node {
    std::string name;
    int parent = kNone;  ///< always a smaller index: parents come first
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
    std::optional<glm::dmat4> matrix;  ///< replaces translation, rotation and scale, and the channels of the node
};

/// A mesh placed by a node. Where world_from_object mirrors (determinant of its upper 3x3 below zero, which a negative
/// scale makes), counter-clockwise triangles turn clockwise: who draws flips its front faces then.
struct Instance {
    int mesh = 0;
    int node = 0;
    glm::dmat4 node_from_object{1.0};  ///< of EXT_mesh_gpu_instancing; identity otherwise
    ObjectId mover = 0;                ///< set by finish(): 0 static, else the mover that carries it
};

/// A mover: an animated node that is the nearest animated one (itself or an ancestor) of at least one instance's node.
/// Its placement is world_from_node of that node.
struct Mover {
    ObjectId id = 0;
    int node = 0;
};

struct PointLight {
    glm::dvec3 position_world{0.0};
    glm::vec3 intensity{0.0f};  ///< linear, candela-like: radiance falls with 1 / distance^2
    float range_m = 10.0f;
};

struct Sun {
    glm::dvec3 direction_to_sun_world{0.35, 0.8, 0.45};  ///< unit after finish()
    glm::vec3 irradiance{2.6f, 2.4f, 2.1f};              ///< linear
};

inline constexpr int kMaxPointLights = 64;

struct Scene {
    std::string name;
    std::vector<TextureImage> images;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<AnimationChannel> channels;
    std::vector<Instance> instances;
    std::vector<PointLight> point_lights;  ///< at most kMaxPointLights
    Sun sun;
    std::optional<Pose> start_pose;     ///< world_from_eye where a viewer starts
    std::vector<std::string> warnings;  ///< what an importer ignored or mended, one line each

    // Derived by finish():
    std::vector<Mover> movers;  ///< ids 1.. in order
    Bounds bounds_world;        ///< of all instances at time 0

    /// Derives movers, instance ids, mesh bounds, the scene's bounds and a start pose if there is none. Call once after
    /// filling the rest. More than 65535 movers: the rest stay static, with a warning.
    void finish();
    [[nodiscard]] std::uint64_t triangle_count() const;  ///< over instances
};

/// Placements of nodes at a time; keeps its memory between calls. One thread at a time.
class SceneState {
public:
    explicit SceneState(const Scene& scene);  ///< `scene` outlives it

    /// Evaluates animations at `time_s` (any finite value; loops) and all node matrices. The first call does the whole
    /// tree, later ones only animated nodes and what hangs below them.
    void set_time(double time_s);

    [[nodiscard]] const glm::dmat4& world_from_node(int node) const {
        return world_from_node_[static_cast<std::size_t>(node)];
    }
    [[nodiscard]] glm::dmat4 world_from_object(const Instance& instance) const {
        return world_from_node(instance.node) * instance.node_from_object;
    }
    /// Placement of every mover (world_from_node of its node), by ascending id; replaces `transforms`.
    void mover_placements(std::vector<ObjectTransform>& transforms) const;

private:
    void evaluate(std::size_t node, double time_s);

    const Scene* scene_;
    std::vector<glm::dmat4> world_from_node_;
    std::vector<std::size_t> changing_;           ///< nodes that are animated or hang below one, ascending
    std::vector<std::size_t> first_channel_;      ///< per node: range in channels_of_nodes_; one more entry than nodes
    std::vector<std::size_t> channels_of_nodes_;  ///< indices into Scene::channels, grouped by node
    bool evaluated_ = false;
};

}  // namespace lw::scene
