/// Vectors of boxes against a frustum and against an occlusion buffer: what the linear and the hierarchical test share.
/// Included by files that Highway compiles for every instruction set.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_CLIENT_RENDERER_BOX_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_CLIENT_RENDERER_BOX_KERNELS_H
#undef LW_CLIENT_RENDERER_BOX_KERNELS_H
#else
#define LW_CLIENT_RENDERER_BOX_KERNELS_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "client_renderer/box_block.h"
#include "client_renderer/box_list.h"
#include "client_renderer/occlusion_buffer.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<float, BoxBlock::kBoxes>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

inline constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(float);

/// Single precision: six products and sums of magnitudes below the sum used, each rounded by 6e-8, and the rounding of
/// the boxes themselves.
inline constexpr float kFrustumRounding = 2e-6F;
/// Places in the picture are off by up to 1/256 of its pixels, where GL snaps vertices, and by single precision: far
/// less than this share of a pixel of the buffer, for pictures of 256 pixels and more.
inline constexpr float kSnapPx = 0.02F;
/// Distances compare with this relative margin: single precision here and in the picture's depth.
inline constexpr float kDepthRounding = 1e-5F;
/// The reverse distance of what reaches before the near plane.
inline constexpr float kBeforeNear = 1e30F;
/// Boxes at least so many times as far away as they are deep are projected around their centre: nearer ones would get
/// rectangles much larger than they look.
inline constexpr float kFar = 4.0F;

/// One bit per lane, the first lane lowest.
HWY_INLINE std::uint32_t bits_of(MF mask) {
    if constexpr (hn::MaxLanes(DF{}) > 8) {
        std::uint16_t bits = 0;
        hn::StoreMaskBits(DF{}, mask, reinterpret_cast<std::uint8_t*>(&bits));
        return bits;
    } else {
        std::uint8_t bits = 0;
        hn::StoreMaskBits(DF{}, mask, &bits);
        return bits;
    }
}

/// @param count  at most 32
constexpr std::uint32_t lowest_bits(std::size_t count) { return count == 32 ? ~0U : (1U << count) - 1U; }

struct BoxVector {
    VF centre_x;
    VF centre_y;
    VF centre_z;
    VF half_x;
    VF half_y;
    VF half_z;
};

HWY_INLINE BoxVector load_boxes(const BoxList& boxes, std::size_t first) {
    const DF d;
    return {hn::LoadU(d, boxes.row(0) + first), hn::LoadU(d, boxes.row(1) + first), hn::LoadU(d, boxes.row(2) + first),
            hn::LoadU(d, boxes.row(3) + first), hn::LoadU(d, boxes.row(4) + first), hn::LoadU(d, boxes.row(5) + first)};
}

/// @param first  of the block's boxes, after a whole number of vectors
HWY_INLINE BoxVector load_boxes(const BoxBlock& block, std::size_t first) {
    const DF d;
    const auto row = [&](std::size_t which) HWY_ATTR { return hn::Load(d, block.rows[which].data() + first); };
    return {row(0), row(1), row(2), row(3), row(4), row(5)};
}

HWY_INLINE BoxVector gather_boxes(const BoxList& boxes, const std::uint32_t* indices, std::size_t count) {
    const DF d;
    HWY_ALIGN std::array<std::int32_t, kMaxLanes> lanes{};
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
        lanes[i] = static_cast<std::int32_t>(indices[std::min(i, count - 1)]);
    const auto at = hn::Load(DI{}, lanes.data());
    return {hn::GatherIndex(d, boxes.row(0), at), hn::GatherIndex(d, boxes.row(1), at),
            hn::GatherIndex(d, boxes.row(2), at), hn::GatherIndex(d, boxes.row(3), at),
            hn::GatherIndex(d, boxes.row(4), at), hn::GatherIndex(d, boxes.row(5), at)};
}

/// Of a vector of boxes from a plane, inside positive.
struct PlaneDistance {
    VF place;  ///< of the centres
    VF reach;  ///< of the boxes beyond their centres
    VF rounding;
};

HWY_INLINE PlaneDistance distance_of(const BoxVector& boxes, const FloatFrustum::Plane& plane) {
    const DF d;
    const VF nx = hn::Set(d, plane.x);
    const VF ny = hn::Set(d, plane.y);
    const VF nz = hn::Set(d, plane.z);
    const VF w = hn::Set(d, plane.w);
    const VF reach = hn::MulAdd(hn::Abs(nx), boxes.half_x,
                                hn::MulAdd(hn::Abs(ny), boxes.half_y, hn::Mul(hn::Abs(nz), boxes.half_z)));
    const VF place = hn::MulAdd(nx, boxes.centre_x, hn::MulAdd(ny, boxes.centre_y, hn::MulAdd(nz, boxes.centre_z, w)));
    const VF size = hn::Add(hn::Add(hn::Abs(boxes.centre_x), hn::Abs(boxes.centre_y)),
                            hn::Add(hn::Abs(boxes.centre_z), hn::Abs(w)));
    return {place, reach, hn::Mul(hn::Set(d, kFrustumRounding), hn::Add(size, reach))};
}

/// Boxes that are not empty and not wholly outside one of the frustum's planes whose bit is set.
HWY_INLINE MF in_frustum(const BoxVector& boxes, const FloatFrustum& frustum, unsigned planes) {
    const DF d;
    MF inside = hn::Ge(boxes.half_x, hn::Zero(d));
    for (; planes != 0; planes &= planes - 1) {
        const PlaneDistance distance =
            distance_of(boxes, frustum.planes[static_cast<std::size_t>(__builtin_ctz(planes))]);
        inside = hn::And(inside, hn::Ge(hn::Add(distance.place, distance.reach), hn::Neg(distance.rounding)));
    }
    return inside;
}

/// Boxes whose bounding sphere looks at least so large across, metres per metre of distance from the eye.
HWY_INLINE MF large_enough(const BoxVector& boxes, const std::array<float, 3>& eye, float least) {
    const DF d;
    const VF x = hn::Sub(boxes.centre_x, hn::Set(d, eye[0]));
    const VF y = hn::Sub(boxes.centre_y, hn::Set(d, eye[1]));
    const VF z = hn::Sub(boxes.centre_z, hn::Set(d, eye[2]));
    const VF distance_2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const VF radius_2 = hn::MulAdd(boxes.half_x, boxes.half_x,
                                   hn::MulAdd(boxes.half_y, boxes.half_y, hn::Mul(boxes.half_z, boxes.half_z)));
    return hn::Ge(hn::Mul(hn::Set(d, 4.0F), radius_2), hn::Mul(hn::Set(d, least * least), distance_2));
}

/// Where a vector of boxes lies in the buffer, in its pixels, and the reverse distance of their nearest points;
/// kBeforeNear where a box reaches before the near plane.
struct Projected {
    VF x0;
    VF x1;
    VF y0;
    VF y1;
    VF reverse;
};

/// What takes places p to the buffer: x_px * distance = dot(x_px.xyz, p) + x_px.w, and so on.
struct ProjectingRows {
    std::array<float, 4> x_px{};
    std::array<float, 4> y_px{};
    std::array<float, 4> distance{};
    std::array<float, 3> rounding{};  ///< what these three sums are off by at most
};

/// For places relative to the eye.
HWY_INLINE ProjectingRows projecting_rows(const OcclusionBuffer::View& view) {
    return {{view.x_px[0], view.x_px[1], view.x_px[2], 0.0F},
            {view.y_px[0], view.y_px[1], view.y_px[2], 0.0F},
            {view.distance[0], view.distance[1], view.distance[2], 0.0F},
            {}};
}

using Vector3 = std::array<VF, 3>;

HWY_INLINE VF affine(const std::array<float, 4>& row, const Vector3& v) {
    const DF d;
    return hn::MulAdd(hn::Set(d, row[0]), v[0],
                      hn::MulAdd(hn::Set(d, row[1]), v[1], hn::MulAdd(hn::Set(d, row[2]), v[2], hn::Set(d, row[3]))));
}

HWY_INLINE VF dot(const float* row, const Vector3& v) {
    const DF d;
    return hn::MulAdd(hn::Set(d, row[0]), v[0],
                      hn::MulAdd(hn::Set(d, row[1]), v[1], hn::Mul(hn::Set(d, row[2]), v[2])));
}

/// Projects boxes that are at least kFar times as far away as they are deep: to the rectangle around their centre's
/// place u that no corner leaves. A corner at d from the centre lies dot(x_row - u * z_row, d) / (z + dot(z_row, d))
/// beside u, so a box of half size h reaches at most dot(|x_row - u * z_row|, h) / (z - dot(|z_row|, h)): one division
/// for a box instead of one for each of its corners.
/// @return  lanes whose boxes are so far; the others' values mean nothing
HWY_INLINE MF project_from_afar(const Vector3& centre, const Vector3& half, const ProjectingRows& rows, float near_m,
                                Projected& projected) {
    const DF d;
    const VF one = hn::Set(d, 1.0F);
    const VF z = affine(rows.distance, centre);
    VF depth = hn::Set(d, rows.rounding[2]);
    for (std::size_t i = 0; i < 3; ++i) depth = hn::MulAdd(hn::Set(d, std::abs(rows.distance[i])), half[i], depth);
    const VF nearest = hn::Sub(z, depth);
    const VF per_both = hn::Div(one, hn::Mul(z, nearest));
    const VF per_z = hn::Mul(per_both, nearest);
    const VF per_nearest = hn::Mul(per_both, z);
    const auto place = [&](const std::array<float, 4>& row, float rounding, VF& low, VF& high) HWY_ATTR {
        const VF u = hn::Mul(affine(row, centre), per_z);
        VF reach = hn::MulAdd(hn::Abs(u), hn::Set(d, rows.rounding[2]), hn::Set(d, rounding));
        for (std::size_t i = 0; i < 3; ++i) {
            const VF across = hn::NegMulAdd(u, hn::Set(d, rows.distance[i]), hn::Set(d, row[i]));
            reach = hn::MulAdd(hn::Abs(across), half[i], reach);
        }
        low = hn::NegMulAdd(reach, per_nearest, u);
        high = hn::MulAdd(reach, per_nearest, u);
    };
    place(rows.x_px, rows.rounding[0], projected.x0, projected.x1);
    place(rows.y_px, rows.rounding[1], projected.y0, projected.y1);
    projected.reverse = hn::Mul(hn::Set(d, 1.0F + kDepthRounding), per_nearest);
    return hn::And(hn::Gt(nearest, hn::Set(d, near_m)), hn::Ge(z, hn::Mul(hn::Set(d, kFar), depth)));
}

/// The same, of boxes anywhere, by their corners.
HWY_INLINE Projected project_corners(const Vector3& centre, const Vector3& half, const OcclusionBuffer::View& view) {
    const DF d;
    const VF cx = dot(view.x_px.data(), centre);
    const VF cy = dot(view.y_px.data(), centre);
    const VF cz = dot(view.distance.data(), centre);
    VF x0 = hn::Set(d, 1e30F);
    VF y0 = x0;
    VF x1 = hn::Set(d, -1e30F);
    VF y1 = x1;
    VF nearest = hn::Set(d, 1e30F);
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vector3 offset = half;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((corner >> axis & 1U) != 0) offset[axis] = hn::Neg(half[axis]);
        }
        const VF z = hn::Add(cz, dot(view.distance.data(), offset));
        const VF per_z = hn::Div(hn::Set(d, 1.0F), z);
        const VF x = hn::Mul(hn::Add(cx, dot(view.x_px.data(), offset)), per_z);
        const VF y = hn::Mul(hn::Add(cy, dot(view.y_px.data(), offset)), per_z);
        nearest = hn::Min(nearest, z);
        x0 = hn::Min(x0, x);
        x1 = hn::Max(x1, x);
        y0 = hn::Min(y0, y);
        y1 = hn::Max(y1, y);
    }
    const MF behind = hn::Le(nearest, hn::Set(d, view.near_m));
    const VF reverse = hn::Div(hn::Set(d, 1.0F + kDepthRounding), nearest);
    return {x0, x1, y0, y1, hn::IfThenElse(behind, hn::Set(d, kBeforeNear), reverse)};
}

/// Lanes of `yes` where the mask is set, else of `no`: a box's rectangle does not depend on its neighbours.
HWY_INLINE Projected chosen(MF mask, const Projected& yes, const Projected& no) {
    return {hn::IfThenElse(mask, yes.x0, no.x0), hn::IfThenElse(mask, yes.x1, no.x1),
            hn::IfThenElse(mask, yes.y0, no.y0), hn::IfThenElse(mask, yes.y1, no.y1),
            hn::IfThenElse(mask, yes.reverse, no.reverse)};
}

/// @param lanes  bits of the boxes that count
HWY_INLINE Projected project(const BoxVector& boxes, const OcclusionBuffer::View& view, std::uint32_t lanes) {
    const DF d;
    const Vector3 centre{hn::Sub(boxes.centre_x, hn::Set(d, view.eye_world[0])),
                         hn::Sub(boxes.centre_y, hn::Set(d, view.eye_world[1])),
                         hn::Sub(boxes.centre_z, hn::Set(d, view.eye_world[2]))};
    Vector3 half{boxes.half_x, boxes.half_y, boxes.half_z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The box and the eye were rounded to single precision.
        const VF size = hn::Add(hn::Abs(centre[axis]), hn::Set(d, std::abs(view.eye_world[axis])));
        half[axis] = hn::MulAdd(size, hn::Set(d, 3e-7F), half[axis]);
    }
    Projected projected;
    const MF far = project_from_afar(centre, half, projecting_rows(view), view.near_m, projected);
    if ((lanes & ~bits_of(far)) == 0) return projected;
    return chosen(far, projected, project_corners(centre, half, view));
}

/// Of one box, in every lane. Its corners stand side by side in a vector where it is near.
HWY_INLINE Projected project_one(const glm::vec3& box_min, const glm::vec3& box_max,
                                 const OcclusionBuffer::View& view) {
    const DF all;
    const glm::vec3 eye_world{view.eye_world[0], view.eye_world[1], view.eye_world[2]};
    const glm::vec3 centre = 0.5F * (box_min + box_max) - eye_world;
    // The box and the eye were rounded to single precision, and so are these.
    const glm::vec3 half = 0.5F * (box_max - box_min) + 3e-7F * (glm::abs(centre) + glm::abs(eye_world));
    Projected projected;
    const MF far = project_from_afar({hn::Set(all, centre.x), hn::Set(all, centre.y), hn::Set(all, centre.z)},
                                     {hn::Set(all, half.x), hn::Set(all, half.y), hn::Set(all, half.z)},
                                     projecting_rows(view), view.near_m, projected);
    if (bits_of(far) != 0) return projected;

    const hn::CappedTag<float, 8> d;
    using V = hn::Vec<decltype(d)>;
    HWY_ALIGN static constexpr std::array<std::array<float, 8>, 3> kSigns{
        {{1, -1, 1, -1, 1, -1, 1, -1}, {1, 1, -1, -1, 1, 1, -1, -1}, {1, 1, 1, 1, -1, -1, -1, -1}}};
    const auto at_centre = [&](const std::array<float, 3>& row) {
        return row[0] * centre[0] + row[1] * centre[1] + row[2] * centre[2];
    };
    V x0 = hn::Set(d, 1e30F);
    V y0 = x0;
    V x1 = hn::Set(d, -1e30F);
    V y1 = x1;
    V nearest = x0;
    for (std::size_t corner = 0; corner < 8; corner += hn::Lanes(d)) {
        const V sx = hn::Load(d, kSigns[0].data() + corner);
        const V sy = hn::Load(d, kSigns[1].data() + corner);
        const V sz = hn::Load(d, kSigns[2].data() + corner);
        const auto at_corners = [&](const std::array<float, 3>& row) HWY_ATTR {
            return hn::MulAdd(hn::Set(d, row[0] * half[0]), sx,
                              hn::MulAdd(hn::Set(d, row[1] * half[1]), sy,
                                         hn::MulAdd(hn::Set(d, row[2] * half[2]), sz, hn::Set(d, at_centre(row)))));
        };
        const V z = at_corners(view.distance);
        const V per_z = hn::Div(hn::Set(d, 1.0F), z);
        const V x = hn::Mul(at_corners(view.x_px), per_z);
        const V y = hn::Mul(at_corners(view.y_px), per_z);
        nearest = hn::Min(nearest, z);
        x0 = hn::Min(x0, x);
        x1 = hn::Max(x1, x);
        y0 = hn::Min(y0, y);
        y1 = hn::Max(y1, y);
    }
    const float nearest_m = hn::GetLane(hn::MinOfLanes(d, nearest));
    const float reverse = nearest_m > view.near_m ? (1.0F + kDepthRounding) / nearest_m : kBeforeNear;
    return {hn::Set(all, hn::GetLane(hn::MinOfLanes(d, x0))), hn::Set(all, hn::GetLane(hn::MaxOfLanes(d, x1))),
            hn::Set(all, hn::GetLane(hn::MinOfLanes(d, y0))), hn::Set(all, hn::GetLane(hn::MaxOfLanes(d, y1))),
            hn::Set(all, reverse)};
}

/// Lanes whose boxes reach into the picture, or before the near plane.
HWY_INLINE MF in_picture(const Projected& projected, const OcclusionBuffer::View& view) {
    const DF d;
    const auto inside = [&](VF low, VF high, float size) HWY_ATTR {
        return hn::And(hn::Ge(high, hn::Set(d, -kSnapPx)), hn::Le(low, hn::Set(d, size + kSnapPx)));
    };
    const MF before_near = hn::Ge(projected.reverse, hn::Set(d, kBeforeNear));
    return hn::Or(before_near, hn::And(inside(projected.x0, projected.x1, view.size_px[0]),
                                       inside(projected.y0, projected.y1, view.size_px[1])));
}

/// Lanes whose boxes have a sample of the picture in the rectangle around them. The others fall between the samples:
/// nothing of them is drawn.
HWY_INLINE MF meets_sample(const Projected& projected, const OcclusionBuffer::View& view) {
    const DF d;
    const auto meets = [&](VF low, VF high, float samples_per_px) HWY_ATTR {
        const VF scale = hn::Set(d, samples_per_px);
        const float snap = kSnapPx * samples_per_px;
        const VF first = hn::Ceil(hn::MulAdd(low, scale, hn::Set(d, -snap - 0.5F)));
        const VF last = hn::Floor(hn::MulAdd(high, scale, hn::Set(d, snap - 0.5F)));
        return hn::Le(first, last);
    };
    const MF before_near = hn::Ge(projected.reverse, hn::Set(d, kBeforeNear));
    return hn::Or(before_near, hn::And(meets(projected.x0, projected.x1, view.samples_per_px[0]),
                                       meets(projected.y0, projected.y1, view.samples_per_px[1])));
}

/// Whether a tile hides at `reverse` and beyond all parts of its pixels within a rectangle of parts (first x, first y,
/// last x, last y).
HWY_INLINE bool tile_hides(const OcclusionBuffer& buffer, glm::ivec2 tile_px, glm::ivec4 rect, float reverse) {
    const DF d;
    const DI di;
    constexpr int kParts = OcclusionBuffer::kParts;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const VF limit = hn::Set(d, reverse);
    const auto none = hn::Zero(di);
    const auto all = hn::Set(di, kParts);
    const auto one = hn::Set(di, 1);
    const int row0 = std::max(rect.y / kParts, tile_px.y);
    const int row1 = std::min(rect.w / kParts, tile_px.y + OcclusionBuffer::kTileY - 1);
    for (int x = tile_px.x; x < tile_px.x + OcclusionBuffer::kTileX; x += lanes) {
        if (kParts * (x + lanes) <= rect.x || kParts * x > rect.z) continue;
        const auto first_part = hn::Mul(hn::Iota(di, x), all);
        const auto begin = hn::Min(hn::Max(hn::Sub(hn::Set(di, rect.x), first_part), none), all);
        const auto end = hn::Min(hn::Max(hn::Sub(hn::Set(di, rect.z + 1), first_part), none), all);
        const auto columns = hn::Max(hn::Sub(hn::Shl(one, end), hn::Shl(one, begin)), none);
        for (int y = row0; y <= row1; ++y) {
            const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * buffer.stride() + x;
            const auto open = hn::RebindMask(di, hn::Le(hn::LoadU(d, buffer.pixels() + at), limit));
            const auto wanted_columns = hn::IfThenElseZero(open, columns);
            if (hn::AllTrue(di, hn::Eq(wanted_columns, none))) continue;
            int rows = 0;
            for (int r = std::max(rect.y - kParts * y, 0); r <= std::min(rect.w - kParts * y, kParts - 1); ++r) {
                rows |= 1 << (kParts * r);
            }
            const auto wanted = hn::Mul(wanted_columns, hn::Set(di, rows));
            const auto near_parts = hn::RebindMask(di, hn::Gt(hn::LoadU(d, buffer.parts() + at), limit));
            const auto hidden = hn::IfThenElseZero(near_parts, hn::LoadU(di, buffer.masks() + at));
            if (!hn::AllTrue(di, hn::Eq(hn::AndNot(hidden, wanted), none))) return false;
        }
    }
    return true;
}

/// Rectangles of boxes in the buffer, to take them out of one by one.
struct StoredRects {
    StoredRects(const Projected& boxes, const OcclusionBuffer& buffer) {
        const DF d;
        const DI di;
        const VF parts = hn::Set(d, static_cast<float>(OcclusionBuffer::kParts));
        const VF snap = hn::Set(d, OcclusionBuffer::kParts * kSnapPx);
        const auto store = [&](VF place, int last, std::array<std::int32_t, kMaxLanes>& to) HWY_ATTR {
            const VF inside = hn::Min(hn::Max(place, hn::Zero(d)), hn::Set(d, static_cast<float>(last)));
            hn::Store(hn::ConvertTo(di, inside), di, to.data());
        };
        const int last_x = OcclusionBuffer::kParts * buffer.size_px().x - 1;
        const int last_y = OcclusionBuffer::kParts * buffer.size_px().y - 1;
        store(hn::MulSub(parts, boxes.x0, snap), last_x, x0);
        store(hn::MulSub(parts, boxes.y0, snap), last_y, y0);
        store(hn::MulAdd(parts, boxes.x1, snap), last_x, x1);
        store(hn::MulAdd(parts, boxes.y1, snap), last_y, y1);
        hn::Store(boxes.reverse, d, reverse.data());
    }
    // In parts of pixels, the last included.
    HWY_ALIGN std::array<std::int32_t, kMaxLanes> x0;
    HWY_ALIGN std::array<std::int32_t, kMaxLanes> y0;
    HWY_ALIGN std::array<std::int32_t, kMaxLanes> x1;
    HWY_ALIGN std::array<std::int32_t, kMaxLanes> y1;
    HWY_ALIGN std::array<float, kMaxLanes> reverse;
};

/// Whether every pixel of the buffer that a box may touch hides what is at its nearest point and beyond.
HWY_INLINE bool is_hidden(const OcclusionBuffer& buffer, const StoredRects& rects, std::size_t box) {
    constexpr int kParts = OcclusionBuffer::kParts;
    const glm::ivec4 rect{rects.x0[box], rects.y0[box], rects.x1[box], rects.y1[box]};
    const float reverse = rects.reverse[box];
    // Most of what is seen is seen in the middle.
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>((rect.y + rect.w) / (2 * kParts)) * buffer.stride() +
                              (rect.x + rect.z) / (2 * kParts);
    const bool part_hides = buffer.masks()[at] != 0 && buffer.parts()[at] > reverse;
    if (buffer.pixels()[at] <= reverse && !part_hides) return false;
    constexpr int kTileX = OcclusionBuffer::kTileX;
    constexpr int kTileY = OcclusionBuffer::kTileY;
    for (int ty = rect.y / kParts / kTileY; ty <= rect.w / kParts / kTileY; ++ty) {
        for (int tx = rect.x / kParts / kTileX; tx <= rect.z / kParts / kTileX; ++tx) {
            const OcclusionBuffer::Tile& tile = buffer.tiles()[ty * buffer.tile_stride() + tx];
            if (tile.farthest > reverse) continue;
            if (tile.nearest <= reverse) return false;
            if (!tile_hides(buffer, {tx * kTileX, ty * kTileY}, rect, reverse)) return false;
        }
    }
    return true;
}

/// Of the boxes whose bits are set, the bits of those that are hidden or lie beside the picture: the test of the field
/// of view is coarser than their rectangles.
HWY_INLINE std::uint32_t hidden_of(const OcclusionBuffer& buffer, const Projected& boxes, std::uint32_t bits) {
    const DF d;
    bits &= bits_of(hn::Lt(boxes.reverse, hn::Set(d, kBeforeNear)));
    std::uint32_t hidden = bits & ~bits_of(in_picture(boxes, buffer.view()));
    std::uint32_t rest = bits & ~hidden;
    if (rest == 0) return hidden;
    const StoredRects rects{boxes, buffer};
    for (; rest != 0; rest &= rest - 1) {
        const auto box = static_cast<std::size_t>(__builtin_ctz(rest));
        if (is_hidden(buffer, rects, box)) hidden |= 1U << box;
    }
    return hidden;
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
