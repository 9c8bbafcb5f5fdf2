#pragma once
/// Evaluation of keyframes (glTF 2.0, section 3.11 and appendix C).

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace lw::scene {

/// `time_s` folded into [0, loop_s); negative times count back from the end. `loop_s` > 0. Pure, any thread.
[[nodiscard]] double looped_time_s(double time_s, double loop_s);

/// The channel's value at a scene time: xyz for translation and scale, a unit quaternion (xyzw) for rotation. Before
/// the first key the first value holds, after the last key the last one; rotations follow the shorter arc. The channel
/// has at least one key and as many values as its interpolation needs. Pure, any thread.
[[nodiscard]] glm::dvec4 channel_value(const AnimationChannel& channel, double time_s);

}  // namespace lw::scene
