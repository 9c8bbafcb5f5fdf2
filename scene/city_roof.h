#pragma once
/// Roofs of the city's houses: tiles as geometry, ridges, gutters, dormers, chimneys, antennas.

#include "scene/city_building.h"

namespace lw::scene {

/// A slope of overlapping tiles on the plane quad eaves_left, eaves_right, ridge_right, ridge_left (counter-clockwise
/// from outside; eaves and ridge horizontal, left and right as seen from outside). The ridge may be a point.
void add_tiled_slope(MeshBuilder& builder, Rgba8 colour, const glm::dvec3& eaves_left, const glm::dvec3& eaves_right,
                     const glm::dvec3& ridge_right, const glm::dvec3& ridge_left);

/// Everything above the eaves, in the house's object space.
void add_roof(MeshBuilder& builder, const BuildingStyle& style, Random& random);

/// A television antenna on a mast standing on `foot`.
void add_antenna(MeshBuilder& builder, const glm::dvec3& foot, double height_m, Random& random);

}  // namespace lw::scene
