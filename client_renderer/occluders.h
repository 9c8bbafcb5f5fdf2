#pragma once
/// What in a scene hides other things: boxes inside its meshes, where they stand, and rows of them that stand wall to
/// wall.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "client_renderer/frustum.h"
#include "client_renderer/occlusion_buffer.h"
#include "client_renderer/placed_instances.h"
#include "scene/bvh.h"
#include "scene/solid_boxes.h"

namespace lw {

/// A solid with what it takes to know whether it may be used for an eye.
struct Occluder {
    ConvexSolid solid;
    /// Bit i: the mesh is open behind plane i, so the solid hides nothing from an eye on its outer side.
    unsigned open_sides = 0;
    scene::Bounds bounds_world;          ///< of the solid
    scene::Bounds surface_bounds_world;  ///< of the meshes around it: an eye in there may stand before their surface
};

/// One thread at a time.
class Occluders {
public:
    static constexpr std::size_t kMostDrawn = 256;  ///< per view

    /// Finds the boxes of every mesh that is used (milliseconds each) and joins those of static instances that touch.
    explicit Occluders(const PlacedInstances& placed);

    /// Places those of movers anew.
    void move(const PlacedInstances& placed);

    /// Draws occluders, those first that look largest from the camera, and none that lie behind those drawn before:
    /// down to what covers no pixel of the buffer. Each is made smaller by `margin_m` on every side: what the
    /// buffer then says is hidden is hidden from every eye within that distance (the segment from such an eye to a
    /// hidden point passes no farther than that from the segment to the camera's eye, and so through the whole solid;
    /// Wonka et al. 2000, "Visibility preprocessing with occluder fusion").
    /// @return how many were drawn
    std::size_t draw(const Camera& camera, double margin_m, OcclusionBuffer& buffer);

    [[nodiscard]] const std::vector<Occluder>& all() const { return occluders_; }

private:
    struct Moving {
        std::size_t occluder = 0;
        std::uint32_t instance = 0;
        std::size_t box = 0;  ///< of its mesh
    };

    /// A node of the hierarchy, or an occluder.
    struct Item {
        glm::vec3 min{0.0F};
        float area = 0.0F;  ///< square metres of its largest side; of a node, of any in it
        glm::vec3 max{0.0F};
        std::uint32_t index = 0;
    };
    struct Query {
        FloatFrustum frustum;
        glm::vec3 eye_world{0.0F};
        float least_score = 0.0F;
        std::uint32_t end = 0;  ///< occluders before it
    };
    [[nodiscard]] Item item_of(std::uint32_t occluder) const;
    void offer(const Query& query, const Item& item, std::uint32_t place);
    void offer_inside(const Query& query, std::uint32_t node);
    void fetch(std::uint32_t place) const;
    void index();

    std::vector<std::vector<scene::SolidBox>> boxes_of_meshes_;
    std::vector<Occluder> occluders_;  ///< static ones first
    std::size_t static_count_ = 0;
    std::vector<Moving> moving_;
    std::vector<scene::Bounds> bounds_;  ///< of the occluders, for the hierarchy
    std::vector<std::uint32_t> moved_;
    std::optional<scene::Bvh> bvh_;
    std::vector<Item> items_;                ///< in the order of the hierarchy
    std::vector<float> largest_areas_;       ///< by node
    std::vector<std::uint64_t> candidates_;  ///< a heap: score, and the place in items_ or a node
};

}  // namespace lw
