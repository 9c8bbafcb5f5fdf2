#include "client_renderer/occlusion_buffer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/occlusion_buffer.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "client_renderer/box_kernels.h"

#ifndef LW_OCCLUSION_BUFFER_ONCE
#define LW_OCCLUSION_BUFFER_ONCE
namespace lw {

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

void draw_here(const ProjectedSolid& solid, glm::ivec2 size_px, glm::ivec2 rows, int stride, float* pixels) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int y = rows.x; y <= rows.y; ++y) {
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

void split_here(const OcclusionBuffer& buffer, const BoxList& boxes, std::span<const std::uint32_t> candidates,
                std::vector<std::uint32_t>& seen, std::vector<std::uint32_t>& hidden) {
    const std::size_t lanes = hn::Lanes(DF{});
    Projected projected;
    for (std::size_t first = 0; first < candidates.size(); first += lanes) {
        const std::size_t count = std::min(lanes, candidates.size() - first);
        project(gather_boxes(boxes, candidates.data() + first, count), buffer.view(), projected);
        for (std::size_t i = 0; i < count; ++i) {
            (is_hidden(buffer, projected, i) ? hidden : seen).push_back(candidates[first + i]);
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
    const double slack = (0.5 + HWY_NAMESPACE::kSnapPx) * (std::abs(affine.x) + std::abs(affine.y));
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

void OcclusionBuffer::add(const ConvexSolid& solid, const scene::Bounds& bounds_world) {
    double top = size_px_.y;
    double bottom = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1U) != 0 ? bounds_world.max.x : bounds_world.min.x,
                               (corner & 2U) != 0 ? bounds_world.max.y : bounds_world.min.y,
                               (corner & 4U) != 0 ? bounds_world.max.z : bounds_world.min.z};
        const glm::dvec3 relative = point - eye_world_;
        double distance = 0.0;
        double y = 0.0;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            distance += double{view_.distance[k]} * relative[i];
            y += double{view_.y_px[k]} * relative[i];
        }
        if (distance < view_.near_m) return add(solid, 0, size_px_.y - 1);
        top = std::min(top, y / distance);
        bottom = std::max(bottom, y / distance);
    }
    // A row too many costs nothing, one too few only hides less.
    const double last = size_px_.y - 1;
    add(solid, static_cast<int>(std::clamp(top - 1.0, 0.0, last)),
        static_cast<int>(std::clamp(bottom + 1.0, -1.0, last)));
}

void OcclusionBuffer::add(const ConvexSolid& solid, int first_row, int last_row) {
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
    HWY_DYNAMIC_DISPATCH(draw_here)(projected, size_px_, {first_row, last_row}, stride_, pixels_.data());
}

void OcclusionBuffer::finish() { HWY_DYNAMIC_DISPATCH(reduce_here)(pixels_.data(), stride_, rows_, tiles_.data()); }

void OcclusionBuffer::split(const BoxList& boxes, std::span<const std::uint32_t> candidates,
                            std::vector<std::uint32_t>& seen, std::vector<std::uint32_t>& hidden) const {
    HWY_DYNAMIC_DISPATCH(split_here)(*this, boxes, candidates, seen, hidden);
}

}  // namespace lw
#endif
