#pragma once
/// Roofs of the city's houses: slopes, ridges, gutters, dormers, chimneys, antennas.

#include "scene/city_building.h"

namespace lw::scene {

/// Everything above the eaves, in the house's object space.
void add_roof(MeshBuilder& builder, const BuildingStyle& style, Random& random);

/// A television antenna on a mast standing on `foot`.
void add_antenna(MeshBuilder& builder, const glm::dvec3& foot, double height_m, Random& random);

}  // namespace lw::scene
