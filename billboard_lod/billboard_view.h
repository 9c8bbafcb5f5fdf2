#pragma once
/// From a drawn billboard to the numbers that shaders want. No GL here.

#include <optional>

#include "billboard_lod/atlas_layout.h"
#include "billboard_lod/object_painter.h"
#include "billboard_lod/update_criteria.h"
#include "core/camera.h"
#include "shaders/billboard_blocks.h"

namespace lw {

/// What the depth texel t of a billboard means: inverse distance = t * scale + offset. 1 at its nearest distance, above
/// 0 at its farthest, so that 0 is free to say "nothing here". All of the texel's range serves the billboard's own.
struct DepthCoding {
    double scale = 0.0;
    double offset = 0.0;
};

/// 0 < nearest_m <= farthest_m. Pure.
[[nodiscard]] DepthCoding depth_coding(double nearest_m, double farthest_m);

/// The view that draws a billboard into its slot: its own frustum, moved and scaled onto the slot, so that many slots
/// are filled by one draw without changing the viewport. `camera` is the eye that draws. `instance` is left 0. Pure.
[[nodiscard]] PaintedView painted_view(const DrawnBillboard& billboard, const AtlasLayout& layout, int slot,
                                       const Camera& camera);

/// Fills the record of a billboard for `camera`; `eye_now_from_eye_drawn` is affine and invertible. Nothing when it
/// crosses the near plane. Pure.
[[nodiscard]] std::optional<shader::BillboardRecord> warped_record(const DrawnBillboard& billboard,
                                                                   const AtlasLayout& layout, int slot,
                                                                   const glm::dmat4& eye_now_from_eye_drawn,
                                                                   const Camera& camera);
[[nodiscard]] std::optional<shader::BillboardRecord> flat_record(const DrawnBillboard& billboard,
                                                                 const AtlasLayout& layout, int slot,
                                                                 const glm::dmat4& eye_now_from_eye_drawn,
                                                                 const Camera& camera);

/// Gives all of a flat billboard the depth of its plane. `record` is flat_record() of `billboard`. Pure.
void leave_out_relief(const DrawnBillboard& billboard, shader::BillboardRecord& record);

}  // namespace lw
