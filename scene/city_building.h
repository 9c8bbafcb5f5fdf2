#pragma once
/// Houses of the city: a style is a handful of choices, its mesh is made of walls with modelled openings and a roof.

#include <cstdint>
#include <string>
#include <vector>

#include "scene/city_materials.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"

namespace lw::scene {

enum class RoofKind : std::uint8_t {
    gable_along,  ///< ridge parallel to the street
    gable_front,  ///< stepped gable towards the street
    hip,
    flat,
};

/// Object space of a house: origin on the ground in the middle of the front, front towards +Z, house towards -Z.
struct BuildingStyle {
    std::string name;
    double width_m = 12.0;
    double depth_m = 11.0;
    double ground_height_m = 3.6;  ///< of the ground floor; the walls end at ground + (storeys - 1) * storey
    double storey_height_m = 3.0;
    int storeys = 3;
    int columns = 4;  ///< of windows in the front
    CityMaterial wall = kPlaster;
    Rgba8 wall_colour;
    Rgba8 trim_colour;
    Rgba8 frame_colour;
    Rgba8 accent_colour;  ///< doors, shutters, shop fronts
    Rgba8 roof_colour;
    RoofKind roof = RoofKind::gable_along;
    bool shop = false;
    bool shutters = false;
    bool balconies = false;
    bool dormers = false;
    bool windows_left = false;  ///< in the side wall to the left of someone who looks at the front
    bool windows_right = false;

    [[nodiscard]] double eaves_height_m() const { return ground_height_m + (storeys - 1) * storey_height_m; }
};

/// Where a house can stand: a row's ends show a side wall.
enum class LotKind : std::uint8_t { middle, left_end, right_end };

struct BuildingVariant {
    LotKind lot = LotKind::middle;
    Mesh mesh;
};

inline constexpr double kLotWidth_m = 12.0;
inline constexpr double kLotDepth_m = 12.0;

/// The houses the city repeats, a fixed number of each lot kind; looks depend on the seed.
[[nodiscard]] std::vector<BuildingVariant> make_building_variants(std::uint64_t seed);

/// One house. `random` decides small things: curtains, which column has the door.
[[nodiscard]] Mesh make_building(const BuildingStyle& style, Random& random);

/// A church with a spire, front (tower) towards +Z; about 40 m high.
[[nodiscard]] Mesh make_church();

}  // namespace lw::scene
