#pragma once
/// A picture of what a view needs, from above.

#include "client_renderer/culling_settings.h"
#include "core/camera.h"
#include "core/image.h"
#include "scene/scene.h"

namespace lw {

/// The scene from above, north (-Z) up: every object's box in the colour of what became of it for `camera`: drawn
/// green, hidden red, behind walls blue, outside the field of view grey; the field of view's edges and the eye white.
/// Objects that are drawn lie on top. Around the eye as far as objects are drawn, and a quarter more.
/// @param side_px  of the square picture
[[nodiscard]] ColourImage culling_map(const scene::Scene& scene, const CullingSettings& settings, const Camera& camera,
                                      double scene_time_s, int side_px);

}  // namespace lw
