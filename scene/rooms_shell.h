#pragma once
/// Walls, floors and ceilings of the built-in office building.

#include "scene/rooms_layout.h"
#include "scene/scene.h"

namespace lw::scene {

/// Inner surfaces of room `room` (not 0), with holes where its openings are and half the thickness of the wall around
/// each; the other half belongs to the room on the other side, and meets it exactly: both are in the layout's space.
[[nodiscard]] Mesh make_room_shell(const RoomsLayout& layout, int room);

/// Outer walls and roof, in the layout's space.
[[nodiscard]] Mesh make_facade(const RoomsLayout& layout);

}  // namespace lw::scene
