#pragma once
/// Which part of the scene one layer holds: a distance range, what lies behind another layer, with or without the sky.

#include <limits>

#include "core/camera.h"
#include "core/image.h"
#include "frame_link/rendered_frame.h"
#include "scene/scene.h"

namespace lw {

/// Distances are lengths of rays from the eye, metres, so that a range is a shell around the eye whatever it looks at.
struct ScenePart {
    double nearest_m = 0.0;                                       ///< static surfaces nearer than this are left out
    double farthest_m = std::numeric_limits<double>::infinity();  ///< and those from here on
    bool movers = true;                                           ///< at any distance
    bool sky = true;  ///< where no surface is; without it such pixels hold nothing
    /// Of the picture's size, or null: per pixel the depth at and beyond which surfaces are left out; a pixel with 0
    /// holds nothing. Outlives the draw.
    const DepthImage* behind = nullptr;
};

/// Whether an object with these bounds may have a part in the range. Movers are in range at any distance.
[[nodiscard]] bool in_range(const ScenePart& part, const scene::Bounds& bounds_world, bool is_mover,
                            const glm::dvec3& eye_world);

/// Turns pixels in which the part has nothing, drawn as background, into such that hold nothing: kNoSurfaceDepth, black
/// and transparent, id 0.
/// @return how many there are
std::uint64_t empty_what_is_not_in(const ScenePart& part, CpuPixels& pixels);

}  // namespace lw
