#pragma once
/// Decides which objects a view needs: what is outside the field of view, or hidden, is skipped.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_renderer/box_list.h"
#include "client_renderer/box_tree.h"
#include "client_renderer/clusters.h"
#include "client_renderer/culling_settings.h"
#include "client_renderer/occluders.h"
#include "client_renderer/occlusion_buffer.h"
#include "client_renderer/placed_instances.h"
#include "client_renderer/portal_walk.h"
#include "core/task_pool.h"

namespace lw {

/// Objects by what became of them.
struct CullingCounters {
    std::uint64_t tested = 0;
    std::uint64_t outside = 0;          ///< not in the field of view
    std::uint64_t behind_walls = 0;     ///< in cells that no portal in view leads to, or beside all portals' rectangles
    std::uint64_t occluded = 0;         ///< hidden behind occluders
    std::uint64_t too_small = 0;        ///< below the pixel size asked for
    std::uint64_t between_samples = 0;  ///< too thin or too far to meet a sample of the picture
    std::uint64_t occluders = 0;        ///< drawn into the occlusion buffer
};

/// One thread at a time.
class Culling {
public:
    /// Scenes of more objects are tested by the hierarchy. Below it the plain list is as fast.
    static constexpr std::size_t kListUpTo = 256;

    /// `placed` outlives this.
    /// @param threads  that share the work, for the same result; null: the caller's alone. Outlives this
    Culling(const PlacedInstances& placed, const CullingSettings& settings, TaskPool* threads = nullptr);

    /// After `placed` moved. The next view follows it, while its occluders are drawn.
    void move() { moved_ = true; }

    /// From the next view on; metres, >= 0.
    void set_reveal_margin(double margin_m) { settings_.reveal_margin_m = margin_m; }

    /// From the next view on; a viewer that stands still sees the smallest things too.
    void set_viewer_moves(bool moves) { viewer_moves_ = moves; }

    /// Indices into `placed` of what the camera needs, ascending; valid until the next call.
    [[nodiscard]] const std::vector<std::uint32_t>& visible(const Camera& camera);

    /// For the clusters of what the last view needs; valid until the next view.
    [[nodiscard]] ClusterView cluster_view(const Camera& camera) const;

    [[nodiscard]] const CullingCounters& counters() const { return counters_; }  ///< of the last view

private:
    const PlacedInstances& placed_;
    CullingSettings settings_;
    TaskPool* threads_;
    bool viewer_moves_ = false;
    bool moved_ = false;  ///< since the last view
    void prepare(const Camera& camera);
    void move_boxes();
    void draw_occluders(const Camera& camera);
    void walk_portals(const Camera& camera, bool with_occlusion);
    void put_in_order();
    void count(const OcclusionBuffer::Split& split);
    void leave_out_small(const Camera& camera, std::vector<std::uint32_t>& objects);
    [[nodiscard]] double least_size_per_distance(const Camera& camera) const;
    void walk_tree(const Camera& camera, bool with_occlusion);
    void walk_list(const Camera& camera, bool with_occlusion);

    BoxList boxes_;                      ///< few objects, or those in rooms: one after the other
    PortalWalk portals_;                 ///< of a building
    std::optional<BoxTree> tree_;        ///< many
    std::vector<scene::Bounds> bounds_;  ///< for the tree
    std::vector<std::uint64_t> marks_;   ///< one bit per object, to put what the tree found in order
    Occluders occluders_;
    OcclusionBuffer buffer_;
    std::vector<std::uint32_t> in_view_;
    std::vector<std::uint32_t> seen_;
    std::vector<std::uint32_t> shown_;
    CullingCounters counters_;
};

}  // namespace lw
