#include "warp_server/methods/surface_links.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/surface_links.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_tolerances.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// One row of the image with its first pixel repeated once before it, its last one after it; unusable depths are -1.
struct PaddedRow {
    std::vector<float> depth;
    std::vector<std::int32_t> id;
};
constexpr int kPadBefore = 1;
constexpr int kPadAfter = 2 + HWY_MAX_BYTES / 4;

void fill_row(const CpuPixels& pixels, int y, PaddedRow& row) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const int width = pixels.depth.width();
    const float* depth = pixels.depth.row(y).data();
    const ObjectId* id = pixels.object_id.row(y).data();
    row.depth.resize(static_cast<std::size_t>(kPadBefore + width + kPadAfter));
    row.id.resize(row.depth.size());
    float* to_depth = row.depth.data() + kPadBefore;
    std::int32_t* to_id = row.id.data() + kPadBefore;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int x = 0;
    for (; x + lanes <= width; x += lanes) {
        const auto value = hn::LoadU(d, depth + x);
        const auto usable = hn::And(hn::Ge(value, hn::Zero(d)), hn::Le(value, hn::Set(d, 1.0F)));
        hn::StoreU(hn::IfThenElse(usable, value, hn::Set(d, -1.0F)), d, to_depth + x);
        hn::StoreU(hn::PromoteTo(di, hn::LoadU(d16, id + x)), di, to_id + x);
    }
    for (; x < width; ++x) {
        to_depth[x] = is_usable_depth(depth[x]) ? depth[x] : -1.0F;
        to_id[x] = id[x];
    }
    to_depth[-1] = to_depth[0];
    to_id[-1] = to_id[0];
    std::fill(to_depth + width, to_depth + width + kPadAfter, to_depth[width - 1]);
    std::fill(to_id + width, to_id + width + kPadAfter, to_id[width - 1]);
}

// on_one_surface for Lanes(d) pixels a whose neighbours b follow. Depths of other objects than a's count as -1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE auto linked(D d, V before, V a, V b, V after, V unseen) {
    const V zero = hn::Zero(d);
    const V step = hn::Sub(b, a);
    const V size = hn::Abs(step);
    const auto level = hn::Le(size, hn::Max(unseen, hn::Mul(hn::Set(d, kLevelDepthPart), hn::Min(a, b))));
    const V allowed = hn::Mul(hn::Set(d, kSlopeChangePart), size);
    const auto like_before = hn::And(hn::Gt(before, zero), hn::Le(hn::Abs(hn::Sub(step, hn::Sub(a, before))), allowed));
    const auto like_after = hn::And(hn::Gt(after, zero), hn::Le(hn::Abs(hn::Sub(step, hn::Sub(after, b))), allowed));
    const auto near_enough = hn::Or(level, hn::Or(like_before, like_after));
    const auto usable = hn::And(hn::Ge(a, zero), hn::Ge(b, zero));
    const auto both_or_neither = hn::Or(hn::And(hn::Gt(a, zero), hn::Gt(b, zero)), hn::Eq(a, b));
    return hn::And(near_enough, hn::And(usable, both_or_neither));
}

void link_row(const PaddedRow& above, const PaddedRow& here, const PaddedRow& below, const PaddedRow& second_below,
              int width, float unseen_step, std::uint8_t* out) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN std::uint8_t last[HWY_MAX_BYTES];
    for (int x = 0; x < width; x += lanes) {
        const std::ptrdiff_t at = x + kPadBefore;
        const auto id = hn::LoadU(di, here.id.data() + at);
        const auto depth_of_own_object = [&](const PaddedRow& row, std::ptrdiff_t offset) {
            const auto same = hn::RebindMask(d, hn::Eq(hn::LoadU(di, row.id.data() + at + offset), id));
            return hn::IfThenElse(same, hn::LoadU(d, row.depth.data() + at + offset), hn::Set(d, -1.0F));
        };
        const auto own = hn::LoadU(d, here.depth.data() + at);
        // Sky, and what faces the eye squarely, needs no more than this.
        const auto is_own = [&](const PaddedRow& row, std::ptrdiff_t offset) {
            const auto same_id = hn::Eq(hn::LoadU(di, row.id.data() + at + offset), id);
            return hn::And(hn::RebindMask(d, same_id), hn::Eq(hn::LoadU(d, row.depth.data() + at + offset), own));
        };
        if (x + lanes <= width &&
            hn::AllTrue(d, hn::And(hn::Ge(own, hn::Zero(d)), hn::And(is_own(here, 1), is_own(below, 0))))) {
            hn::StoreU(hn::Set(d8, kToRight | kDown), d8, out + x);
            continue;
        }
        const auto stands_still = hn::RebindMask(d, hn::Eq(id, hn::Zero(di)));
        const auto unseen = hn::IfThenElseZero(stands_still, hn::Set(d, unseen_step));
        const auto to_right = linked(d, depth_of_own_object(here, -1), own, depth_of_own_object(here, 1),
                                     depth_of_own_object(here, 2), unseen);
        const auto down = linked(d, depth_of_own_object(above, 0), own, depth_of_own_object(below, 0),
                                 depth_of_own_object(second_below, 0), unseen);
        const auto bits = hn::Or(hn::IfThenElseZero(hn::RebindMask(di, to_right), hn::Set(di, kToRight)),
                                 hn::IfThenElseZero(hn::RebindMask(di, down), hn::Set(di, kDown)));
        if (x + lanes <= width) {
            hn::StoreU(hn::DemoteTo(d8, bits), d8, out + x);
        } else {
            hn::StoreU(hn::DemoteTo(d8, bits), d8, last);
            std::copy(last, last + (width - x), out + x);
        }
    }
}

void link_image(const CpuPixels& pixels, float unseen_step, Image<std::uint8_t>& links) {
    const int height = pixels.depth.height();
    PaddedRow rows[4];  // y - 1, y, y + 1, y + 2, by y % 4
    const auto row = [&](int y) -> PaddedRow& {
        return rows[static_cast<unsigned>(std::clamp(y, 0, height - 1)) % 4U];
    };
    for (int y = 0; y < std::min(2, height); ++y) fill_row(pixels, y, row(y));
    for (int y = 0; y < height; ++y) {
        if (y + 2 < height) fill_row(pixels, y + 2, row(y + 2));
        link_row(row(y - 1), row(y), row(y + 1), row(y + 2), links.width(), unseen_step, links.row(y).data());
    }
}

// One pixel of a block against its plane.
bool is_on_plane(const CpuPixels& pixels, const BlockToTest& block, std::size_t at, float expected) {
    const float depth = pixels.depth.pixels()[at];
    return is_usable_depth(depth) && std::abs(depth - expected) <= block.tolerance.at(depth) &&
           pixels.object_id.pixels()[at] == block.id;
}

// Lanes(d) pixels of a block's row from `column` on against its plane, as bits; those beyond the row are 0.
template <class D>
HWY_INLINE std::uint32_t on_plane(D d, const CpuPixels& pixels, const BlockToTest& block, int row, int column) {
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint16_t, D> d16;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto width = static_cast<std::size_t>(pixels.depth.width());
    const std::size_t at = static_cast<std::size_t>(block.y + row) * width + static_cast<std::size_t>(block.x + column);
    const float first_depth =
        block.depth + static_cast<float>(row) * block.gradient_y + static_cast<float>(column) * block.gradient_x;
    const int asked = std::min(lanes, block.columns - column);
    if (at + static_cast<std::size_t>(lanes) > pixels.depth.pixels().size()) {  // a vector would read beyond the image
        std::uint32_t bits = 0;
        for (int i = 0; i < asked; ++i) {
            const float expected = first_depth + static_cast<float>(i) * block.gradient_x;
            if (is_on_plane(pixels, block, at + static_cast<std::size_t>(i), expected)) bits |= 1U << i;
        }
        return bits;
    }
    const auto step = hn::Mul(lanes_from(d, 0.0F), hn::Set(d, block.gradient_x));
    const auto depth = hn::LoadU(d, pixels.depth.pixels().data() + at);
    const auto id = hn::PromoteTo(di, hn::LoadU(d16, pixels.object_id.pixels().data() + at));
    const auto off = hn::Abs(hn::Sub(depth, hn::Add(hn::Set(d, first_depth), step)));
    const auto allowed = hn::Max(hn::Mul(hn::Set(d, block.tolerance.part), depth), hn::Set(d, block.tolerance.step));
    const auto usable = hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
    auto on = hn::And(hn::Le(off, allowed), usable);
    on = hn::And(on, hn::RebindMask(d, hn::Eq(id, hn::Set(di, std::int32_t{block.id}))));
    return bits_of(d, on) & ((1U << asked) - 1U);
}

bool block_is_plane_here(const CpuPixels& pixels, const BlockToTest& block) {
    const int lanes = static_cast<int>(hn::Lanes(DF{}));
    for (int row = 0; row < block.rows; ++row) {
        for (int column = 0; column < block.columns; column += lanes) {
            const int asked = std::min(lanes, block.columns - column);
            if (on_plane(DF{}, pixels, block, row, column) != (1U << asked) - 1U) return false;
        }
    }
    return true;
}

void plane_members_here(const CpuPixels& pixels, const BlockToTest& block, std::uint16_t* rows) {
    const int lanes = static_cast<int>(hn::Lanes(DF{}));
    for (int row = 0; row < block.rows; ++row) {
        std::uint32_t bits = 0;
        for (int column = 0; column < block.columns; column += lanes) {
            bits |= on_plane(DF{}, pixels, block, row, column) << column;
        }
        rows[row] = static_cast<std::uint16_t>(bits);
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(link_image);
HWY_EXPORT(block_is_plane_here);
HWY_EXPORT(plane_members_here);

bool block_is_plane(const CpuPixels& pixels, const BlockToTest& block) {
    return HWY_DYNAMIC_DISPATCH(block_is_plane_here)(pixels, block);
}

void plane_members(const CpuPixels& pixels, const BlockToTest& block, std::uint16_t* rows) {
    HWY_DYNAMIC_DISPATCH(plane_members_here)(pixels, block, rows);
}

SurfaceLinks::SurfaceLinks(const CpuPixels& pixels, float unseen_step) : pixels_{&pixels}, unseen_step_{unseen_step} {
    to_right_and_down_.resize(pixels.depth.size_px());
    HWY_DYNAMIC_DISPATCH(link_image)(pixels, unseen_step_, to_right_and_down_);
}

bool SurfaceLinks::diagonal(int x, int y, int step_x) const {
    const glm::ivec2 last = size_px() - 1;
    const auto inside = [&](glm::ivec2 at) { return glm::clamp(at, glm::ivec2{0}, last); };
    const glm::ivec2 own = inside({x, y});
    const ObjectId id = pixels_->object_id.at(own.x, own.y);
    const float step = unseen_step(id);
    const auto is_inside = [&](int at_x) { return at_x >= 0 && at_x <= last.x; };
    if (is_inside(x - step_x) && is_inside(x + 2 * step_x) && y >= 1 && y + 2 <= last.y) {
        const auto depth_along = [&](int steps) { return depth_of(id, x + steps * step_x, y + steps); };
        return on_one_surface(depth_along(-1), depth_along(0), depth_along(1), depth_along(2), step);
    }
    const auto depth_along = [&](int steps) {
        const glm::ivec2 at = inside({x + steps * step_x, y + steps});
        return depth_of(id, at.x, at.y);
    };
    return on_one_surface(depth_along(-1), depth_along(0), depth_along(1), depth_along(2), step);
}

std::uint8_t SurfaceLinks::all_links(int x, int y) const {
    unsigned links = sides(x, y);
    if (diagonal(x, y, 1)) links |= kLinkFalling;
    if (diagonal(x + 1, y, -1)) links |= kLinkRising;
    return static_cast<std::uint8_t>(links);
}

bool on_one_surface(float before, float a, float b, float after, float unseen_step) {
    if (a < 0.0F || b < 0.0F) return false;
    if (a == 0.0F || b == 0.0F) return a == b;
    const float step = b - a;
    const float size = std::abs(step);
    if (size <= DepthTolerance{kLevelDepthPart, unseen_step}.at(std::min(a, b))) return true;
    const float allowed = kSlopeChangePart * size;
    const bool like_before = before > 0.0F && std::abs(step - (a - before)) <= allowed;
    const bool like_after = after > 0.0F && std::abs(step - (after - b)) <= allowed;
    return like_before || like_after;
}

}  // namespace lw
#endif
