#include "billboard_lod/billboard_view.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace lw {

namespace {

/// Depth texel of the farthest distance: 1 % of the range is given up so that nothing but "nothing" is stored as 0.
constexpr double kFarthestTexel = 0.01;
/// The box's faces must not be clipped by rounding; and a box without depth still has a range.
constexpr double kRangePadding = 1e-3;

/// Where the corners of what a billboard can hold are now.
struct Extent {
    double nearest_m = 1e300;
    double farthest_m = 0.0;
    glm::dvec2 tangent_min{1e300};
    glm::dvec2 tangent_max{-1e300};
};

Extent extent_now(const DrawnBillboard& billboard, const glm::dmat4& eye_now_from_eye_drawn) {
    const FovTangents window = billboard.grid.window();
    Extent extent;
    for (int corner = 0; corner < 8; ++corner) {
        const double distance_m = (corner & 4) != 0 ? billboard.farthest_m : billboard.nearest_m;
        const glm::dvec3 drawn{((corner & 1) != 0 ? window.right : window.left) * distance_m,
                               ((corner & 2) != 0 ? window.up : window.down) * distance_m, -distance_m};
        const glm::dvec3 now{eye_now_from_eye_drawn * glm::dvec4{drawn, 1.0}};
        extent.nearest_m = std::min(extent.nearest_m, -now.z);
        extent.farthest_m = std::max(extent.farthest_m, -now.z);
        const glm::dvec2 tangent = glm::dvec2{now} / -now.z;
        extent.tangent_min = glm::min(extent.tangent_min, tangent);
        extent.tangent_max = glm::max(extent.tangent_max, tangent);
    }
    return extent;
}

void set_slot_and_depth(shader::BillboardRecord& record, const DrawnBillboard& billboard, const AtlasLayout& layout,
                        int slot) {
    const DepthCoding coding = depth_coding(billboard.nearest_m, billboard.farthest_m);
    record.slot = glm::vec4{glm::vec2{layout.slot_origin_px(slot)}, glm::vec2{billboard.grid.size}};
    record.depth = {static_cast<float>(coding.scale), static_cast<float>(coding.offset), 0.0f, 0.0f};
    record.extent.y = 1.0f;
}

/// Texels that the ray of now through the middle of the billboard crosses between the two distances.
double texels_along(const glm::dmat3& texel_from_ray, const glm::dvec3& texel_step, const glm::dvec2& tangent,
                    double q_near, double q_far) {
    const glm::dvec3 a = texel_from_ray * glm::dvec3{tangent, -1.0};
    const auto place = [&](double q) {
        const glm::dvec3 s = a + q * texel_step;
        return glm::dvec2{s} / s.z;
    };
    return glm::distance(place(q_near), place(q_far));
}

}  // namespace

DepthCoding depth_coding(double nearest_m, double farthest_m) {
    const double high = (1.0 + kRangePadding) / nearest_m;
    const double low = (1.0 - kRangePadding) / farthest_m;
    DepthCoding coding;
    coding.scale = (high - low) / (1.0 - kFarthestTexel);
    coding.offset = high - coding.scale;
    return coding;
}

PaintedView painted_view(const DrawnBillboard& billboard, const AtlasLayout& layout, int slot, const Camera& camera) {
    const glm::dmat3 relative_from_eye = glm::mat3_cast(camera.world_from_eye.orientation);
    const glm::dvec3 right = relative_from_eye[0];
    const glm::dvec3 up = relative_from_eye[1];
    const glm::dvec3 ahead = -relative_from_eye[2];
    // NDC of an atlas pixel: 2 * pixel / size - 1, downwards negated; pixel = slot + (tangent - left) / per_texel.
    const glm::dvec2 size{layout.size_px()};
    const glm::dvec2 origin{layout.slot_origin_px(slot)};
    const glm::dvec2 scale = 2.0 / (size * billboard.grid.per_texel);
    const glm::dvec2 offset{2.0 * origin.x / size.x - 1.0 - scale.x * billboard.grid.left,
                            1.0 - 2.0 * origin.y / size.y - scale.y * billboard.grid.up};
    const DepthCoding coding = depth_coding(billboard.nearest_m, billboard.farthest_m);
    PaintedView view;
    // z / w = (1 / w - offset) / scale.
    view.clip_x = glm::dvec4{right * scale.x + ahead * offset.x, 1.0 / coding.scale};
    view.clip_y = glm::dvec4{up * scale.y + ahead * offset.y, -coding.offset / coding.scale};
    view.clip_w = glm::dvec4{ahead, 0.0};
    return view;
}

std::optional<shader::BillboardRecord> warped_record(const DrawnBillboard& billboard, const AtlasLayout& layout,
                                                     int slot, const glm::dmat4& eye_now_from_eye_drawn,
                                                     const Camera& camera) {
    const Extent extent = extent_now(billboard, eye_now_from_eye_drawn);
    if (!(extent.nearest_m > camera.near_m)) return std::nullopt;
    const glm::dmat4 eye_drawn_from_eye_now = glm::inverse(eye_now_from_eye_drawn);
    const TexelGrid& grid = billboard.grid;
    // texel * distance from a place in the eye space of the drawing; columns.
    const glm::dmat3 texel_from_eye{{1.0 / grid.per_texel.x, 0.0, 0.0},
                                    {0.0, -1.0 / grid.per_texel.y, 0.0},
                                    {grid.left / grid.per_texel.x, -grid.up / grid.per_texel.y, -1.0}};
    const glm::dmat3 texel_from_ray = texel_from_eye * glm::dmat3{eye_drawn_from_eye_now};
    const glm::dvec3 texel_step = texel_from_eye * glm::dvec3{eye_drawn_from_eye_now[3]};

    shader::BillboardRecord record{};
    set_slot_and_depth(record, billboard, layout, slot);
    const glm::dmat3 rows = glm::transpose(texel_from_ray);
    record.texel_x = glm::dvec4{rows[0], texel_step.x};
    record.texel_y = glm::dvec4{rows[1], texel_step.y};
    record.texel_w = glm::dvec4{rows[2], texel_step.z};
    const double q_near = (1.0 + kRangePadding) / extent.nearest_m;
    const double q_far = (1.0 - kRangePadding) / extent.farthest_m;
    record.range = {static_cast<float>(q_near), static_cast<float>(q_far), 0.0f, 0.0f};
    const glm::dvec2 middle = 0.5 * (extent.tangent_min + extent.tangent_max);
    const double texels = texels_along(texel_from_ray, texel_step, middle, q_near, q_far);
    record.extent.w = static_cast<float>(
        std::clamp(std::ceil(std::isfinite(texels) ? texels : 1.0), 1.0, double{shader::kMaxReliefTexels}));

    // Any plane does; the nearest keeps the numbers small. What lies out of view is left out.
    const glm::dvec2 low = glm::max(extent.tangent_min, glm::dvec2{camera.fov.left, camera.fov.down});
    const glm::dvec2 high = glm::min(extent.tangent_max, glm::dvec2{camera.fov.right, camera.fov.up});
    const glm::dvec2 half = glm::max(0.5 * (high - low), glm::dvec2{0.0}) * extent.nearest_m;
    const glm::dvec2 centre = 0.5 * (low + high) * extent.nearest_m;
    record.centre = glm::dvec4{centre, -extent.nearest_m, half.x};
    record.extent.x = static_cast<float>(half.y);
    return record;
}

std::optional<shader::BillboardRecord> flat_record(const DrawnBillboard& billboard, const AtlasLayout& layout, int slot,
                                                   const glm::dmat4& eye_now_from_eye_drawn, const Camera& camera) {
    const BillboardPlane plane = plane_of(billboard.grid.window(), billboard.plane_m);
    const glm::dvec3 centre{eye_now_from_eye_drawn * glm::dvec4{plane.centre_eye, 1.0}};
    const double plane_now_m = -centre.z;
    if (!(corrected_distance_m(plane_now_m, billboard.nearest_m, billboard.plane_m) > camera.near_m)) {
        return std::nullopt;
    }
    shader::BillboardRecord record{};
    set_slot_and_depth(record, billboard, layout, slot);
    record.depth.z = static_cast<float>(plane_now_m - billboard.plane_m);
    record.centre = glm::dvec4{centre, plane.half_width_m};
    record.extent.x = static_cast<float>(plane.half_height_m);
    return record;
}

void leave_out_relief(const DrawnBillboard& billboard, shader::BillboardRecord& record) {
    record.depth.x = 0.0f;
    record.depth.y = static_cast<float>(1.0 / billboard.plane_m);
}

}  // namespace lw
