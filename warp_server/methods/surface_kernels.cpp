#include "warp_server/methods/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/surface_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "warp_server/methods/linear_colour.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(float);
constexpr float kOutOfReachPx = 100000.0F;  // places beyond are in no image
// Target pixels per source pixel, in area, below which a plane counts as seen edge-on; negative: from its back.
constexpr float kSmallestArea = 1e-4F;
constexpr int kPrefetchRows = 3;  // blocks are narrow, so that the next rows come before the next lines of this one
constexpr int kSmallBoxPx = 3;    // a cell's box is one to three pixels wide unless it is magnified
constexpr float kSmallestCoverage = 1.0F / 512.0F;  // less changes no 8-bit colour

// Patches laid out for one target: the inverse of each one's homography, relative to where its origin lands. With e the
// offset of a target place from there: k = inverse * e, share = 1 - w_x kx - w_y ky, offset in the source = w / share *
// k.
struct alignas(HWY_MAX_BYTES) PlacedPatches {
    float target_x[kMaxLanes];
    float target_y[kMaxLanes];
    float w[kMaxLanes];
    float w_x[kMaxLanes];
    float w_y[kMaxLanes];
    float inverse_xx[kMaxLanes];
    float inverse_xy[kMaxLanes];
    float inverse_yx[kMaxLanes];
    float inverse_yy[kMaxLanes];
    float depth_factor[kMaxLanes];  // depth in the target = factor * share * depth in the source
    std::int32_t x_begin[kMaxLanes];
    std::int32_t x_end[kMaxLanes];
    std::int32_t y_begin[kMaxLanes];
    std::int32_t y_end[kMaxLanes];
};

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

// One bit per lane. Reads back exactly the bytes that are written: a wider read would wait for the write to reach the
// cache.
template <class D, class M>
HWY_INLINE std::uint32_t bits_of(D d, M mask) {
    if constexpr (hn::MaxLanes(D{}) > 8) {
        std::uint16_t bits = 0;
        hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
        return bits;
    } else {
        std::uint8_t bits = 0;
        hn::StoreMaskBits(d, mask, &bits);
        return bits;
    }
}

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;

// Target pixels laid back onto a patch.
struct Solved {
    VF dx;  // place in the source relative to the patch's origin
    VF dy;
    VF depth;  // in the target
};

class Painter {
public:
    Painter(const PatchInput& input, const PatchList& list, SurfaceCanvas& canvas, std::vector<std::uint32_t>& behind)
        : input_{input},
          list_{list},
          canvas_{canvas},
          behind_{behind},
          source_size_px_{input.prepared->size_px},
          target_width_{canvas.frame().depth.width()},
          depths_{canvas.frame().depth.pixels().data()},
          colours_{canvas.frame().colour.pixels().data()},
          linear_{input.prepared->linear_colours.get()},
          cubics_{srgb_cubics()},
          encode_{srgb8_from_linear15_table().data()} {}

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
            std::uint32_t bits = place(d, first, *matrix, group, placed);
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
                    paint_fragments(first, 1, solved, pixel_x, pixel_y, inside);
                }
            }
        }
    }

    // A patch and its homography, one or many.
    struct Patch {
        VF target_x, target_y, w, w_x, w_y, inverse_xx, inverse_xy, inverse_yx, inverse_yy, depth_factor;
        VF depth, gradient_x, gradient_y, left, right, top, bottom;
    };

    // Lays target pixels back onto the patch; true where they are inside of it.
    static HWY_INLINE hn::Mask<DF> solve(const Patch& patch, VF pixel_x, VF pixel_y, Solved& solved) {
        const VF half_px = hn::Set(DF{}, 0.5F);
        const VF one = hn::Set(DF{}, 1.0F);
        const VF ex = hn::Sub(hn::Add(pixel_x, half_px), patch.target_x);
        const VF ey = hn::Sub(hn::Add(pixel_y, half_px), patch.target_y);
        const VF kx = hn::Add(hn::Mul(patch.inverse_xx, ex), hn::Mul(patch.inverse_xy, ey));
        const VF ky = hn::Add(hn::Mul(patch.inverse_yx, ex), hn::Mul(patch.inverse_yy, ey));
        const VF share = hn::Sub(hn::Sub(one, hn::Mul(patch.w_x, kx)), hn::Mul(patch.w_y, ky));
        const VF place_w = hn::Div(patch.w, share);
        solved.dx = hn::Mul(place_w, kx);
        solved.dy = hn::Mul(place_w, ky);
        const VF source_depth =
            hn::Add(hn::Add(patch.depth, hn::Mul(patch.gradient_x, solved.dx)), hn::Mul(patch.gradient_y, solved.dy));
        solved.depth = hn::Max(hn::Mul(hn::Mul(patch.depth_factor, share), source_depth), hn::Zero(DF{}));
        const auto in_columns = hn::And(hn::Ge(solved.dx, patch.left), hn::Le(solved.dx, patch.right));
        const auto in_rows = hn::And(hn::Ge(solved.dy, patch.top), hn::Le(solved.dy, patch.bottom));
        const auto in_front = hn::And(hn::Gt(share, hn::Zero(DF{})), hn::Le(solved.depth, one));
        return hn::And(hn::And(in_columns, in_rows), in_front);
    }

    // Which of the patches have pixels in the band.
    template <class D, class M>
    HWY_INLINE std::uint32_t place(D d, std::size_t first, const PixelMatrix& m, M wanted, PlacedPatches& placed) {
        using V = hn::Vec<D>;
        const hn::RebindToSigned<D> di;
        const auto set = [&](float value) { return hn::Set(d, value); };
        const auto load = [&](const std::vector<float>& values) { return hn::LoadU(d, values.data() + first); };
        const V half_px = set(0.5F);
        const V x = hn::Add(load(list_.x), half_px);
        const V y = hn::Add(load(list_.y), half_px);
        const V z = load(list_.depth);
        const V gradient_x = load(list_.gradient_x);
        const V gradient_y = load(list_.gradient_y);
        const auto row = [&](float one, float of_y, float of_x, float of_z) {
            return hn::Add(hn::Add(hn::Add(set(one), hn::Mul(y, set(of_y))), hn::Mul(x, set(of_x))),
                           hn::Mul(z, set(of_z)));
        };
        const V w = row(m.one.w, m.y.w, m.x.w, m.z.w);
        const V inverse_w = hn::Div(set(1.0F), w);
        const V target_x = hn::Mul(row(m.one.x, m.y.x, m.x.x, m.z.x), inverse_w);
        const V target_y = hn::Mul(row(m.one.y, m.y.y, m.x.y, m.z.y), inverse_w);
        const auto column = [&](float of_place, V gradient, float of_z) {
            return hn::Add(set(of_place), hn::Mul(gradient, set(of_z)));
        };
        const V w_x = column(m.x.w, gradient_x, m.z.w);
        const V w_y = column(m.y.w, gradient_y, m.z.w);
        const V xx = hn::Sub(column(m.x.x, gradient_x, m.z.x), hn::Mul(target_x, w_x));
        const V xy = hn::Sub(column(m.y.x, gradient_y, m.z.x), hn::Mul(target_x, w_y));
        const V yx = hn::Sub(column(m.x.y, gradient_x, m.z.y), hn::Mul(target_y, w_x));
        const V yy = hn::Sub(column(m.y.y, gradient_y, m.z.y), hn::Mul(target_y, w_y));
        const V determinant = hn::Sub(hn::Mul(xx, yy), hn::Mul(xy, yx));

        // The box around the projected corners.
        V low_x = set(kOutOfReachPx);
        V low_y = low_x;
        V high_x = set(-kOutOfReachPx);
        V high_y = high_x;
        auto in_front = hn::Gt(w, hn::Zero(d));
        for (const auto* dx : {&list_.left, &list_.right}) {
            for (const auto* dy : {&list_.top, &list_.bottom}) {
                const V corner_x = load(*dx);
                const V corner_y = load(*dy);
                const V corner_w = hn::Add(hn::Add(w, hn::Mul(w_x, corner_x)), hn::Mul(w_y, corner_y));
                in_front = hn::And(in_front, hn::Gt(corner_w, hn::Zero(d)));
                const V scale = hn::Div(set(1.0F), corner_w);
                const V place_x =
                    hn::Add(target_x, hn::Mul(hn::Add(hn::Mul(xx, corner_x), hn::Mul(xy, corner_y)), scale));
                const V place_y =
                    hn::Add(target_y, hn::Mul(hn::Add(hn::Mul(yx, corner_x), hn::Mul(yy, corner_y)), scale));
                low_x = hn::Min(low_x, place_x);
                low_y = hn::Min(low_y, place_y);
                high_x = hn::Max(high_x, place_x);
                high_y = hn::Max(high_y, place_y);
            }
        }
        for (std::uint32_t bits = bits_of(d, hn::AndNot(in_front, wanted)); bits != 0; bits &= bits - 1) {
            behind_.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(__builtin_ctz(bits))));
        }
        const auto bounded = [&](V value, float low, float high) {
            return hn::ConvertTo(di, hn::Min(hn::Max(value, set(low)), set(high)));
        };
        const auto width = static_cast<float>(target_width_);
        const auto band_begin = static_cast<float>(canvas_.band().begin);
        const auto band_end = static_cast<float>(canvas_.band().end);
        const auto x_begin = bounded(hn::Ceil(hn::Sub(low_x, half_px)), 0.0F, width);
        const auto x_end = bounded(hn::Floor(hn::Add(high_x, half_px)), 0.0F, width);
        const auto y_begin = bounded(hn::Ceil(hn::Sub(low_y, half_px)), band_begin, band_end);
        const auto y_end = bounded(hn::Floor(hn::Add(high_y, half_px)), band_begin, band_end);
        const auto not_empty = hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end));
        const auto faces_us = hn::Gt(determinant, hn::Mul(set(kSmallestArea), hn::Mul(w, w)));
        const auto in_reach =
            hn::And(hn::Lt(hn::Abs(target_x), set(kOutOfReachPx)), hn::Lt(hn::Abs(target_y), set(kOutOfReachPx)));
        const auto visible =
            hn::And(hn::And(wanted, hn::And(in_front, in_reach)), hn::And(faces_us, hn::RebindMask(d, not_empty)));
        const std::uint32_t bits = bits_of(d, visible);
        if (bits == 0) return 0;

        const V scale = hn::Div(set(1.0F), determinant);
        hn::Store(target_x, d, placed.target_x);
        hn::Store(target_y, d, placed.target_y);
        hn::Store(w, d, placed.w);
        hn::Store(w_x, d, placed.w_x);
        hn::Store(w_y, d, placed.w_y);
        hn::Store(hn::Mul(yy, scale), d, placed.inverse_xx);
        hn::Store(hn::Neg(hn::Mul(xy, scale)), d, placed.inverse_xy);
        hn::Store(hn::Neg(hn::Mul(yx, scale)), d, placed.inverse_yx);
        hn::Store(hn::Mul(xx, scale), d, placed.inverse_yy);
        hn::Store(hn::Mul(set(m.depth_scale), inverse_w), d, placed.depth_factor);
        hn::Store(x_begin, di, placed.x_begin);
        hn::Store(x_end, di, placed.x_end);
        hn::Store(y_begin, di, placed.y_begin);
        hn::Store(y_end, di, placed.y_end);
        return bits;
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
                    paint_fragments(index, 0, solved, pixel_x, pixel_y, inside);
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
        const auto nearer = hn::And(inside, hn::Lt(shown, solved.depth));
        if (hn::AllFalse(DF{}, nearer)) return;
        auto* colours = reinterpret_cast<std::uint32_t*>(colours_ + index);
        const Taps taps = taps_of(origin_x, origin_y, solved, nearer);
        const auto colour = encoded(read_bilinear(taps.index, taps.fx, taps.fy));
        hn::BlendedStore(solved.depth, nearer, DF{}, depths_ + index);
        hn::BlendedStore(colour, hn::RebindMask(DU{}, nearer), DU{}, colours);
    }

    // Opaque pixels anywhere, each once.
    template <class M>
    HWY_INLINE void paint_scattered(VF origin_x, VF origin_y, const Solved& solved, VF pixel_x, VF pixel_y, M inside) {
        HWY_ALIGN std::int32_t indices[kMaxLanes];
        HWY_ALIGN float depths[kMaxLanes];
        HWY_ALIGN std::int32_t tap[kMaxLanes];
        HWY_ALIGN std::int32_t fx[kMaxLanes];
        HWY_ALIGN std::int32_t fy[kMaxLanes];
        const Taps taps = taps_of(origin_x, origin_y, solved, inside);
        hn::Store(indices_of(pixel_x, pixel_y), DI{}, indices);
        hn::Store(solved.depth, DF{}, depths);
        hn::Store(taps.index, DI{}, tap);
        hn::Store(taps.fx, DI{}, fx);
        hn::Store(taps.fy, DI{}, fy);
        for (std::uint32_t bits = bits_of(DF{}, inside); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            float& shown = depths_[indices[lane]];
            if (shown >= depths[lane]) continue;
            shown = depths[lane];
            const std::uint64_t word = read_word(tap[lane], fx[lane], fy[lane]);
            const auto channel = [&](unsigned shift) { return encode_[word >> shift & 0x7FFFU]; };
            colours_[indices[lane]] = {channel(0), channel(16), channel(32), 255};
        }
    }

    [[nodiscard]] HWY_INLINE hn::VFromD<DI> indices_of(VF pixel_x, VF pixel_y) const {
        return hn::Add(hn::Mul(hn::ConvertTo(DI{}, pixel_y), hn::Set(DI{}, target_width_)),
                       hn::ConvertTo(DI{}, pixel_x));
    }

    // Where a bilinear read begins, and its fractions in 15 bits; exactly 0 at a pixel centre.
    struct Taps {
        hn::VFromD<DI> index;
        hn::VFromD<DI> fx;
        hn::VFromD<DI> fy;
    };

    // Of the lanes `wanted`; the others' read somewhere in the image.
    template <class M>
    HWY_INLINE Taps taps_of(VF origin_x, VF origin_y, const Solved& solved, M wanted) const {
        const auto within = [&](VF origin, VF offset, int size) {
            const VF place = hn::Add(origin, hn::IfThenElseZero(wanted, offset));
            return hn::Min(hn::Max(place, hn::Zero(DF{})), hn::Set(DF{}, static_cast<float>(size - 1)));
        };
        const auto fraction = [&](VF place, hn::VFromD<DI> first) {
            const VF part = hn::Sub(place, hn::ConvertTo(DF{}, first));
            return hn::ConvertTo(DI{}, hn::Min(hn::Mul(part, hn::Set(DF{}, 32768.0F)), hn::Set(DF{}, 32767.0F)));
        };
        const VF x = within(origin_x, solved.dx, source_size_px_.x);
        const VF y = within(origin_y, solved.dy, source_size_px_.y);
        const auto x0 = hn::ConvertTo(DI{}, x);
        const auto y0 = hn::ConvertTo(DI{}, y);
        return {hn::Add(hn::Mul(y0, hn::Set(DI{}, source_size_px_.x)), x0), fraction(x, x0), fraction(y, y0)};
    }

    // 15-bit channels of Lanes(DF) pixels.
    struct LinearColours {
        hn::VFromD<DU> red_green;  // red in the lower half
        hn::VFromD<DU> blue;
    };

#if HWY_TARGET == HWY_SCALAR
    HWY_INLINE LinearColours read_bilinear(hn::VFromD<DI> tap, hn::VFromD<DI> fx, hn::VFromD<DI> fy) const {
        const std::uint64_t word = read_word(hn::GetLane(tap), hn::GetLane(fx), hn::GetLane(fy));
        return {hn::Set(DU{}, static_cast<std::uint32_t>(word)),
                hn::Set(DU{}, static_cast<std::uint32_t>(word >> 32U))};
    }
#else
    // One pixel per 128-bit block: its two upper neighbours in one load, its two lower ones in another.
    HWY_INLINE LinearColours read_bilinear(hn::VFromD<DI> tap, hn::VFromD<DI> fx, hn::VFromD<DI> fy) const {
        HWY_ALIGN std::int32_t taps[kMaxLanes];
        hn::Store(tap, DI{}, taps);
        __builtin_prefetch(linear_ + taps[0] + (kPrefetchRows + 1) * source_size_px_.x);
        __builtin_prefetch(linear_ + taps[kMaxLanes / 2] + (kPrefetchRows + 1) * source_size_px_.x);
        const auto across = twice_in_halves(fx);
        const auto down = twice_in_halves(fy);
        const auto first = read_blocks(taps, 0, across, down);
        const auto second = read_blocks(taps, 1, across, down);
        const auto third = read_blocks(taps, 2, across, down);
        const auto fourth = read_blocks(taps, 3, across, down);
        const hn::ScalableTag<std::uint64_t> d64;
        const auto low = hn::BitCast(DU{}, hn::ConcatEven(d64, second, first));
        const auto high = hn::BitCast(DU{}, hn::ConcatEven(d64, fourth, third));
        return {hn::ConcatEven(DU{}, high, low), hn::ConcatOdd(DU{}, high, low)};
    }

    [[nodiscard]] static HWY_INLINE hn::VFromD<DU> twice_in_halves(hn::VFromD<DI> fraction) {
        const auto bits = hn::BitCast(DU{}, fraction);
        return hn::Or(bits, hn::ShiftLeft<16>(bits));
    }

    // The pixels of a quarter of the lanes; each one's channels in the lower half of its block.
    HWY_INLINE hn::Vec<hn::ScalableTag<std::uint64_t> > read_blocks(const std::int32_t* taps, int quarter,
                                                                    hn::VFromD<DU> across, hn::VFromD<DU> down) const {
        const hn::ScalableTag<std::int16_t> d16;
        constexpr int kBlocks = HWY_MAX_BYTES / 16;
        const std::int32_t* first = taps + quarter * kBlocks;
        const auto pixel =
            hn::IndicesFromVec(DF{}, hn::Add(hn::ShiftRight<2>(hn::Iota(DI{}, 0)), hn::Set(DI{}, quarter * kBlocks)));
        const auto fx = hn::BitCast(d16, hn::TableLookupLanes(hn::BitCast(DF{}, across), pixel));
        const auto fy = hn::BitCast(d16, hn::TableLookupLanes(hn::BitCast(DF{}, down), pixel));
        const auto above = hn::BitCast(d16, load_blocks(linear_, first));
        const auto below = hn::BitCast(d16, load_blocks(linear_ + source_size_px_.x, first));
        const auto pair = hn::Add(above, hn::MulFixedPoint15(hn::Sub(below, above), fy));
        const auto right = hn::BitCast(d16, hn::ShiftRightLanes<4>(d16, pair));
        const auto mixed = hn::Add(pair, hn::MulFixedPoint15(hn::Sub(right, pair), fx));
        return hn::BitCast(hn::ScalableTag<std::uint64_t>{}, mixed);
    }

    [[nodiscard]] static HWY_INLINE hn::Vec<hn::ScalableTag<std::uint64_t> > load_blocks(const std::uint64_t* base,
                                                                                         const std::int32_t* taps) {
        const hn::FixedTag<std::uint64_t, 2> d128;
#if HWY_MAX_BYTES == 64
        const hn::FixedTag<std::uint64_t, 4> d256;
        const auto low = hn::Combine(d256, hn::LoadU(d128, base + taps[1]), hn::LoadU(d128, base + taps[0]));
        const auto high = hn::Combine(d256, hn::LoadU(d128, base + taps[3]), hn::LoadU(d128, base + taps[2]));
        return hn::Combine(hn::ScalableTag<std::uint64_t>{}, high, low);
#elif HWY_MAX_BYTES == 32
        return hn::Combine(hn::ScalableTag<std::uint64_t>{}, hn::LoadU(d128, base + taps[1]),
                           hn::LoadU(d128, base + taps[0]));
#else
        return hn::LoadU(d128, base + taps[0]);
#endif
    }
#endif

    // One pixel. Rows first, then columns, each step rounded to 15 bits: a + (b - a) * fraction.
    [[nodiscard]] HWY_INLINE std::uint64_t read_word(std::int32_t tap, std::int32_t fx, std::int32_t fy) const {
        const std::uint64_t* top = linear_ + tap;
        const std::uint64_t* bottom = top + source_size_px_.x;
#if HWY_TARGET == HWY_SCALAR
        std::uint64_t word = 0;
        for (unsigned shift = 0; shift < 48; shift += 16) {
            const auto at = [&](const std::uint64_t* from) {
                return static_cast<std::int32_t>(*from >> shift & 0xFFFFU);
            };
            const auto mix = [](std::int32_t a, std::int32_t b, std::int32_t f) {
                return a + (((b - a) * f + 0x4000) >> 15);
            };
            const std::int32_t left = mix(at(top), at(bottom), fy);
            const std::int32_t right = mix(at(top + 1), at(bottom + 1), fy);
            word |= static_cast<std::uint64_t>(mix(left, right, fx)) << shift;
        }
        return word;
#else
        const hn::FixedTag<std::int16_t, 8> d16;
        const hn::FixedTag<std::uint64_t, 2> d64;
        const auto above = hn::BitCast(d16, hn::LoadU(d64, top));
        const auto below = hn::BitCast(d16, hn::LoadU(d64, bottom));
        const auto down = hn::Set(d16, static_cast<std::int16_t>(fy));
        const auto across = hn::Set(d16, static_cast<std::int16_t>(fx));
        const auto pair = hn::Add(above, hn::MulFixedPoint15(hn::Sub(below, above), down));
        const auto right = hn::ShiftRightLanes<4>(d16, pair);
        const auto word = hn::Add(pair, hn::MulFixedPoint15(hn::Sub(right, pair), across));
        return hn::GetLane(hn::BitCast(d64, word));
#endif
    }

    // srgb8_from_linear15 of three channels, packed and opaque.
    HWY_INLINE hn::VFromD<DU> encoded(const LinearColours& linear) const {
        const auto mask = hn::Set(DU{}, 0x7FFFU);
        const auto red = encoded_channel(hn::And(linear.red_green, mask));
        const auto green = encoded_channel(hn::And(hn::ShiftRight<16>(linear.red_green), mask));
        const auto blue = encoded_channel(hn::And(linear.blue, mask));
        const auto low = hn::Or(red, hn::ShiftLeft<8>(green));
        return hn::Or(low, hn::Or(hn::ShiftLeft<16>(blue), hn::Set(DU{}, 0xFF000000U)));
    }

    HWY_INLINE hn::VFromD<DU> encoded_channel(hn::VFromD<DU> linear15) const {
        const VF value = hn::ConvertTo(DF{}, hn::BitCast(DI{}, linear15));
        const auto exponent =
            hn::Sub(hn::BitCast(DI{}, hn::ShiftRight<23>(hn::BitCast(DU{}, value))), hn::Set(DI{}, 127));
        const auto octave = hn::Max(exponent, hn::Zero(DI{}));
        const VF third = coefficient(cubics_.third, octave);
        const VF second = coefficient(cubics_.second, octave);
        const VF first = coefficient(cubics_.first, octave);
        const VF constant = coefficient(cubics_.constant, octave);
        VF sum = hn::Add(hn::Mul(third, value), second);
        sum = hn::Add(hn::Mul(sum, value), first);
        sum = hn::Add(hn::Mul(sum, value), constant);
        return hn::BitCast(DU{}, hn::ConvertTo(DI{}, hn::Add(sum, hn::Set(DF{}, 0.5F))));
    }

    [[nodiscard]] static HWY_INLINE VF coefficient(const std::array<float, 16>& table, hn::VFromD<DI> octave) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
        return hn::TableLookupLanes(hn::LoadU(DF{}, table.data()), hn::IndicesFromVec(DF{}, octave));
#else
        return hn::GatherIndex(DF{}, table.data(), octave);
#endif
    }

    // Corner groups of edge cells: each weighs its corners alone, and covers as much as they weigh. Lane k shows patch
    // `first + k * stride`.
    template <class M>
    HWY_INLINE void paint_fragments(std::size_t first, std::size_t stride, const Solved& solved, VF pixel_x, VF pixel_y,
                                    M inside) {
        HWY_ALIGN std::int32_t indices[kMaxLanes];
        HWY_ALIGN float depths[kMaxLanes];
        HWY_ALIGN float u[kMaxLanes];
        HWY_ALIGN float v[kMaxLanes];
        const auto in_cell = [](VF place) { return hn::Min(hn::Max(place, hn::Zero(DF{})), hn::Set(DF{}, 1.0F)); };
        hn::Store(indices_of(pixel_x, pixel_y), DI{}, indices);
        hn::Store(solved.depth, DF{}, depths);
        hn::Store(in_cell(solved.dx), DF{}, u);
        hn::Store(in_cell(solved.dy), DF{}, v);
        for (std::uint32_t bits = bits_of(DF{}, inside); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            if (depths_[indices[lane]] >= depths[lane]) continue;
            paint_fragment(first + lane * stride, static_cast<std::size_t>(indices[lane]), depths[lane], u[lane],
                           v[lane]);
        }
    }

    HWY_INLINE void paint_fragment(std::size_t patch, std::size_t index, float depth, float u, float v) {
        const int x = static_cast<int>(list_.x[patch]);
        const int y = static_cast<int>(list_.y[patch]);
        const std::size_t right = x + 1 < source_size_px_.x ? 1 : 0;
        const std::size_t down = y + 1 < source_size_px_.y ? static_cast<std::size_t>(source_size_px_.x) : 0;
        const std::uint64_t* first = linear_ +
                                     static_cast<std::size_t>(y) * static_cast<std::size_t>(source_size_px_.x) +
                                     static_cast<std::size_t>(x);
        const std::uint64_t words[4] = {first[0], first[right], first[down], first[right + down]};
        const float weights[4] = {(1.0F - u) * (1.0F - v), u * (1.0F - v), (1.0F - u) * v, u * v};
        glm::vec3 linear{0.0F};
        float coverage = 0.0F;
        for (std::uint32_t corners = list_.corners[patch]; corners != 0; corners &= corners - 1) {
            const auto corner = static_cast<std::size_t>(__builtin_ctz(corners));
            const std::uint64_t word = words[corner];
            coverage += weights[corner];
            linear += weights[corner] * glm::vec3{static_cast<float>(word & 0xFFFFU),
                                                  static_cast<float>(word >> 16U & 0xFFFFU),
                                                  static_cast<float>(word >> 32U & 0xFFFFU)};
        }
        if (coverage < kSmallestCoverage) return;
        canvas_.put_fragment(index, depth, coverage, linear * (1.0F / coverage));
    }

    const PatchInput& input_;
    const PatchList& list_;
    SurfaceCanvas& canvas_;
    std::vector<std::uint32_t>& behind_;
    glm::ivec2 source_size_px_;
    std::int32_t target_width_;
    float* depths_;
    Rgba8* colours_;
    const std::uint64_t* linear_;
    const SrgbCubics& cubics_;
    const std::uint8_t* encode_;  // the same curve as a table, for reads one by one
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
