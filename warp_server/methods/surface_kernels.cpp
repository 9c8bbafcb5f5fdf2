#include "warp_server/methods/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/surface_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <type_traits>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_fragments.h"
#include "warp_server/methods/surface_placing.h"
#include "warp_server/methods/surface_sampling.h"
#include "warp_server/methods/surface_solving.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr int kSmallBoxPx = 3;  // a cell's box is one to three pixels wide unless it is magnified

// Within a narrow box of target pixels, lanes run over several of its rows: lane k of a box w wide is at (k % w, k /
// w).
struct LaneOffsets {
    float x[kMaxLanes + 1][kMaxLanes];
    float y[kMaxLanes + 1][kMaxLanes];
};

const LaneOffsets& lane_offsets() {
    static const LaneOffsets offsets = [] {
        LaneOffsets made{};
        for (std::size_t width = 1; width <= kMaxLanes; ++width) {
            for (std::size_t lane = 0; lane < kMaxLanes; ++lane) {
                made.x[width][lane] = static_cast<float>(lane % width);
                made.y[width][lane] = static_cast<float>(lane / width);
            }
        }
        return made;
    }();
    return offsets;
}

class Painter {
public:
    Painter(const PatchInput& input, const PatchList& list, SurfaceCanvas& canvas, std::vector<std::uint32_t>& behind)
        : input_{input},
          list_{list},
          canvas_{canvas},
          behind_{behind},
          reader_{input.prepared->linear_colours.get(), input.prepared->size_px},
          fragments_{*input.prepared, list, canvas},
          target_width_{canvas.frame().depth.width()},
          band_{target_width_, canvas.band()},
          depths_{canvas.frame().depth.pixels().data()},
          colours_{canvas.frame().colour.pixels().data()} {}

    void paint() {
        const hn::ScalableTag<float> d;
        const hn::CappedTag<float, 1> d1;
        const std::size_t lanes = hn::Lanes(d);
        std::size_t i = 0;
        for (; i + lanes <= list_.size(); i += lanes) paint_some(d, i);
        for (; i < list_.size(); ++i) paint_some(d1, i);
    }

private:
    // Lanes(d) patches: places them all at once, object by object, then paints one after the other.
    template <class D>
    HWY_INLINE void paint_some(D d, std::size_t first) {
        const hn::RebindToUnsigned<D> du;
        const hn::Rebind<std::uint16_t, D> d16;
        const auto ids = hn::PromoteTo(du, hn::LoadU(d16, list_.object_id.data() + first));
        auto remaining = hn::Eq(hn::Zero(d), hn::Zero(d));
        while (!hn::AllFalse(d, remaining)) {
            const ObjectId id = list_.object_id[first + static_cast<std::size_t>(hn::FindFirstTrue(d, remaining))];
            const auto same = hn::RebindMask(d, hn::Eq(ids, hn::Set(du, std::uint32_t{id})));
            const auto group = hn::And(remaining, same);
            remaining = hn::AndNot(same, remaining);
            const PixelMatrix* matrix = input_.matrices->find(id);
            if (matrix == nullptr) continue;
            PlacedPatches placed;
            std::uint32_t bits = place_patches(d, list_, first, *matrix, group, band_, placed, behind_);
            if (bits == 0) continue;
            if constexpr (std::is_same_v<D, DF>) {
                const std::uint32_t small = small_boxes(bits, placed);
                if (small != 0) paint_small(first, small, placed);
                bits &= ~small;
            }
            for (; bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
                paint_one(first + lane, lane, placed);
            }
        }
    }

    // Those of the patches whose boxes hold so few pixels that solving one pixel of many patches at once is faster than
    // solving many pixels of one patch.
    HWY_INLINE std::uint32_t small_boxes(std::uint32_t bits, const PlacedPatches& placed) const {
        const auto size = [](const std::int32_t* begin, const std::int32_t* end) {
            return hn::Sub(hn::Load(DI{}, end), hn::Load(DI{}, begin));
        };
        const auto limit = hn::Set(DI{}, kSmallBoxPx + 1);
        const auto small = hn::And(hn::Lt(size(placed.x_begin, placed.x_end), limit),
                                   hn::Lt(size(placed.y_begin, placed.y_end), limit));
        return bits & bits_of(DI{}, small);
    }

    // One pixel of every patch at a time, column by column and row by row of their boxes.
    HWY_INLINE void paint_small(std::size_t first, std::uint32_t bits, const PlacedPatches& placed) {
        const auto load = [&](const std::vector<float>& values) { return hn::LoadU(DF{}, values.data() + first); };
        const auto placed_values = [](const float* values) { return hn::Load(DF{}, values); };
        HWY_ALIGN std::int32_t wanted_lanes[kMaxLanes];
        for (std::size_t lane = 0; lane < kMaxLanes; ++lane)
            wanted_lanes[lane] = static_cast<std::int32_t>(bits >> lane & 1U);
        const auto wanted = hn::Gt(hn::Load(DI{}, wanted_lanes), hn::Zero(DI{}));
        const auto x_end = hn::Load(DI{}, placed.x_end);
        const auto y_end = hn::Load(DI{}, placed.y_end);
        Patch patch;
        patch.target_x = placed_values(placed.target_x);
        patch.target_y = placed_values(placed.target_y);
        patch.w = placed_values(placed.w);
        patch.w_x = placed_values(placed.w_x);
        patch.w_y = placed_values(placed.w_y);
        patch.inverse_xx = placed_values(placed.inverse_xx);
        patch.inverse_xy = placed_values(placed.inverse_xy);
        patch.inverse_yx = placed_values(placed.inverse_yx);
        patch.inverse_yy = placed_values(placed.inverse_yy);
        patch.depth_factor = placed_values(placed.depth_factor);
        patch.depth = load(list_.depth);
        patch.gradient_x = load(list_.gradient_x);
        patch.gradient_y = load(list_.gradient_y);
        patch.left = load(list_.left);
        patch.right = load(list_.right);
        patch.top = load(list_.top);
        patch.bottom = load(list_.bottom);
        const bool is_whole = list_.corners[first] == kAllCorners;  // as all of the list are, or none
        for (int dy = 0; dy < kSmallBoxPx; ++dy) {
            const auto y = hn::Add(hn::Load(DI{}, placed.y_begin), hn::Set(DI{}, dy));
            const auto wanted_rows = hn::And(wanted, hn::Lt(y, y_end));
            if (hn::AllFalse(DI{}, wanted_rows)) return;
            const VF pixel_y = hn::ConvertTo(DF{}, y);
            for (int dx = 0; dx < kSmallBoxPx; ++dx) {
                const auto x = hn::Add(hn::Load(DI{}, placed.x_begin), hn::Set(DI{}, dx));
                const auto used = hn::And(wanted_rows, hn::Lt(x, x_end));
                if (hn::AllFalse(DI{}, used)) break;
                const VF pixel_x = hn::ConvertTo(DF{}, x);
                Solved solved;
                const auto inside = hn::And(hn::RebindMask(DF{}, used), solve(patch, pixel_x, pixel_y, solved));
                if (hn::AllFalse(DF{}, inside)) continue;
                if (is_whole) {
                    paint_scattered(load(list_.x), load(list_.y), solved, pixel_x, pixel_y, inside);
                } else {
                    fragments_.paint(first, 1, solved, indices_of(pixel_x, pixel_y), inside);
                }
            }
        }
    }

    // Solves every pixel of the patch's box, as many at once as there are lanes, and paints those inside of it.
    HWY_INLINE void paint_one(std::size_t index, std::size_t lane, const PlacedPatches& placed) {
        const auto set = [](float value) { return hn::Set(DF{}, value); };
        Patch patch;
        patch.target_x = set(placed.target_x[lane]);
        patch.target_y = set(placed.target_y[lane]);
        patch.w = set(placed.w[lane]);
        patch.w_x = set(placed.w_x[lane]);
        patch.w_y = set(placed.w_y[lane]);
        patch.inverse_xx = set(placed.inverse_xx[lane]);
        patch.inverse_xy = set(placed.inverse_xy[lane]);
        patch.inverse_yx = set(placed.inverse_yx[lane]);
        patch.inverse_yy = set(placed.inverse_yy[lane]);
        patch.depth_factor = set(placed.depth_factor[lane]);
        patch.depth = set(list_.depth[index]);
        patch.gradient_x = set(list_.gradient_x[index]);
        patch.gradient_y = set(list_.gradient_y[index]);
        patch.left = set(list_.left[index]);
        patch.right = set(list_.right[index]);
        patch.top = set(list_.top[index]);
        patch.bottom = set(list_.bottom[index]);
        const VF origin_x = set(list_.x[index]);
        const VF origin_y = set(list_.y[index]);
        const bool is_whole = list_.corners[index] == kAllCorners;

        const int lanes = static_cast<int>(hn::Lanes(DF{}));
        const int columns = std::min(placed.x_end[lane] - placed.x_begin[lane], lanes);
        const int rows = lanes / columns;
        const VF lane_x = hn::LoadU(DF{}, lane_offsets().x[columns]);
        const VF lane_y = hn::LoadU(DF{}, lane_offsets().y[columns]);
        const VF row_limit = set(static_cast<float>(placed.y_end[lane]));
        const VF column_limit = set(static_cast<float>(placed.x_end[lane]));
        const auto used = hn::Lt(lane_y, set(static_cast<float>(rows)));
        for (int y = placed.y_begin[lane]; y < placed.y_end[lane]; y += rows) {
            const VF pixel_y = hn::Add(lane_y, set(static_cast<float>(y)));
            const auto used_rows = hn::And(used, hn::Lt(pixel_y, row_limit));
            for (int x = placed.x_begin[lane]; x < placed.x_end[lane]; x += columns) {
                const VF pixel_x = hn::Add(lane_x, set(static_cast<float>(x)));
                Solved solved;
                auto inside = solve(patch, pixel_x, pixel_y, solved);
                inside = hn::And(inside, hn::And(used_rows, hn::Lt(pixel_x, column_limit)));
                if (hn::AllFalse(DF{}, inside)) continue;
                if (!is_whole) {
                    fragments_.paint(index, 0, solved, indices_of(pixel_x, pixel_y), inside);
                } else if (rows == 1 && x + lanes <= target_width_) {
                    paint_run(origin_x, origin_y, solved, x, y, inside);
                } else {
                    paint_scattered(origin_x, origin_y, solved, pixel_x, pixel_y, inside);
                }
            }
        }
    }

    // Opaque pixels in one row from column x on.
    template <class M>
    HWY_INLINE void paint_run(VF origin_x, VF origin_y, const Solved& solved, int x, int y, M inside) {
        const std::size_t index =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(target_width_) + static_cast<std::size_t>(x);
        __builtin_prefetch(depths_ + index + kPrefetchRows * target_width_, 1);
        __builtin_prefetch(colours_ + index + kPrefetchRows * target_width_, 1);
        const VF shown = hn::LoadU(DF{}, depths_ + index);
        const auto not_behind = hn::And(inside, hn::Le(shown, solved.depth));
        if (hn::AllFalse(DF{}, not_behind)) return;
        auto* colours = reinterpret_cast<std::uint32_t*>(colours_ + index);
        const Taps taps = reader_.taps_of(hn::Add(origin_x, solved.dx), hn::Add(origin_y, solved.dy), not_behind);
        auto colour = reader_.encoded(reader_.read_bilinear(taps.index, taps.fx, taps.fy));
        // Pieces overlap a little, and the number of lanes decides which comes first: of equal depths the larger word.
        const auto equal = hn::And(not_behind, hn::Eq(shown, solved.depth));
        if (!hn::AllFalse(DF{}, equal)) {
            const auto larger = hn::Max(colour, hn::LoadU(DU{}, colours));
            colour = hn::IfThenElse(hn::RebindMask(DU{}, equal), larger, colour);
        }
        hn::BlendedStore(solved.depth, not_behind, DF{}, depths_ + index);
        hn::BlendedStore(colour, hn::RebindMask(DU{}, not_behind), DU{}, colours);
    }

    // Opaque pixels anywhere, each once.
    template <class M>
    HWY_INLINE void paint_scattered(VF origin_x, VF origin_y, const Solved& solved, VF pixel_x, VF pixel_y, M inside) {
        HWY_ALIGN std::int32_t indices[kMaxLanes];
        HWY_ALIGN float depths[kMaxLanes];
        HWY_ALIGN std::int32_t tap[kMaxLanes];
        HWY_ALIGN std::int32_t fx[kMaxLanes];
        HWY_ALIGN std::int32_t fy[kMaxLanes];
        const Taps taps = reader_.taps_of(hn::Add(origin_x, solved.dx), hn::Add(origin_y, solved.dy), inside);
        hn::Store(indices_of(pixel_x, pixel_y), DI{}, indices);
        hn::Store(solved.depth, DF{}, depths);
        hn::Store(taps.index, DI{}, tap);
        hn::Store(taps.fx, DI{}, fx);
        hn::Store(taps.fy, DI{}, fy);
        for (std::uint32_t bits = bits_of(DF{}, inside); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            float& shown = depths_[indices[lane]];
            if (shown > depths[lane]) continue;
            const std::uint64_t word = reader_.read_word(tap[lane], fx[lane], fy[lane]);
            const auto channel = [&](unsigned shift) { return reader_.encoded_word(word, shift); };
            const Rgba8 colour{channel(0), channel(16), channel(32), 255};
            Rgba8& kept = colours_[indices[lane]];
            if (shown == depths[lane] && std::bit_cast<std::uint32_t>(kept) > std::bit_cast<std::uint32_t>(colour)) {
                continue;
            }
            shown = depths[lane];
            kept = colour;
        }
    }

    [[nodiscard]] HWY_INLINE hn::VFromD<DI> indices_of(VF pixel_x, VF pixel_y) const {
        return hn::Add(hn::Mul(hn::ConvertTo(DI{}, pixel_y), hn::Set(DI{}, target_width_)),
                       hn::ConvertTo(DI{}, pixel_x));
    }

    const PatchInput& input_;
    const PatchList& list_;
    SurfaceCanvas& canvas_;
    std::vector<std::uint32_t>& behind_;
    ColourReader reader_;
    FragmentPainter fragments_;
    std::int32_t target_width_;
    TargetBand band_;
    float* depths_;
    Rgba8* colours_;
};

void draw_patches_here(const PatchInput& input, const PatchList& list, SurfaceCanvas& canvas,
                       std::vector<std::uint32_t>& behind) {
    Painter{input, list, canvas, behind}.paint();
}

void mark_coverage_here(const float* depths, std::size_t count, Coverage* coverage) {
    const hn::Rebind<std::uint8_t, DF> d8;
    auto* bytes = reinterpret_cast<std::uint8_t*>(coverage);
    const std::size_t lanes = hn::Lanes(DF{});
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto reached = hn::Ge(hn::LoadU(DF{}, depths + i), hn::Zero(DF{}));
        const auto value = hn::IfThenElseZero(hn::RebindMask(DI{}, reached), hn::Set(DI{}, 1));
        hn::StoreU(hn::DemoteTo(d8, value), d8, bytes + i);
    }
    for (; i < count; ++i) coverage[i] = depths[i] >= 0.0F ? Coverage::reached : Coverage::hole;
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(draw_patches_here);
HWY_EXPORT(mark_coverage_here);

void draw_patches(const PatchInput& input, const PatchList& list, SurfaceCanvas& canvas,
                  std::vector<std::uint32_t>& behind) {
    HWY_DYNAMIC_DISPATCH(draw_patches_here)(input, list, canvas, behind);
}

void mark_coverage(const float* depths, std::size_t count, Coverage* coverage) {
    HWY_DYNAMIC_DISPATCH(mark_coverage_here)(depths, count, coverage);
}

}  // namespace lw
#endif
