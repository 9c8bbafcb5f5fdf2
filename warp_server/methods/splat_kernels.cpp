#include "warp_server/methods/splat_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/splat_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <cstring>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/splat_footprint.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

template <class D>
using Vec = hn::Vec<D>;
template <class D>
using Mask = hn::Mask<D>;

constexpr float kNoNeighbour = 8.0F;        // a depth that lies on no surface: depths are at most 1
constexpr float kOutOfReachPx = 100000.0F;  // places beyond are in no image; keeps later sums far from overflow

// 1, 2 and 4 measured: 8.3, 7.7 and 8.0 ms for a picture turned by 10 degrees; 11.6 without.
constexpr std::ptrdiff_t kPrefetchRows = 2;

// What one row of points needs.
struct RowContext {
    const SplatInput* input;
    Image<WinnerKey>* keys;
    int y;
    int written_begin;
    int written_end;
    std::uint64_t bad_depth;
    std::uint64_t unknown_object;
};

template <class D>
hn::VFromD<hn::RebindToUnsigned<D>> load_ids(D d, const ObjectId* ids) {
    const hn::RebindToUnsigned<D> du;
    const hn::Rebind<std::uint16_t, D> d16;
    (void)d;
    return hn::PromoteTo(du, hn::LoadU(d16, ids));
}

// Depths of the neighbours `offset` pixels away, kNoNeighbour where they are of another object or unusable.
template <class D, class Ids>
Vec<D> neighbour_depths(D d, const float* depths, const ObjectId* ids, std::ptrdiff_t offset, Ids own_ids) {
    const Vec<D> depth = hn::LoadU(d, depths + offset);
    const auto same_object = hn::RebindMask(d, hn::Eq(load_ids(d, ids + offset), own_ids));
    const auto usable = hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
    return hn::IfThenElse(hn::And(same_object, usable), depth, hn::Set(d, kNoNeighbour));
}

// one_sided_difference of splat_footprint.h.
template <class D>
Vec<D> one_sided_differences(D d, Vec<D> depth, Vec<D> before, Vec<D> after) {
    const Vec<D> to_before = hn::Sub(depth, before);
    const Vec<D> to_after = hn::Sub(after, depth);
    const Vec<D> smaller = hn::IfThenElse(hn::Lt(hn::Abs(to_before), hn::Abs(to_after)), to_before, to_after);
    const auto on_surface = hn::Lt(hn::Abs(smaller), hn::Mul(hn::Set(d, kSameSurfaceDepthPart), depth));
    return hn::IfThenElseZero(on_surface, smaller);
}

template <class D>
Vec<D> half_extents(D d, Vec<D> along_x, Vec<D> along_y) {
    const Vec<D> half = hn::Mul(hn::Set(d, 0.5F), hn::Add(hn::Abs(along_x), hn::Abs(along_y)));
    return hn::Min(hn::Max(half, hn::Set(d, 0.5F)), hn::Set(d, kLargestHalfExtentPx));
}

// Keys of points that cover more than one pixel, one lane.
HWY_NOINLINE void write_large_point(Image<WinnerKey>& keys, float x_px, float y_px, float depth,
                                    const PixelRange& columns, const PixelRange& rows, Rgba8 colour) {
    for (int row = rows.begin; row < rows.end; ++row) {
        const float dy = static_cast<float>(row) + 0.5F - y_px;
        for (int column = columns.begin; column < columns.end; ++column) {
            const float dx = static_cast<float>(column) + 0.5F - x_px;
            WinnerKey& winner = keys.at(column, row);
            winner = std::max(winner, winner_key(depth, dx * dx + dy * dy, colour));
        }
    }
}

// Lanes(d) pixels from column x on that are of one object. `wanted` masks the lanes.
template <class D, class Ids>
HWY_INLINE void splat_lanes(D d, RowContext& row, int x, const PixelMatrix& m, Mask<D> wanted, Vec<D> depth, Ids ids) {
    using DU = hn::RebindToUnsigned<D>;
    using DI = hn::RebindToSigned<D>;
    const DU du;
    const DI di;
    const CpuPixels& pixels = *row.input->pixels;
    const int width = pixels.depth.width();
    const int height = pixels.depth.height();
    const int y = row.y;
    const float* depths = pixels.depth.row(y).data() + x;
    const ObjectId* id_row = pixels.object_id.row(y).data() + x;

    const float y_px = static_cast<float>(y) + 0.5F;
    const Vec<D> x_px = hn::Add(hn::Iota(d, static_cast<float>(x)), hn::Set(d, 0.5F));
    const auto row_term = [&](float one, float column_y, float column_x, float column_z) {
        const Vec<D> start = hn::Set(d, one + y_px * column_y);
        return hn::Add(hn::Add(start, hn::Mul(x_px, hn::Set(d, column_x))), hn::Mul(depth, hn::Set(d, column_z)));
    };
    const Vec<D> w = row_term(m.one.w, m.y.w, m.x.w, m.z.w);
    const Vec<D> inverse_w = hn::Div(hn::Set(d, 1.0F), w);
    const Vec<D> target_x = hn::Mul(row_term(m.one.x, m.y.x, m.x.x, m.z.x), inverse_w);
    const Vec<D> target_y = hn::Mul(row_term(m.one.y, m.y.y, m.x.y, m.z.y), inverse_w);
    const Vec<D> target_depth = hn::Mul(hn::Mul(depth, hn::Set(d, m.depth_scale)), inverse_w);

    // Points whose largest extent ends outside of the picture need no more work.
    const auto can_touch = [&](Vec<D> place, int size) {
        return hn::And(hn::Gt(place, hn::Set(d, -kLargestHalfExtentPx)),
                       hn::Lt(place, hn::Set(d, static_cast<float>(size) + kLargestHalfExtentPx)));
    };
    auto valid = hn::And(wanted, hn::Gt(w, hn::Zero(d)));
    valid = hn::And(valid, hn::Le(target_depth, hn::Set(d, 1.0F)));
    valid = hn::And(valid, hn::And(can_touch(target_x, row.keys->width()), can_touch(target_y, row.keys->height())));
    if (hn::AllFalse(d, valid)) return;

    // Depth gradient of the own surface. Reading one pixel beyond a row's end meets the next row, which the masks
    // below undo; only the very first and last pixel of the image have no memory beside them, and the caller hands
    // those over one lane at a time.
    const Vec<D> none = hn::Set(d, kNoNeighbour);
    const bool at_left = x == 0;
    const bool at_right = x + static_cast<int>(hn::Lanes(d)) == width;
    const bool alone = hn::Lanes(d) == 1;
    Vec<D> left = none;
    Vec<D> right = none;
    if (!(at_left && alone)) left = neighbour_depths(d, depths, id_row, -1, ids);
    if (!(at_right && alone)) right = neighbour_depths(d, depths, id_row, 1, ids);
    if (at_left) left = hn::IfThenElse(hn::FirstN(d, 1), none, left);
    if (at_right) right = hn::IfThenElse(hn::FirstN(d, hn::Lanes(d) - 1), right, none);
    const Vec<D> above = y == 0 ? none : neighbour_depths(d, depths, id_row, -std::ptrdiff_t{width}, ids);
    const Vec<D> below = y + 1 == height ? none : neighbour_depths(d, depths, id_row, std::ptrdiff_t{width}, ids);
    const Vec<D> gradient_x = one_sided_differences(d, depth, left, right);
    const Vec<D> gradient_y = one_sided_differences(d, depth, above, below);

    const auto derivative = [&](float column, float column_w, Vec<D> place) {
        return hn::Mul(hn::Sub(hn::Set(d, column), hn::Mul(place, hn::Set(d, column_w))), inverse_w);
    };
    const Vec<D> z_x = derivative(m.z.x, m.z.w, target_x);
    const Vec<D> z_y = derivative(m.z.y, m.z.w, target_y);
    const Vec<D> half_x = half_extents(d, hn::Add(derivative(m.x.x, m.x.w, target_x), hn::Mul(gradient_x, z_x)),
                                       hn::Add(derivative(m.y.x, m.y.w, target_x), hn::Mul(gradient_y, z_x)));
    const Vec<D> half_y = half_extents(d, hn::Add(derivative(m.x.y, m.x.w, target_y), hn::Mul(gradient_x, z_y)),
                                       hn::Add(derivative(m.y.y, m.y.w, target_y), hn::Mul(gradient_y, z_y)));

    // Pixels whose centres lie in [place - half, place + half).
    const Vec<D> half_px = hn::Set(d, 0.5F);
    const Vec<D> limit_x = hn::Set(d, static_cast<float>(row.keys->width()));
    const Vec<D> limit_y = hn::Set(d, static_cast<float>(row.keys->height()));
    const auto first = [&](Vec<D> edge, Vec<D> limit) {
        return hn::Min(hn::Max(hn::Ceil(hn::Sub(edge, half_px)), hn::Zero(d)), limit);
    };
    const Vec<D> x_begin = first(hn::Sub(target_x, half_x), limit_x);
    const Vec<D> x_end = first(hn::Add(target_x, half_x), limit_x);
    const Vec<D> y_begin = first(hn::Sub(target_y, half_y), limit_y);
    const Vec<D> y_end = first(hn::Add(target_y, half_y), limit_y);
    valid = hn::And(valid, hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end)));
    const Vec<D> covered = hn::Mul(hn::Sub(x_end, x_begin), hn::Sub(y_end, y_begin));
    const auto single = hn::And(valid, hn::Le(covered, hn::Set(d, 1.0F)));

    // The key of the first covered pixel.
    const Vec<D> dx = hn::Sub(hn::Add(x_begin, half_px), target_x);
    const Vec<D> dy = hn::Sub(hn::Add(y_begin, half_px), target_y);
    const Vec<D> distance2 = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const Vec<D> farness = hn::Min(hn::Set(d, 254.0F), hn::Mul(distance2, hn::Set(d, 254.0F / kFarthestTold2_px)));
    const auto closeness = hn::Sub(hn::Set(du, 255U), hn::BitCast(du, hn::ConvertTo(di, farness)));
    const auto depth_bits = hn::BitCast(du, target_depth);
    const auto rest = hn::And(depth_bits, hn::Set(du, 0x7FFFU));
    const auto high = hn::Or(hn::Or(hn::ShiftLeft<17>(hn::ShiftRight<15>(depth_bits)), hn::ShiftLeft<9>(closeness)),
                             hn::ShiftRight<6>(rest));
    const auto* colours = reinterpret_cast<const std::uint32_t*>(pixels.colour.row(y).data() + x);
    const auto low = hn::Or(hn::ShiftLeft<26>(rest), hn::And(hn::LoadU(du, colours), hn::Set(du, 0xFFFFFFU)));
    const auto pixel =
        hn::Add(hn::Mul(hn::ConvertTo(di, y_begin), hn::Set(di, row.keys->width())), hn::ConvertTo(di, x_begin));

    HWY_ALIGN std::uint32_t high_lanes[kMaxLanes];
    HWY_ALIGN std::uint32_t low_lanes[kMaxLanes];
    HWY_ALIGN std::int32_t pixel_lanes[kMaxLanes];
    hn::Store(high, du, high_lanes);
    hn::Store(low, du, low_lanes);
    hn::Store(pixel, di, pixel_lanes);
    WinnerKey* keys = row.keys->pixels().data();
    // Rows below this one land below this one's places: their lines can come while the rest of the row is worked on.
    // Along the row itself the next places are no better known than by the processor. A wrong guess costs nothing.
    const std::ptrdiff_t rows_below = kPrefetchRows * row.keys->width();
    __builtin_prefetch(keys + pixel_lanes[0] + rows_below, 1);
    __builtin_prefetch(keys + pixel_lanes[hn::Lanes(d) / 2] + rows_below, 1);
    __builtin_prefetch(keys + pixel_lanes[hn::Lanes(d) - 1] + rows_below, 1);
    for (std::uint32_t bits = bits_of(d, single); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<unsigned>(__builtin_ctz(bits));
        const WinnerKey key = (WinnerKey{high_lanes[lane]} << 32U) | low_lanes[lane];
        WinnerKey& winner = keys[pixel_lanes[lane]];
        winner = std::max(winner, key);
    }

    // Rows written, for those who resolve.
    const auto lowest = hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(valid, y_begin, limit_y)));
    const auto highest = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(valid, y_end)));
    row.written_begin = std::min(row.written_begin, static_cast<int>(lowest));
    row.written_end = std::max(row.written_end, static_cast<int>(highest));

    const auto large = hn::AndNot(single, valid);
    if (hn::AllFalse(d, large)) return;
    HWY_ALIGN float place[7][kMaxLanes];
    hn::Store(target_x, d, place[0]);
    hn::Store(target_y, d, place[1]);
    hn::Store(target_depth, d, place[2]);
    hn::Store(x_begin, d, place[3]);
    hn::Store(x_end, d, place[4]);
    hn::Store(y_begin, d, place[5]);
    hn::Store(y_end, d, place[6]);
    for (std::uint32_t bits = bits_of(d, large); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<unsigned>(__builtin_ctz(bits));
        write_large_point(*row.keys, place[0][lane], place[1][lane], place[2][lane],
                          {static_cast<int>(place[3][lane]), static_cast<int>(place[4][lane])},
                          {static_cast<int>(place[5][lane]), static_cast<int>(place[6][lane])},
                          pixels.colour.at(x + static_cast<int>(lane), y));
    }
}

// Lanes(d) pixels from column x on, of any objects.
template <class D>
HWY_INLINE void splat_block(D d, RowContext& row, int x) {
    const hn::RebindToUnsigned<D> du;
    const CpuPixels& pixels = *row.input->pixels;
    const Vec<D> depth = hn::LoadU(d, pixels.depth.row(row.y).data() + x);
    const ObjectId* id_row = pixels.object_id.row(row.y).data() + x;
    const auto ids = load_ids(d, id_row);
    const auto background = hn::And(hn::Eq(depth, hn::Zero(d)), hn::RebindMask(d, hn::Eq(ids, hn::Zero(du))));
    if (hn::AllTrue(d, background)) return;
    const auto usable = hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
    auto remaining = hn::Not(background);
    while (!hn::AllFalse(d, remaining)) {  // one turn per object, and most blocks have one
        const ObjectId id = id_row[hn::FindFirstTrue(d, remaining)];
        const auto same = hn::RebindMask(d, hn::Eq(ids, hn::Set(du, std::uint32_t{id})));
        const auto group = hn::And(remaining, same);
        remaining = hn::AndNot(same, remaining);
        const PixelMatrix* matrix = row.input->matrices->find(id);
        if (matrix == nullptr) {
            row.unknown_object += hn::CountTrue(d, group);
            continue;
        }
        const auto good = hn::And(group, usable);
        row.bad_depth += hn::CountTrue(d, group) - hn::CountTrue(d, good);
        splat_lanes(d, row, x, *matrix, good, depth, ids);
    }
}

void splat_row(RowContext& row) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int width = row.input->pixels->depth.width();
    const int last_row = row.input->pixels->depth.height() - 1;
    int x = 0;
    while (x < width) {
        const bool beside_nothing = (row.y == 0 && x == 0) || (row.y == last_row && x + lanes >= width);
        const int end = std::min(x + lanes, width);
        if (end - x == lanes && !beside_nothing) {
            splat_block(d, row, x);
            x = end;
        } else {
            for (; x < end; ++x) splat_block(d1, row, x);
        }
    }
}

RowRange splat_points_here(const SplatInput& input, RowRange source_rows, Image<WinnerKey>& keys,
                           WarpCounters& counters) {
    RowContext row{&input, &keys, 0, keys.height(), 0, 0, 0};
    for (row.y = source_rows.begin; row.y < source_rows.end; ++row.y) splat_row(row);
    counters.bad_depth += row.bad_depth;
    counters.unknown_object += row.unknown_object;
    return {std::min(row.written_begin, row.written_end), row.written_end};
}

// Shows source pixel `from` at target pixel `to` if it is background.
HWY_INLINE void show_background(const CpuPixels& pixels, std::size_t from, std::size_t to, DisplayFrame& out) {
    if (pixels.depth.pixels()[from] != 0.0F || pixels.object_id.pixels()[from] != 0) return;
    Rgba8 colour = pixels.colour.pixels()[from];
    colour.a = 255;
    out.colour.pixels()[to] = colour;
    out.coverage.pixels()[to] = Coverage::reached;
}

// The same for the place in the source where a target pixel's background lies.
void resolve_background(const CpuPixels& pixels, float place_x, float place_y, float place_w, std::size_t to,
                        DisplayFrame& out) {
    const bool inside = place_w > 0.0F && place_x >= 0.0F && place_y >= 0.0F &&
                        place_x < static_cast<float>(pixels.depth.width()) &&
                        place_y < static_cast<float>(pixels.depth.height());
    if (!inside) return;
    const std::size_t from = static_cast<std::size_t>(place_y) * static_cast<std::size_t>(pixels.depth.width()) +
                             static_cast<std::size_t>(place_x);
    show_background(pixels, from, to, out);
}

template <class D>
HWY_INLINE void resolve_block(D d, const CpuPixels& pixels, const glm::mat3& h, int x, int y, WinnerKey* keys,
                              DisplayFrame& out) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> d8;
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out.colour.width()) + static_cast<std::size_t>(x);
    auto* words = reinterpret_cast<std::uint32_t*>(keys + i);
    hn::VFromD<decltype(du)> low;
    hn::VFromD<decltype(du)> high;
    hn::LoadInterleaved2(du, words, low, high);
    hn::StoreU(hn::Zero(du), du, words);
    hn::StoreU(hn::Zero(du), du, words + hn::Lanes(du));

    const auto colour = hn::Or(low, hn::Set(du, 0xFF000000U));  // the low word's rest of the depth is overwritten
    const auto rest = hn::Or(hn::ShiftLeft<6>(hn::And(high, hn::Set(du, 0x1FFU))), hn::ShiftRight<26>(low));
    const auto depth_bits = hn::Or(hn::ShiftLeft<15>(hn::ShiftRight<17>(high)), rest);
    const auto reached = hn::Ne(high, hn::Zero(du));
    hn::StoreU(colour, du, reinterpret_cast<std::uint32_t*>(out.colour.pixels().data() + i));
    hn::StoreU(hn::BitCast(d, depth_bits), d, out.depth.pixels().data() + i);
    const auto coverage = hn::IfThenElseZero(hn::RebindMask(di, reached), hn::Set(di, 1));
    hn::StoreU(hn::DemoteTo(d8, coverage), d8, reinterpret_cast<std::uint8_t*>(out.coverage.pixels().data() + i));
    if (hn::AllTrue(du, reached)) return;

    const float y_px = static_cast<float>(y) + 0.5F;
    const Vec<D> x_px = hn::Add(hn::Iota(d, static_cast<float>(x)), hn::Set(d, 0.5F));
    const auto row_term = [&](int component) {
        return hn::Add(hn::Set(d, h[2][component] + y_px * h[1][component]),
                       hn::Mul(x_px, hn::Set(d, h[0][component])));
    };
    const Vec<D> w = row_term(2);
    const Vec<D> place_x = hn::Div(row_term(0), w);
    const Vec<D> place_y = hn::Div(row_term(1), w);
    const auto width = hn::Set(d, static_cast<float>(pixels.depth.width()));
    const auto height = hn::Set(d, static_cast<float>(pixels.depth.height()));
    auto inside = hn::And(hn::Gt(w, hn::Zero(d)), hn::And(hn::Ge(place_x, hn::Zero(d)), hn::Ge(place_y, hn::Zero(d))));
    inside = hn::And(inside, hn::And(hn::Lt(place_x, width), hn::Lt(place_y, height)));
    const auto wanted = hn::AndNot(hn::RebindMask(d, reached), inside);
    if (hn::AllFalse(d, wanted)) return;
    const auto index =
        hn::Add(hn::Mul(hn::ConvertTo(di, hn::IfThenElseZero(inside, place_y)), hn::Set(di, pixels.depth.width())),
                hn::ConvertTo(di, hn::IfThenElseZero(inside, place_x)));
    HWY_ALIGN std::int32_t from[kMaxLanes];
    hn::Store(index, di, from);
    const auto in_a_row = hn::Eq(index, hn::Iota(di, from[0]));
    if (hn::AllTrue(di, hn::And(in_a_row, hn::RebindMask(di, inside)))) {
        // Most blocks of a slowly turning picture show pixels that are neighbours in the source, too.
        const std::size_t first = static_cast<std::size_t>(from[0]);
        const auto depth = hn::LoadU(d, pixels.depth.pixels().data() + first);
        const auto ids = load_ids(d, pixels.object_id.pixels().data() + first);
        const auto background = hn::And(hn::Eq(depth, hn::Zero(d)), hn::RebindMask(d, hn::Eq(ids, hn::Zero(du))));
        const auto shown = hn::And(wanted, background);
        const auto source =
            hn::Or(hn::LoadU(du, reinterpret_cast<const std::uint32_t*>(pixels.colour.pixels().data() + first)),
                   hn::Set(du, 0xFF000000U));
        const auto both = hn::IfThenElse(hn::RebindMask(du, shown), source, colour);
        hn::StoreU(both, du, reinterpret_cast<std::uint32_t*>(out.colour.pixels().data() + i));
        const auto all_reached = hn::Or(hn::RebindMask(di, shown), hn::RebindMask(di, reached));
        hn::StoreU(hn::DemoteTo(d8, hn::IfThenElseZero(all_reached, hn::Set(di, 1))), d8,
                   reinterpret_cast<std::uint8_t*>(out.coverage.pixels().data() + i));
        return;
    }
    for (std::uint32_t bits = bits_of(d, wanted); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
        show_background(pixels, static_cast<std::size_t>(from[lane]), i + lane, out);
    }
}

void resolve_pixel(const CpuPixels& pixels, const glm::mat3& h, int x, int y, WinnerKey& key, DisplayFrame& out) {
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out.colour.width()) + static_cast<std::size_t>(x);
    out.colour.pixels()[i] = winner_colour(key);
    out.depth.pixels()[i] = winner_depth(key);
    out.coverage.pixels()[i] = key != 0 ? Coverage::reached : Coverage::hole;
    if (key == 0) {
        const float y_px = static_cast<float>(y) + 0.5F;
        const float x_px = static_cast<float>(x) + 0.5F;
        const auto term = [&](int component) {
            return h[2][component] + y_px * h[1][component] + x_px * h[0][component];
        };
        resolve_background(pixels, term(0) / term(2), term(1) / term(2), term(2), i, out);
    }
    key = 0;
}

void resolve_keys_here(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows,
                       Image<WinnerKey>& keys, DisplayFrame& out) {
    const hn::ScalableTag<float> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int y = target_rows.begin; y < target_rows.end; ++y) {
        int x = 0;
        for (; x + lanes <= keys.width(); x += lanes) {
            resolve_block(d, *input.pixels, background.source_px_from_target_px, x, y, keys.pixels().data(), out);
        }
        for (; x < keys.width(); ++x) {
            resolve_pixel(*input.pixels, background.source_px_from_target_px, x, y, keys.at(x, y), out);
        }
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(splat_points_here);
HWY_EXPORT(resolve_keys_here);

RowRange splat_points(const SplatInput& input, RowRange source_rows, Image<WinnerKey>& keys, WarpCounters& counters) {
    return HWY_DYNAMIC_DISPATCH(splat_points_here)(input, source_rows, keys, counters);
}

void merge_keys(RowRange rows, Image<WinnerKey>& from, Image<WinnerKey>& into) {
    for (int y = rows.begin; y < rows.end; ++y) {
        const std::span<WinnerKey> theirs = from.row(y);
        const std::span<WinnerKey> ours = into.row(y);
        for (std::size_t x = 0; x < theirs.size(); ++x) {
            ours[x] = std::max(ours[x], theirs[x]);
            theirs[x] = 0;
        }
    }
}

void resolve_keys(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows,
                  Image<WinnerKey>& keys, DisplayFrame& out) {
    HWY_DYNAMIC_DISPATCH(resolve_keys_here)(input, background, target_rows, keys, out);
}

}  // namespace lw
#endif
