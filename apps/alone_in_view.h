#pragma once
/// Whether an object would have a pixel in a picture if nothing stood before it: tells what is hidden from what is too
/// small or beside the picture.

#include "client_renderer/placed_instances.h"
#include "core/camera.h"

namespace lw {

/// True when a triangle of the object that is turned to the eye covers a pixel centre of the picture. Materials with an
/// alpha cutoff count as opaque. Pure, any thread.
[[nodiscard]] bool has_pixel_alone(const scene::Scene& scene, const PlacedInstance& placed, const Camera& camera);

}  // namespace lw
