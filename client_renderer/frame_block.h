#pragma once
/// A camera and the sun as the shaders read them.

#include "core/camera.h"
#include "scene/scene.h"
#include "shaders/client_blocks.h"

namespace lw {

/// Composed in double, rounded once. Its `part` is for the caller to fill. Pure, any thread.
[[nodiscard]] shader::FrameBlock frame_block(const Camera& camera, const scene::Sun& sun);

}  // namespace lw
