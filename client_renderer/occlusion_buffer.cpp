#include "client_renderer/occlusion_buffer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/occlusion_buffer.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#ifndef LW_OCCLUSION_BUFFER_ONCE
#define LW_OCCLUSION_BUFFER_ONCE
namespace lw {

// Places in the picture are off by up to 1/256 of its pixels, where GL snaps vertices, and by single precision: far
// less than this share of a pixel of the buffer for pictures of 256 pixels and more.
inline constexpr float kSnapPx = 0.02F;
// Distances compare with this relative margin: single precision here and in the picture's depth.
inline constexpr float kDepthRounding = 1e-5F;

/// value = x * per_x + y * per_y + constant, in pixels of the buffer.
struct Affine {
    float per_x = 0.0F;
    float per_y = 0.0F;
    float constant = 0.0F;
};

/// A solid as it is drawn: covered where all `insides` are >= 0, reverse distance the least of the `fronts`.
struct ProjectedSolid {
    std::array<Affine, 12> insides{};
    int inside_count = 0;
    std::array<Affine, 3> fronts{};
    int front_count = 0;
};

}  // namespace lw
#endif

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;

void draw_here(const ProjectedSolid& solid, glm::ivec2 size_px, int stride, float* pixels) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int y = 0; y < size_px.y; ++y) {
        // The run of whole pixels inside all half planes.
        float low = 0.0F;
        auto high = static_cast<float>(size_px.x - 1);
        const float yc = static_cast<float>(y) + 0.5F;
        for (int i = 0; i < solid.inside_count; ++i) {
            const Affine& inside = solid.insides[static_cast<std::size_t>(i)];
            const float rest = inside.per_y * yc + inside.constant + 0.5F * inside.per_x;
            if (inside.per_x > 0.0F) {
                low = std::max(low, std::ceil(-rest / inside.per_x));
            } else if (inside.per_x < 0.0F) {
                high = std::min(high, std::floor(-rest / inside.per_x));
            } else if (rest < 0.0F) {
                high = -1.0F;
            }
        }
        if (!(low <= high)) continue;
        const auto x0 = static_cast<int>(low);
        const auto x1 = static_cast<int>(high);
        float* row = pixels + static_cast<std::ptrdiff_t>(y) * stride;
        for (int x = x0 - x0 % lanes; x <= x1; x += lanes) {
            const VF xi = hn::Iota(d, static_cast<float>(x));
            const auto in_run =
                hn::And(hn::Ge(xi, hn::Set(d, static_cast<float>(x0))), hn::Le(xi, hn::Set(d, static_cast<float>(x1))));
            const VF xc = hn::Add(xi, hn::Set(d, 0.5F));
            VF reverse = hn::Set(d, 1e30F);
            for (int i = 0; i < solid.front_count; ++i) {
                const Affine& front = solid.fronts[static_cast<std::size_t>(i)];
                const VF value = hn::MulAdd(xc, hn::Set(d, front.per_x), hn::Set(d, front.per_y * yc + front.constant));
                reverse = hn::Min(reverse, value);
            }
            const VF before = hn::LoadU(d, row + x);
            hn::StoreU(hn::IfThenElse(in_run, hn::Max(before, reverse), before), d, row + x);
        }
    }
}

void reduce_here(const float* pixels, int stride, int rows, float* tiles) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    constexpr int kTileX = OcclusionBuffer::kTileX;
    constexpr int kTileY = OcclusionBuffer::kTileY;
    const int tile_stride = stride / kTileX;
    for (int ty = 0; ty < rows / kTileY; ++ty) {
        for (int tx = 0; tx < tile_stride; ++tx) {
            VF least = hn::Set(d, 1e30F);
            for (int y = 0; y < kTileY; ++y) {
                const float* row = pixels + static_cast<std::ptrdiff_t>(ty * kTileY + y) * stride + tx * kTileX;
                for (int x = 0; x < kTileX; x += lanes) least = hn::Min(least, hn::LoadU(d, row + x));
            }
            tiles[ty * tile_stride + tx] = hn::GetLane(hn::MinOfLanes(d, least));
        }
    }
}

struct Rect {
    int x0;
    int x1;
    int y0;
    int y1;
};

/// True when every pixel of a rectangle hides what is at `reverse` and beyond.
bool hides(const float* pixels, int stride, const float* tiles, const Rect& rect, float reverse) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    constexpr int kTileX = OcclusionBuffer::kTileX;
    constexpr int kTileY = OcclusionBuffer::kTileY;
    const int tile_stride = stride / kTileX;
    const VF limit = hn::Set(d, reverse);
    const VF left = hn::Set(d, static_cast<float>(rect.x0));
    const VF right = hn::Set(d, static_cast<float>(rect.x1));
    for (int ty = rect.y0 / kTileY; ty <= rect.y1 / kTileY; ++ty) {
        const int y0 = std::max(rect.y0, ty * kTileY);
        const int y1 = std::min(rect.y1, ty * kTileY + kTileY - 1);
        for (int tx = rect.x0 / kTileX; tx <= rect.x1 / kTileX; ++tx) {
            if (tiles[ty * tile_stride + tx] > reverse) continue;
            for (int x = tx * kTileX; x < tx * kTileX + kTileX; x += lanes) {
                const VF xi = hn::Iota(d, static_cast<float>(x));
                const auto in_rect = hn::And(hn::Ge(xi, left), hn::Le(xi, right));
                for (int y = y0; y <= y1; ++y) {
                    const VF hidden_beyond = hn::LoadU(d, pixels + static_cast<std::ptrdiff_t>(y) * stride + x);
                    if (!hn::AllFalse(d, hn::And(in_rect, hn::Le(hidden_beyond, limit)))) return false;
                }
            }
        }
    }
    return true;
}

constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(float);

/// Rectangles and nearest reverse distances of up to one vector of boxes; 1e30 where a box reaches before the near
/// plane.
struct Projected {
    HWY_ALIGN std::array<float, kMostLanes> x0;
    HWY_ALIGN std::array<float, kMostLanes> x1;
    HWY_ALIGN std::array<float, kMostLanes> y0;
    HWY_ALIGN std::array<float, kMostLanes> y1;
    HWY_ALIGN std::array<float, kMostLanes> reverse;
};

void project(const BoxList& boxes, const std::uint32_t* indices, std::size_t count, const OcclusionBuffer::View& view,
             Projected& projected) {
    const DF d;
    const DI di;
    HWY_ALIGN std::array<std::int32_t, kMostLanes> lane_indices{};
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
        lane_indices[i] = static_cast<std::int32_t>(indices[std::min(i, count - 1)]);
    }
    const auto at = hn::Load(di, lane_indices.data());
    std::array<VF, 3> centre{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    std::array<VF, 3> half{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centre[axis] =
            hn::Sub(hn::GatherIndex(d, boxes.row(static_cast<int>(axis)), at), hn::Set(d, view.eye_world[axis]));
        half[axis] = hn::GatherIndex(d, boxes.row(static_cast<int>(axis) + 3), at);
        // The box and the eye were rounded to single precision.
        const VF size = hn::Add(hn::Abs(centre[axis]), hn::Set(d, std::abs(view.eye_world[axis])));
        half[axis] = hn::MulAdd(size, hn::Set(d, 3e-7F), half[axis]);
    }
    const auto dot = [&](const std::array<float, 3>& row, const std::array<VF, 3>& v) {
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
    const auto behind = hn::Le(nearest, hn::Set(d, view.near_m));
    const VF reverse = hn::Div(hn::Set(d, 1.0F + kDepthRounding), nearest);
    hn::Store(x0, d, projected.x0.data());
    hn::Store(x1, d, projected.x1.data());
    hn::Store(y0, d, projected.y0.data());
    hn::Store(y1, d, projected.y1.data());
    hn::Store(hn::IfThenElse(behind, hn::Set(d, 1e30F), reverse), d, projected.reverse.data());
}

void split_here(const OcclusionBuffer& buffer, const BoxList& boxes, std::span<const std::uint32_t> candidates,
                std::vector<std::uint32_t>& seen, std::vector<std::uint32_t>& hidden) {
    const std::size_t lanes = hn::Lanes(DF{});
    const auto width = static_cast<float>(buffer.size_px().x);
    const auto height = static_cast<float>(buffer.size_px().y);
    Projected projected;
    for (std::size_t first = 0; first < candidates.size(); first += lanes) {
        const std::size_t count = std::min(lanes, candidates.size() - first);
        project(boxes, candidates.data() + first, count, buffer.view(), projected);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t index = candidates[first + i];
            // Outside the picture it is not seen; that is the frustum's business, so such a box counts as seen here.
            const float x0 = std::max(projected.x0[i] - kSnapPx, 0.0F);
            const float x1 = std::min(projected.x1[i] + kSnapPx, width - 0.5F);
            const float y0 = std::max(projected.y0[i] - kSnapPx, 0.0F);
            const float y1 = std::min(projected.y1[i] + kSnapPx, height - 0.5F);
            const bool is_hidden =
                projected.reverse[i] < 1e29F && x0 <= x1 && y0 <= y1 &&
                hides(buffer.pixels(), buffer.stride(), buffer.tiles(),
                      {static_cast<int>(x0), static_cast<int>(x1), static_cast<int>(y0), static_cast<int>(y1)},
                      projected.reverse[i]);
            (is_hidden ? hidden : seen).push_back(index);
        }
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(draw_here);
HWY_EXPORT(reduce_here);
HWY_EXPORT(split_here);

namespace {

int rounded_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

/// Least value anywhere in the pixel whose centre it is evaluated at.
Affine least_in_pixel(const glm::dvec3& affine) {
    const double slack = (0.5 + kSnapPx) * (std::abs(affine.x) + std::abs(affine.y));
    // Single precision at the far end of the buffer.
    const double rounding = 4e-7 * (256.0 * (std::abs(affine.x) + std::abs(affine.y)) + std::abs(affine.z));
    return {static_cast<float>(affine.x), static_cast<float>(affine.y),
            static_cast<float>(affine.z - slack - rounding)};
}

}  // namespace

void OcclusionBuffer::begin(const Camera& camera) {
    const double longest = std::max(camera.size_px.x, camera.size_px.y);
    const double scale = std::min(1.0, kLongestSide_px / longest);
    size_px_ = glm::max(glm::ivec2{glm::ceil(glm::dvec2{camera.size_px} * scale)}, 1);
    stride_ = rounded_up(size_px_.x, 16 * kTileX / 16);
    rows_ = rounded_up(size_px_.y, kTileY);
    pixels_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_) + 64, 0.0F);
    tiles_.assign(static_cast<std::size_t>(stride_ / kTileX) * static_cast<std::size_t>(rows_ / kTileY), 0.0F);

    const glm::dmat3 axes = glm::mat3_cast(camera.world_from_eye.orientation);
    const FovTangents& fov = camera.fov;
    const glm::dvec2 tan_per_px{(fov.right - fov.left) / size_px_.x, (fov.up - fov.down) / size_px_.y};
    eye_world_ = camera.world_from_eye.position_m;
    rays_.origin = axes * glm::dvec3{fov.left, fov.up, -1.0};
    rays_.per_px_x = axes[0] * tan_per_px.x;
    rays_.per_px_y = axes[1] * -tan_per_px.y;
    const glm::dvec3 forward = -axes[2];
    const glm::dvec3 x_px = (axes[0] - forward * fov.left) / tan_per_px.x;
    const glm::dvec3 y_px = (forward * fov.up - axes[1]) / tan_per_px.y;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        view_.eye_world[k] = static_cast<float>(eye_world_[i]);
        view_.x_px[k] = static_cast<float>(x_px[i]);
        view_.y_px[k] = static_cast<float>(y_px[i]);
        view_.distance[k] = static_cast<float>(forward[i]);
    }
    view_.near_m = static_cast<float>(camera.near_m);
}

void OcclusionBuffer::add(const ConvexSolid& solid) {
    // Along the ray of a pixel, at reverse distance u, plane i is met where u = dot(normal, ray) / offset: affine in
    // the pixel. Planes that face the eye bound u from above, the others from below.
    std::array<glm::dvec3, 6> met{};
    std::array<bool, 6> faces_eye{};
    for (std::size_t i = 0; i < 6; ++i) {
        const glm::dvec3 normal{solid.planes_world[i]};
        const double offset = solid.planes_world[i].w - glm::dot(normal, eye_world_);
        if (std::abs(offset) < 1e-4) return;  // edge-on
        faces_eye[i] = offset < 0.0;
        met[i] = glm::dvec3{glm::dot(normal, rays_.per_px_x), glm::dot(normal, rays_.per_px_y),
                            glm::dot(normal, rays_.origin)} /
                 offset;
    }
    ProjectedSolid projected;
    for (std::size_t front = 0; front < 6; ++front) {
        if (!faces_eye[front] || projected.front_count == 3) continue;
        const Affine reverse = least_in_pixel(met[front]);
        projected.fronts[static_cast<std::size_t>(projected.front_count++)] = reverse;
        projected.insides[static_cast<std::size_t>(projected.inside_count++)] = reverse;
        for (std::size_t back = 0; back < 6; ++back) {
            if (faces_eye[back]) continue;
            projected.insides[static_cast<std::size_t>(projected.inside_count++)] =
                least_in_pixel(met[front] - met[back]);
        }
    }
    if (projected.front_count == 0) return;
    HWY_DYNAMIC_DISPATCH(draw_here)(projected, size_px_, stride_, pixels_.data());
}

void OcclusionBuffer::finish() { HWY_DYNAMIC_DISPATCH(reduce_here)(pixels_.data(), stride_, rows_, tiles_.data()); }

void OcclusionBuffer::split(const BoxList& boxes, std::span<const std::uint32_t> candidates,
                            std::vector<std::uint32_t>& seen, std::vector<std::uint32_t>& hidden) const {
    HWY_DYNAMIC_DISPATCH(split_here)(*this, boxes, candidates, seen, hidden);
}

}  // namespace lw
#endif
