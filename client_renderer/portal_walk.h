#pragma once
/// What is seen in a building: cell by cell, through the portals between them.

#include <cstdint>
#include <vector>

#include "client_renderer/placed_instances.h"
#include "core/camera.h"
#include "scene/cells.h"

namespace lw {

/// From the eye's cell the walk goes through every portal in view, the view narrowed to the portal's rectangle on the
/// screen (Luebke and Georges 1995; seed 002, section 19.5), and only to cells that the cell of the eye may see at all.
/// A cell reached twice is seen through the rectangle around both. An object is taken once. One thread at a time.
class PortalWalk {
public:
    /// `placed` outlives the walk. Without cells there is nothing to walk: empty() is true.
    explicit PortalWalk(const PlacedInstances& placed);

    [[nodiscard]] bool empty() const { return graph_.empty(); }
    [[nodiscard]] const scene::CellGraph& graph() const { return graph_; }

    /// Appends indices into the placed instances, in no particular order and each once, of what may be seen from the
    /// camera and from every eye within `margin_m` of it on the same side of the walls. It may keep what is not seen,
    /// never leave out what is.
    /// @return false, and nothing appended, when the eye is where walls do not shut off the view: inside or closer to
    ///         one than the near plane reaches
    [[nodiscard]] bool append_seen(const Camera& camera, double margin_m, std::vector<std::uint32_t>& seen);

    [[nodiscard]] std::size_t cells_entered() const { return order_.size(); }  ///< by the last walk

private:
    /// In tangents of the camera's view.
    struct Rect {
        double left = 1e30;
        double right = -1e30;
        double down = 1e30;
        double up = -1e30;
        [[nodiscard]] bool empty() const { return left > right || down > up; }
        [[nodiscard]] bool holds(const Rect& other) const {
            return other.left >= left && other.right <= right && other.down >= down && other.up <= up;
        }
        void include(const Rect& other);
    };
    struct View {
        glm::dvec3 eye_world{0.0};
        glm::dmat3 eye_from_world{1.0};
        double near_m = 0.05;
        double margin_m = 0.0;
        Rect whole;
        double slack = 0.0;  ///< tangents: rounding, and where the rasteriser snaps
    };

    [[nodiscard]] std::vector<int> first_cells(const Camera& camera, double margin_m) const;
    void enter(int cell, const Rect& rect);
    void leave_through_portals(int cell, const View& view, const std::vector<int>& first);
    [[nodiscard]] Rect seen_through(const scene::Portal& portal, const View& view) const;
    [[nodiscard]] Rect rect_of(const scene::Bounds& bounds, const View& view) const;
    void take_movers(const View& view, std::vector<std::uint32_t>& seen) const;

    const PlacedInstances& placed_;
    scene::CellGraph graph_;
    std::vector<std::vector<std::uint32_t>> objects_;  ///< by cell, indices into placed_
    std::vector<Rect> rects_;                          ///< by cell, of this walk
    std::vector<int> order_;                           ///< cells entered
    std::vector<int> waiting_;
    std::vector<std::uint64_t> taken_in_;  ///< by object: the walk that took it
    std::uint64_t walk_ = 0;
};

}  // namespace lw
