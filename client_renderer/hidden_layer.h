#pragma once
/// The second layer of a frame: what lies behind the first where the head may look behind it (--layers 2).

#include "client_renderer/scene_renderer.h"
#include "frame_link/rendered_frame.h"

namespace lw {

/// Draws what `first` hides into `hidden`, with the same camera, times and movers. Pixels that no head within
/// `head_motion_m` of the camera sees, or that show the same as `first`, hold nothing.
/// @param first  a whole picture in CPU memory, just drawn by `renderer` with as many samples
/// @param head_motion_m  >= 0
/// @param part  of the scene that `first` shows; its `behind` is ignored
/// The renderer's thread.
void draw_hidden_layer(SceneRenderer& renderer, const Layer& first, int samples_per_axis, double head_motion_m,
                       Layer& hidden, ScenePart part = {});

}  // namespace lw
