#pragma once
/// Walls with modelled openings. Local space of a facade: x to the right as seen from outside, y up from the ground,
/// z outward, the wall's surface at z = 0.

#include <span>
#include <vector>

#include "scene/city_building.h"

namespace lw::scene {

enum class OpeningKind : std::uint8_t { window, balcony_door, door, shop_window };

/// A hole in a wall and what fills it; metres.
struct Opening {
    double x0;
    double x1;
    double y0;
    double y1;
    OpeningKind kind = OpeningKind::window;
};

/// Where a wall has corners, ascending: what borders on it has them too, so that no crack opens between.
struct WallCuts {
    std::vector<double> xs;
    std::vector<double> ys;
};

/// The wall's surface from (x0, y0) to (x1, y1) around its openings, without T-junctions.
/// @param edge_ys  where the walls beside it have corners on its upright edges
/// @return  where it has corners
WallCuts add_wall(MeshBuilder& builder, double x0, double x1, double y0, double y1, std::span<const Opening> openings,
                  std::span<const double> edge_ys = {});

/// Reveal, frame, bars, glass and sill. `panes_x`, `panes_y`: how the bars divide it. `wall`: the one it is in.
void add_window(MeshBuilder& builder, const BuildingStyle& style, const Opening& opening, int panes_x, int panes_y,
                const WallCuts& wall, Random& random);

/// A whole side of a house of `width_m`: wall, openings, trims, and on the front door, shop and balconies.
void add_facade(MeshBuilder& builder, const BuildingStyle& style, double width_m, bool front, bool windows,
                Random& random);

/// Slab, brackets and a railing of single bars; centred on x, floor at y.
void add_balcony(MeshBuilder& builder, const BuildingStyle& style, double x, double y, double width_m);

}  // namespace lw::scene
