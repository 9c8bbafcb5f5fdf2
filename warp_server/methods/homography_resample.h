#pragma once
/// Resampling a whole layer through one homography: what `stale` and `rotation` do.

#include <glm/glm.hpp>
#include <memory>
#include <string_view>

#include "warp_server/warp_method.h"

namespace lw {

/// What methods prepare that call resample_by_rotation().
[[nodiscard]] std::shared_ptr<const PreparedLayer> prepare_picture(const Layer& layer);

/// Shows `layer` through the rotation and field of view of `target` as if both eyes stood in one place; positions are
/// ignored. Colour is bilinear in linear light, depth comes from the nearest source pixel. Target pixels whose centre
/// falls outside the source image, or behind it, or on a pixel that shows nothing, are holes; beside such a pixel the
/// nearest colour is taken. A homography that moves nothing copies the source.
/// Counts bad depths of the pixels it shows and gives them depth 0.
/// @param label  of the method, which prepares with prepare_picture()
void resample_by_rotation(const Layer& layer, std::string_view label, const Camera& target, DisplayFrame& out,
                          WarpCounters& counters);

/// Homography source_px <- target_px of the rotation and field of view alone, columns x, y, 1: where the background of
/// a target pixel lies in the source. Its third component is above 0 in front of the source eye. Exactly the identity
/// when nothing turned. Pure, any thread.
[[nodiscard]] glm::mat3 background_source_from_target(const Camera& source, const Camera& target);

}  // namespace lw
