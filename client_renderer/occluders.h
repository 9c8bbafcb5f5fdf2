#pragma once
/// What in a scene hides other things: boxes inside its meshes, where they stand, and rows of them that stand wall to
/// wall.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "client_renderer/occluder_search.h"
#include "client_renderer/occlusion_buffer.h"
#include "client_renderer/placed_instances.h"
#include "client_renderer/wide_bvh.h"
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

    void open(const OccluderQuery& query, const WideBvh::Child& node, const OcclusionBuffer& buffer);
    void fetch(const WideBvh::Child& child) const;
    void index();

    std::vector<std::vector<scene::SolidBox>> boxes_of_meshes_;
    std::vector<Occluder> occluders_;  ///< static ones first
    std::size_t static_count_ = 0;
    std::vector<Moving> moving_;
    std::vector<scene::Bounds> bounds_;  ///< of the occluders, for the hierarchy
    std::vector<std::uint32_t> moved_;
    std::optional<scene::Bvh> bvh_;
    std::optional<WideBvh> tree_;
    std::vector<float> areas_;                   ///< by slot of the tree, see append_worth()
    std::vector<OccluderCandidate> candidates_;  ///< a heap
};

}  // namespace lw
