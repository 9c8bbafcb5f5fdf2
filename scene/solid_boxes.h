#pragma once
/// Boxes inside closed meshes: what a mesh surely hides, in a form that is cheap to draw.

#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// A box that lies inside a mesh's surface: every ray that enters it from outside, through a side that is not open, has
/// met an opaque front face of the mesh before. So whatever lies behind the box, or in it, is hidden by the mesh.
struct SolidBox {
    Bounds box_object;
    /// Bit 2 * axis: the side towards -axis is open, bit 2 * axis + 1: the one towards +axis. Houses have no floor:
    /// such a box hides nothing from an eye on the outer side of an open one.
    unsigned open_sides = 0;
};

/// The largest boxes found inside `mesh`, largest first, at most three; none where the mesh encloses nothing.
///
/// The mesh's box is divided into cells; those that the surface does not touch and that cannot be reached from outside
/// are solid. The largest boxes of solid cells grow to the surface, and rays from their sides, on a fixed pattern,
/// check that it has no holes. Deterministic; milliseconds per mesh. Materials with an alpha cutoff count as absent.
[[nodiscard]] std::vector<SolidBox> solid_boxes(const Mesh& mesh, const std::vector<Material>& materials);

}  // namespace lw::scene
