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

/// A solid as it is drawn: part of a pixel is covered where all `insides` are >= 0, in parts of pixels; the reverse
/// distance is the least of the `fronts`, in whole ones.
struct ProjectedSolid {
    std::array<Affine, 12> insides{};
    std::size_t inside_count = 0;
    std::array<Affine, 3> fronts{};
    std::size_t front_count = 0;
    float least_reverse = 0.0F;  ///< of its farthest point: at the edges the fronts' planes reach beyond it
};

/// The image as it is drawn into.
struct DrawnImage {
    glm::ivec2 size_px;
    int stride;
    float* whole;
    float* part;
    std::int32_t* masks;
};

/// Pixels low..high, high included; empty while low > high.
struct PixelRange {
    glm::ivec2 low{1 << 20};
    glm::ivec2 high{-1};
};

}  // namespace lw
#endif

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr int kParts = OcclusionBuffer::kParts;
constexpr int kWholePixel = (1 << (kParts * kParts)) - 1;

/// Runs of covered parts on rows of parts, of as many rows of pixels as make full vectors. No run: low > high.
struct Runs {
    static constexpr int kRows = static_cast<int>(std::max<std::size_t>(kMaxLanes, kParts));
    HWY_ALIGN std::array<float, kRows> low;
    HWY_ALIGN std::array<float, kRows> high;
};

/// @param first_row  of parts
void find_runs(const ProjectedSolid& solid, int first_row, int row_count, int width, Runs& runs) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (int k = 0; k < row_count; k += lanes) {
        const VF y = hn::Iota(d, static_cast<float>(first_row + k) + 0.5F);
        VF low = hn::Zero(d);
        VF high = hn::Set(d, static_cast<float>(width - 1));
        for (std::size_t i = 0; i < solid.inside_count; ++i) {
            const Affine& inside = solid.insides[i];
            const VF at_left =
                hn::MulAdd(y, hn::Set(d, inside.per_y), hn::Set(d, inside.constant + 0.5F * inside.per_x));
            if (inside.per_x > 0.0F) {
                low = hn::Max(low, hn::Ceil(hn::Mul(at_left, hn::Set(d, -1.0F / inside.per_x))));
            } else if (inside.per_x < 0.0F) {
                high = hn::Min(high, hn::Floor(hn::Mul(at_left, hn::Set(d, -1.0F / inside.per_x))));
            } else {
                high = hn::IfThenElse(hn::Lt(at_left, hn::Zero(d)), hn::Set(d, -1.0F), high);
            }
        }
        hn::Store(low, d, runs.low.data() + k);
        hn::Store(high, d, runs.high.data() + k);
    }
}

/// One row of pixels: the runs of its rows of parts.
struct PixelRow {
    std::array<int, kParts> low;
    std::array<int, kParts> high;
    int first_px = 1 << 20;
    int last_px = -1;
    int inner_low = 0;  ///< parts that all runs have in common
    int inner_high = 1 << 20;
};

HWY_INLINE PixelRow pixel_row(const Runs& runs, int first) {
    PixelRow row;
    for (std::size_t r = 0; r < kParts; ++r) {
        const float low = runs.low[static_cast<std::size_t>(first) + r];
        const float high = runs.high[static_cast<std::size_t>(first) + r];
        const bool any = low <= high;
        row.low[r] = any ? static_cast<int>(low) : 0;
        row.high[r] = any ? static_cast<int>(high) : -1;
        row.inner_low = std::max(row.inner_low, any ? row.low[r] : 1 << 20);
        row.inner_high = std::min(row.inner_high, row.high[r]);
        if (!any) continue;
        row.first_px = std::min(row.first_px, row.low[r] / kParts);
        row.last_px = std::max(row.last_px, row.high[r] / kParts);
    }
    return row;
}

/// Covered parts of pixels x..x + lanes - 1, one bit each, row by row.
HWY_INLINE hn::Vec<DI> covered_parts(const PixelRow& row, int x) {
    const DI d;
    const auto first_part = hn::Mul(hn::Iota(d, x), hn::Set(d, kParts));
    const auto none = hn::Zero(d);
    const auto all = hn::Set(d, kParts);
    const auto one = hn::Set(d, 1);
    auto covered = none;
    for (std::size_t r = 0; r < kParts; ++r) {
        const auto begin = hn::Min(hn::Max(hn::Sub(hn::Set(d, row.low[r]), first_part), none), all);
        const auto end = hn::Min(hn::Max(hn::Sub(hn::Set(d, row.high[r] + 1), first_part), none), all);
        const auto bits = hn::Max(hn::Sub(hn::Shl(one, end), hn::Shl(one, begin)), none);
        covered = hn::Or(covered, hn::Shl(bits, hn::Set(d, static_cast<int>(r) * kParts)));
    }
    return covered;
}

/// Draws what covers pixels in part: parts of several solids add up to a whole pixel at the farthest of their
/// distances (the idea of Hasselgren, Andersson, Akenine-Moller 2016, "Masked software occlusion culling").
HWY_INLINE void draw_parts(const PixelRow& row, int x, VF reverse, float* whole, float* part, std::int32_t* masks) {
    const DF d;
    const DI di;
    const auto covered = covered_parts(row, x);
    const auto all = hn::Set(di, kWholePixel);
    const auto none = hn::Zero(di);
    const VF whole_before = hn::LoadU(d, whole);
    const auto is_whole = hn::RebindMask(d, hn::Eq(covered, all));
    const VF whole_now = hn::IfThenElse(is_whole, hn::Max(whole_before, reverse), whole_before);
    // What is known of parts counts for something only while it is nearer than what is known of the whole.
    const VF part_before = hn::LoadU(d, part);
    const auto mask_before = hn::LoadU(di, masks);
    const auto useful = hn::RebindMask(di, hn::Gt(part_before, whole_now));
    const auto mask_kept = hn::IfThenElseZero(useful, mask_before);
    const auto adds = hn::Ne(hn::AndNot(mask_kept, covered), none);
    const auto joins = hn::And(adds, hn::RebindMask(di, hn::Gt(reverse, whole_now)));
    const auto mask_now = hn::Or(mask_kept, hn::IfThenElseZero(joins, covered));
    const auto starts = hn::RebindMask(d, hn::Eq(mask_kept, none));
    const VF part_joined = hn::IfThenElse(starts, reverse, hn::Min(part_before, reverse));
    const VF part_now = hn::IfThenElse(hn::RebindMask(d, joins), part_joined, part_before);
    const auto complete = hn::Eq(mask_now, all);
    const VF whole_done = hn::IfThenElse(hn::RebindMask(d, complete), hn::Max(whole_now, part_now), whole_now);
    hn::StoreU(whole_done, d, whole);
    hn::StoreU(part_now, d, part);
    hn::StoreU(hn::IfThenElse(complete, none, mask_now), di, masks);
}

void draw_row(const ProjectedSolid& solid, const PixelRow& row, int y, const DrawnImage& image) {
    const DF d;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    const float yc = static_cast<float>(y) + 0.5F;
    const std::ptrdiff_t begin = static_cast<std::ptrdiff_t>(y) * image.stride;
    for (int x = row.first_px - row.first_px % lanes; x <= row.last_px; x += lanes) {
        const VF xc = hn::Iota(d, static_cast<float>(x) + 0.5F);
        VF reverse = hn::Set(d, 1e30F);
        for (std::size_t i = 0; i < solid.front_count; ++i) {
            const Affine& front = solid.fronts[i];
            reverse = hn::Min(reverse,
                              hn::MulAdd(xc, hn::Set(d, front.per_x), hn::Set(d, front.per_y * yc + front.constant)));
        }
        reverse = hn::Max(reverse, hn::Set(d, solid.least_reverse));
        float* whole = image.whole + begin + x;
        if (kParts * x >= row.inner_low && kParts * (x + lanes) - 1 <= row.inner_high) {
            hn::StoreU(hn::Max(hn::LoadU(d, whole), reverse), d, whole);
        } else {
            draw_parts(row, x, reverse, whole, image.part + begin + x, image.masks + begin + x);
        }
    }
}

void draw_here(const ProjectedSolid& solid, glm::ivec2 rows, const DrawnImage& image, PixelRange& drawn) {
    const int step = static_cast<int>(std::max<std::size_t>(hn::Lanes(DF{}), kParts));
    Runs runs;
    for (int y = rows.x; y <= rows.y; y += step / kParts) {
        find_runs(solid, kParts * y, step, kParts * image.size_px.x, runs);
        for (int k = 0; k < step / kParts && y + k <= rows.y; ++k) {
            const PixelRow row = pixel_row(runs, kParts * k);
            if (row.first_px > row.last_px) continue;
            drawn.low = glm::min(drawn.low, glm::ivec2{row.first_px, y + k});
            drawn.high = glm::max(drawn.high, glm::ivec2{row.last_px, y + k});
            draw_row(solid, row, y + k, image);
        }
    }
}

void reduce_here(const DrawnImage& image, const PixelRange& changed, OcclusionBuffer::Tile* tiles) {
    const DF d;
    const DI di;
    const auto lanes = static_cast<int>(hn::Lanes(d));
    constexpr int kTileX = OcclusionBuffer::kTileX;
    constexpr int kTileY = OcclusionBuffer::kTileY;
    const int tile_stride = image.stride / kTileX;
    for (int ty = changed.low.y / kTileY; ty <= changed.high.y / kTileY; ++ty) {
        for (int tx = changed.low.x / kTileX; tx <= changed.high.x / kTileX; ++tx) {
            VF least = hn::Set(d, 1e30F);
            VF most = hn::Zero(d);
            for (int y = 0; y < kTileY; ++y) {
                const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(ty * kTileY + y) * image.stride + tx * kTileX;
                for (std::ptrdiff_t at = row; at < row + kTileX; at += lanes) {
                    const VF whole = hn::LoadU(d, image.whole + at);
                    const MF in_parts = hn::RebindMask(d, hn::Ne(hn::LoadU(di, image.masks + at), hn::Zero(di)));
                    least = hn::Min(least, whole);
                    most = hn::Max(most, hn::Max(whole, hn::IfThenElseZero(in_parts, hn::LoadU(d, image.part + at))));
                }
            }
            tiles[ty * tile_stride + tx] = {hn::GetLane(hn::MinOfLanes(d, least)),
                                            hn::GetLane(hn::MaxOfLanes(d, most))};
        }
    }
}

OcclusionBuffer::Split split_here(const OcclusionBuffer& buffer, const BoxList& boxes,
                                  std::span<const std::uint32_t> candidates, std::vector<std::uint32_t>& seen) {
    const std::size_t lanes = hn::Lanes(DF{});
    OcclusionBuffer::Split split;
    for (std::size_t first = 0; first < candidates.size(); first += lanes) {
        const std::size_t count = std::min(lanes, candidates.size() - first);
        const BoxVector some = gather_boxes(boxes, candidates.data() + first, count);
        const Projected projected = project(some, buffer.view(), lowest_bits(count));
        const std::uint32_t sampled = bits_of(meets_sample(projected, buffer.view()));
        const std::uint32_t hidden = hidden_of(buffer, projected, sampled & lowest_bits(count));
        for (std::size_t i = 0; i < count; ++i) {
            if ((sampled >> i & 1U) == 0) {
                ++split.between_samples;
            } else if ((hidden >> i & 1U) != 0) {
                ++split.hidden;
            } else {
                seen.push_back(candidates[first + i]);
            }
        }
    }
    return split;
}

bool hides_here(const OcclusionBuffer& buffer, const glm::vec3& box_min, const glm::vec3& box_max) {
    return hidden_of(buffer, project_one(box_min, box_max, buffer.view()), 1U) != 0;
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(draw_here);
HWY_EXPORT(reduce_here);
HWY_EXPORT(split_here);
HWY_EXPORT(hides_here);

namespace {

int rounded_up(int value, int unit) { return (value + unit - 1) / unit * unit; }

/// Least value anywhere in the pixel whose centre it is evaluated at; `longest` pixels a side.
Affine least_in_pixel(const glm::dvec3& affine, double snap_px, double longest) {
    const double per_px = std::abs(affine.x) + std::abs(affine.y);
    const double slack = (0.5 + snap_px) * per_px;
    // Single precision at the far end of the buffer.
    const double rounding = 4e-7 * (longest * per_px + std::abs(affine.z));
    return {static_cast<float>(affine.x), static_cast<float>(affine.y),
            static_cast<float>(affine.z - slack - rounding)};
}

Affine least_in_whole(const glm::dvec3& affine) {
    return least_in_pixel(affine, HWY_NAMESPACE::kSnapPx, OcclusionBuffer::kLongestSide_px);
}

/// The same for a part of a pixel, which is a pixel of an image that much larger.
Affine least_in_part(const glm::dvec3& affine) {
    constexpr double kParts = OcclusionBuffer::kParts;
    return least_in_pixel({affine.x / kParts, affine.y / kParts, affine.z}, kParts * HWY_NAMESPACE::kSnapPx,
                          kParts * OcclusionBuffer::kLongestSide_px);
}

}  // namespace

void OcclusionBuffer::begin(const Camera& camera) {
    const double longest = std::max(camera.size_px.x, camera.size_px.y);
    const double scale = std::min(1.0, kLongestSide_px / longest);
    size_px_ = glm::max(glm::ivec2{glm::ceil(glm::dvec2{camera.size_px} * scale)}, 1);
    stride_ = rounded_up(size_px_.x, 16 * kTileX / 16);
    rows_ = rounded_up(size_px_.y, kTileY);
    const std::size_t pixels = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows_) + 64;
    pixels_.assign(pixels, 0.0F);
    parts_.resize(pixels);
    masks_.assign(pixels, 0);
    tiles_.assign(static_cast<std::size_t>(stride_ / kTileX) * static_cast<std::size_t>(rows_ / kTileY), Tile{});

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
    view_.size_px = {static_cast<float>(size_px_.x), static_cast<float>(size_px_.y)};
    view_.samples_per_px = {static_cast<float>(camera.size_px.x) / static_cast<float>(size_px_.x),
                            static_cast<float>(camera.size_px.y) / static_cast<float>(size_px_.y)};
}

void OcclusionBuffer::add(const ConvexSolid& solid, const scene::Bounds& bounds_world) {
    double top = size_px_.y;
    double bottom = 0.0;
    double nearest_m = 1e300;
    double farthest_m = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1U) != 0 ? bounds_world.max.x : bounds_world.min.x,
                               (corner & 2U) != 0 ? bounds_world.max.y : bounds_world.min.y,
                               (corner & 4U) != 0 ? bounds_world.max.z : bounds_world.min.z};
        const glm::dvec3 relative = point - eye_world_;
        double distance_m = 0.0;
        double y = 0.0;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            distance_m += double{view_.distance[k]} * relative[i];
            y += double{view_.y_px[k]} * relative[i];
        }
        nearest_m = std::min(nearest_m, distance_m);
        farthest_m = std::max(farthest_m, distance_m);
        top = std::min(top, y / distance_m);
        bottom = std::max(bottom, y / distance_m);
    }
    if (!(farthest_m > 0.0)) return;
    // Single precision of the view's axes.
    const auto least_reverse = static_cast<float>((1.0 - 1e-5) / farthest_m);
    if (nearest_m < view_.near_m) return add(solid, 0, size_px_.y - 1, least_reverse);
    // A row too many costs nothing, one too few only hides less.
    const double last = size_px_.y - 1;
    add(solid, static_cast<int>(std::clamp(top - 1.0, 0.0, last)),
        static_cast<int>(std::clamp(bottom + 1.0, -1.0, last)), least_reverse);
}

void OcclusionBuffer::add(const ConvexSolid& solid, int first_row, int last_row, float least_reverse) {
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
    projected.least_reverse = least_reverse;
    for (std::size_t front = 0; front < 6; ++front) {
        if (!faces_eye[front] || projected.front_count == 3) continue;
        projected.fronts[projected.front_count++] = least_in_whole(met[front]);
        projected.insides[projected.inside_count++] = least_in_part(met[front]);
        for (std::size_t back = 0; back < 6; ++back) {
            // Behind a front is its own back wherever the front is met at all.
            if (faces_eye[back] || back / 2 == front / 2) continue;
            projected.insides[projected.inside_count++] = least_in_part(met[front] - met[back]);
        }
    }
    if (projected.front_count == 0) return;
    PixelRange drawn;
    const DrawnImage image{size_px_, stride_, pixels_.data(), parts_.data(), masks_.data()};
    HWY_DYNAMIC_DISPATCH(draw_here)(projected, {first_row, last_row}, image, drawn);
    if (drawn.high.y < 0) return;
    HWY_DYNAMIC_DISPATCH(reduce_here)(image, drawn, tiles_.data());
}

OcclusionBuffer::Split OcclusionBuffer::split(const BoxList& boxes, std::span<const std::uint32_t> candidates,
                                              std::vector<std::uint32_t>& seen) const {
    return HWY_DYNAMIC_DISPATCH(split_here)(*this, boxes, candidates, seen);
}

bool OcclusionBuffer::hides(const glm::vec3& box_min_world, const glm::vec3& box_max_world) const {
    return HWY_DYNAMIC_DISPATCH(hides_here)(*this, box_min_world, box_max_world);
}

}  // namespace lw
#endif
