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

#include "client_renderer/box_list.h"
#include "client_renderer/occlusion_buffer.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
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

/// Boxes that are not empty and not wholly outside one of the frustum's planes whose bit is set.
HWY_INLINE MF in_frustum(const BoxVector& boxes, const FloatFrustum& frustum, unsigned planes) {
    const DF d;
    MF inside = hn::Ge(boxes.half_x, hn::Zero(d));
    for (; planes != 0; planes &= planes - 1) {
        const FloatFrustum::Plane& plane = frustum.planes[static_cast<std::size_t>(__builtin_ctz(planes))];
        const VF nx = hn::Set(d, plane.x);
        const VF ny = hn::Set(d, plane.y);
        const VF nz = hn::Set(d, plane.z);
        const VF w = hn::Set(d, plane.w);
        const VF reach = hn::MulAdd(hn::Abs(nx), boxes.half_x,
                                    hn::MulAdd(hn::Abs(ny), boxes.half_y, hn::Mul(hn::Abs(nz), boxes.half_z)));
        const VF place =
            hn::MulAdd(nx, boxes.centre_x, hn::MulAdd(ny, boxes.centre_y, hn::MulAdd(nz, boxes.centre_z, w)));
        const VF size = hn::Add(hn::Add(hn::Abs(boxes.centre_x), hn::Abs(boxes.centre_y)),
                                hn::Add(hn::Abs(boxes.centre_z), hn::Abs(w)));
        const VF allowed = hn::Mul(hn::Set(d, -kFrustumRounding), hn::Add(size, reach));
        inside = hn::And(inside, hn::Ge(hn::Add(place, reach), allowed));
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

/// Where a vector of boxes lies in the buffer, in its pixels, and the reverse distance of their nearest points; 1e30
/// where a box reaches before the near plane.
struct Projected {
    HWY_ALIGN std::array<float, kMaxLanes> x0;
    HWY_ALIGN std::array<float, kMaxLanes> x1;
    HWY_ALIGN std::array<float, kMaxLanes> y0;
    HWY_ALIGN std::array<float, kMaxLanes> y1;
    HWY_ALIGN std::array<float, kMaxLanes> reverse;
};

HWY_INLINE void project(const BoxVector& boxes, const OcclusionBuffer::View& view, Projected& projected) {
    const DF d;
    std::array<VF, 3> centre{hn::Sub(boxes.centre_x, hn::Set(d, view.eye_world[0])),
                             hn::Sub(boxes.centre_y, hn::Set(d, view.eye_world[1])),
                             hn::Sub(boxes.centre_z, hn::Set(d, view.eye_world[2]))};
    std::array<VF, 3> half{boxes.half_x, boxes.half_y, boxes.half_z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The box and the eye were rounded to single precision.
        const VF size = hn::Add(hn::Abs(centre[axis]), hn::Set(d, std::abs(view.eye_world[axis])));
        half[axis] = hn::MulAdd(size, hn::Set(d, 3e-7F), half[axis]);
    }
    const auto dot = [&](const std::array<float, 3>& row, const std::array<VF, 3>& v) HWY_ATTR {
        return hn::MulAdd(hn::Set(d, row[0]), v[0],
                          hn::MulAdd(hn::Set(d, row[1]), v[1], hn::Mul(hn::Set(d, row[2]), v[2])));
    };
    const VF cx = dot(view.x_px, centre);
    const VF cy = dot(view.y_px, centre);
    const VF cz = dot(view.distance, centre);
    VF x0 = hn::Set(d, 1e30F);
    VF y0 = x0;
    VF x1 = hn::Set(d, -1e30F);
    VF y1 = x1;
    VF nearest = hn::Set(d, 1e30F);
    for (unsigned corner = 0; corner < 8; ++corner) {
        std::array<VF, 3> offset = half;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((corner >> axis & 1U) != 0) offset[axis] = hn::Neg(half[axis]);
        }
        const VF z = hn::Add(cz, dot(view.distance, offset));
        const VF per_z = hn::Div(hn::Set(d, 1.0F), z);
        const VF x = hn::Mul(hn::Add(cx, dot(view.x_px, offset)), per_z);
        const VF y = hn::Mul(hn::Add(cy, dot(view.y_px, offset)), per_z);
        nearest = hn::Min(nearest, z);
        x0 = hn::Min(x0, x);
        x1 = hn::Max(x1, x);
        y0 = hn::Min(y0, y);
        y1 = hn::Max(y1, y);
    }
    const MF behind = hn::Le(nearest, hn::Set(d, view.near_m));
    const VF reverse = hn::Div(hn::Set(d, 1.0F + kDepthRounding), nearest);
    hn::Store(x0, d, projected.x0.data());
    hn::Store(x1, d, projected.x1.data());
    hn::Store(y0, d, projected.y0.data());
    hn::Store(y1, d, projected.y1.data());
    hn::Store(hn::IfThenElse(behind, hn::Set(d, 1e30F), reverse), d, projected.reverse.data());
}

/// True when every pixel of the buffer that box `i` may touch hides what is at its nearest point and beyond. A box that
/// touches none is not hidden: that is the frustum's business.
HWY_INLINE bool is_hidden(const OcclusionBuffer& buffer, const Projected& projected, std::size_t i) {
    const DF d;
    const float reverse = projected.reverse[i];
    if (!(reverse < 1e29F)) return false;
    // In front of the eye and beside the picture: the test of the field of view is coarser than this rectangle.
    const bool beside = projected.x1[i] + kSnapPx < 0.0F || projected.y1[i] + kSnapPx < 0.0F ||
                        projected.x0[i] - kSnapPx > static_cast<float>(buffer.size_px().x) ||
                        projected.y0[i] - kSnapPx > static_cast<float>(buffer.size_px().y);
    if (beside) return true;
    const float last_x = static_cast<float>(buffer.size_px().x) - 0.5F;
    const float last_y = static_cast<float>(buffer.size_px().y) - 0.5F;
    const float left = std::clamp(projected.x0[i] - kSnapPx, 0.0F, last_x);
    const float right = std::clamp(projected.x1[i] + kSnapPx, 0.0F, last_x);
    const float top = std::clamp(projected.y0[i] - kSnapPx, 0.0F, last_y);
    const float bottom = std::clamp(projected.y1[i] + kSnapPx, 0.0F, last_y);
    const int x0 = static_cast<int>(left);
    const int x1 = static_cast<int>(right);
    const int y0 = static_cast<int>(top);
    const int y1 = static_cast<int>(bottom);
    const int lanes = static_cast<int>(hn::Lanes(d));
    constexpr int kTileX = OcclusionBuffer::kTileX;
    constexpr int kTileY = OcclusionBuffer::kTileY;
    const VF limit = hn::Set(d, reverse);
    const VF first = hn::Set(d, static_cast<float>(x0));
    const VF last = hn::Set(d, static_cast<float>(x1));
    for (int ty = y0 / kTileY; ty <= y1 / kTileY; ++ty) {
        const int row0 = std::max(y0, ty * kTileY);
        const int row1 = std::min(y1, ty * kTileY + kTileY - 1);
        for (int tx = x0 / kTileX; tx <= x1 / kTileX; ++tx) {
            if (buffer.tiles()[ty * buffer.tile_stride() + tx] > reverse) continue;
            for (int x = tx * kTileX; x < tx * kTileX + kTileX; x += lanes) {
                const VF xi = hn::Iota(d, static_cast<float>(x));
                const MF in_rect = hn::And(hn::Ge(xi, first), hn::Le(xi, last));
                for (int y = row0; y <= row1; ++y) {
                    const float* row = buffer.pixels() + static_cast<std::ptrdiff_t>(y) * buffer.stride();
                    if (!hn::AllFalse(d, hn::And(in_rect, hn::Le(hn::LoadU(d, row + x), limit)))) return false;
                }
            }
        }
    }
    return true;
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
