#include "warp_server/methods/splat_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/splat_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/splat_footprint.h"
#include "warp_server/methods/splat_points.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// Stands for a mask where every lane is wanted.
struct AllLanes {};

// Keys on their way to the pixels, gathered so that many points are placed in a row before the first key is written.
// Placing a point is a long chain of dependent operations, which the processor works off for several blocks at once
// until it has guessed a branch wrong; and where a loop over the lanes that are left will end, nobody can foresee.
class PendingKeys {
public:
    template <class D, class VU, class VI>
    HWY_INLINE void add(D d, hn::Mask<D> wanted, VU high, VU low, VI place) {
        const hn::RebindToUnsigned<D> du;
        const hn::RebindToSigned<D> di;
        const std::size_t at = count_;
        count_ = at + hn::CountTrue(d, wanted);
        const auto lanes = hn::RebindMask(du, wanted);
        store_keys(du, hn::Compress(high, lanes), hn::Compress(low, lanes), at);
        hn::StoreU(hn::Compress(place, hn::RebindMask(di, wanted)), di, place_ + at);
    }
    template <class D, class VU, class VI>
    HWY_INLINE void add(D d, AllLanes /*wanted*/, VU high, VU low, VI place) {
        const hn::RebindToUnsigned<D> du;
        const hn::RebindToSigned<D> di;
        const std::size_t at = count_;
        count_ = at + hn::Lanes(d);
        store_keys(du, high, low, at);
        hn::StoreU(place, di, place_ + at);
    }
    HWY_INLINE void write_if_many(WinnerKey* keys) {
        if (count_ > kMany) write(keys);
    }
    void write(WinnerKey* keys) {
        const std::size_t count = count_;
        for (std::size_t i = 0; i < count; ++i) {
            const WinnerKey key = keys_[i];
            WinnerKey& winner = keys[place_[i]];
            // Without a branch: where the head turned sideways nobody foresees which of two points lies closer to the
            // pixel, and guesses took a third of the time.
            const WinnerKey before = winner;
            winner = key > before ? key : before;
        }
        count_ = 0;
    }

private:
    template <class DU, class VU>
    HWY_INLINE void store_keys(DU du, VU high, VU low, std::size_t at) {
        hn::StoreInterleaved2(low, high, du, reinterpret_cast<std::uint32_t*>(keys_ + at));
    }

    static constexpr std::size_t kMany = 1024;                   // fits the first cache; 128 took a tenth more time
    static constexpr std::size_t kRoom = kMany + 5 * kMaxLanes;  // one block adds up to four times, and stores whole

    std::size_t count_ = 0;
    WinnerKey keys_[kRoom];
    std::int32_t place_[kRoom];
};

// What the points of one band need.
struct BandContext {
    const CpuPixels* pixels;
    const ObjectMatrices* matrices;
    KeyRing* keys;
    RowRange target_rows;
    PendingKeys pending;
};

// Keys of points that cover more than two pixels along an axis, one lane.
HWY_NOINLINE void write_large_point(KeyRing& keys, float x_px, float y_px, float depth, const PixelRange& columns,
                                    const PixelRange& rows, Rgba8 colour) {
    for (int y = rows.begin; y < rows.end; ++y) {
        const float dy = static_cast<float>(y) + 0.5F - y_px;
        WinnerKey* row = keys.row(y);
        for (int x = columns.begin; x < columns.end; ++x) {
            const float dx = static_cast<float>(x) + 0.5F - x_px;
            WinnerKey& winner = row[x - keys.first_column()];
            winner = std::max(winner, winner_key(depth, dx * dx + dy * dy, colour));
        }
    }
}

template <class D>
HWY_INLINE bool none_of(D d, hn::Mask<D> lanes) {
    return hn::AllFalse(d, lanes);
}
template <class D>
HWY_INLINE bool none_of(D /*d*/, AllLanes /*lanes*/) {
    return false;
}
template <class D>
HWY_INLINE hn::Mask<D> both(hn::Mask<D> lanes, hn::Mask<D> others) {
    return hn::And(lanes, others);
}
template <class D>
HWY_INLINE hn::Mask<D> both(AllLanes /*lanes*/, hn::Mask<D> others) {
    return others;
}

// Of the `wanted` lanes those whose points are `in_front`: in a tile that lands inside all are.
template <TileLanding kLanding, class D, class Wanted>
HWY_INLINE auto seen_of(Wanted wanted, hn::Mask<D> in_front) {
    if constexpr (kLanding == TileLanding::crossing) {
        return both<D>(wanted, in_front);
    } else {
        return wanted;
    }
}

// Writes the points of Lanes(d) pixels of one row from column x on, as far as `wanted`, a mask or AllLanes.
template <TileLanding kLanding, class D, class Wanted>
HWY_INLINE void write_points(D d, BandContext& band, const PlacedPoints<D>& points, const Footprints<D>& size,
                             Wanted wanted, const Rgba8* colours) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    KeyRing& keys = *band.keys;

    // Pixels whose centres lie in [place - half, place + half), and one at least.
    const auto half_px = hn::Set(d, 0.5F);
    const auto one = hn::Set(d, 1.0F);
    const auto centre_x = hn::Sub(points.x_px, half_px);
    const auto centre_y = hn::Sub(points.y_px, half_px);
    auto x_begin = hn::Ceil(hn::Sub(centre_x, size.half_x_px));
    auto y_begin = hn::Ceil(hn::Sub(centre_y, size.half_y_px));
    auto dx = hn::Sub(x_begin, centre_x);
    auto dy = hn::Sub(y_begin, centre_y);
    // Rounded up and 1 at least, the number of pixels.
    auto columns = hn::Sub(size.half_x_px, dx);
    auto rows = hn::Sub(size.half_y_px, dy);
    auto valid = seen_of<kLanding, D>(wanted, points.in_front);
    if constexpr (kLanding == TileLanding::crossing) {
        const auto end_of = [&](hn::Vec<D> begin, hn::Vec<D> count) {
            return hn::Add(begin, hn::Max(hn::Ceil(count), one));
        };
        auto x_end = end_of(x_begin, columns);
        auto y_end = end_of(y_begin, rows);
        const auto clamp = [&](hn::Vec<D> value, int least, int greatest) {
            return hn::Min(hn::Max(value, hn::Set(d, static_cast<float>(least))),
                           hn::Set(d, static_cast<float>(greatest)));
        };
        const int end_column = keys.first_column() + keys.width();
        x_begin = clamp(x_begin, keys.first_column(), end_column);
        x_end = clamp(x_end, keys.first_column(), end_column);
        y_begin = clamp(y_begin, band.target_rows.begin, band.target_rows.end);
        y_end = clamp(y_end, band.target_rows.begin, band.target_rows.end);
        columns = hn::Sub(x_end, x_begin);
        rows = hn::Sub(y_end, y_begin);
        dx = hn::Sub(x_begin, centre_x);
        dy = hn::Sub(y_begin, centre_y);
        valid = hn::And(valid, hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end)));
    }
    if (none_of(d, valid)) return;

    const KeyParts<D> parts =
        key_parts(d, points.depth, hn::LoadU(du, reinterpret_cast<const std::uint32_t*>(colours)));
    // From here to 2^22 the bits of a float count in ones, which spares a conversion.
    constexpr float kOnes = 8388608.0F;
    const auto ones = [&](hn::Vec<D> whole) { return hn::BitCast(di, hn::Add(whole, hn::Set(d, kOnes))); };
    const auto x_first = hn::Sub(ones(x_begin), hn::Set(di, std::bit_cast<std::int32_t>(kOnes) + keys.first_column()));
    const auto row_start = [&](hn::VFromD<decltype(di)> row) {
        return hn::Mul(hn::And(row, hn::Set(di, keys.slots() - 1)), hn::Set(di, keys.stride()));
    };
    const auto y_first = ones(y_begin);
    const auto place = hn::Add(row_start(y_first), x_first);
    band.pending.add(d, valid, high_of_key(d, parts, dx, dy), parts.low, place);
    band.pending.write_if_many(keys.data());

    // The second column and row of points somewhat larger than a pixel.
    const auto wide = both<D>(valid, hn::Gt(columns, one));
    const auto tall = both<D>(valid, hn::Gt(rows, one));
    if (hn::AllFalse(d, hn::Or(wide, tall))) return;
    const auto place_below = hn::Add(row_start(hn::Add(y_first, hn::Set(di, 1))), x_first);
    const auto dx_right = hn::Add(dx, one);
    const auto dy_below = hn::Add(dy, one);
    const auto right = hn::Set(di, 1);
    band.pending.add(d, wide, high_of_key(d, parts, dx_right, dy), parts.low, hn::Add(place, right));
    band.pending.add(d, tall, high_of_key(d, parts, dx, dy_below), parts.low, place_below);
    const auto wide_and_tall = hn::And(wide, tall);
    if (!hn::AllFalse(d, wide_and_tall)) {
        band.pending.add(d, wide_and_tall, high_of_key(d, parts, dx_right, dy_below), parts.low,
                         hn::Add(place_below, right));
    }

    const auto two = hn::Set(d, 2.0F);
    const auto large = both<D>(valid, hn::Or(hn::Gt(columns, two), hn::Gt(rows, two)));
    if (hn::AllFalse(d, large)) return;
    HWY_ALIGN float lanes[7][kMaxLanes];
    hn::Store(points.x_px, d, lanes[0]);
    hn::Store(points.y_px, d, lanes[1]);
    hn::Store(points.depth, d, lanes[2]);
    hn::Store(x_begin, d, lanes[3]);
    hn::Store(hn::Add(x_begin, hn::Max(hn::Ceil(columns), one)), d, lanes[4]);
    hn::Store(y_begin, d, lanes[5]);
    hn::Store(hn::Add(y_begin, hn::Max(hn::Ceil(rows), one)), d, lanes[6]);
    for (std::uint32_t bits = bits_of(d, large); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        write_large_point(keys, lanes[0][lane], lanes[1][lane], lanes[2][lane],
                          {static_cast<int>(lanes[3][lane]), static_cast<int>(lanes[4][lane])},
                          {static_cast<int>(lanes[5][lane]), static_cast<int>(lanes[6][lane])}, colours[lane]);
    }
}

// Depth per source pixel along one axis, `offset` pixels from one to the next.
template <class D>
HWY_INLINE hn::Vec<D> slopes(D d, const float* depths, std::ptrdiff_t offset, std::uint32_t after,
                             std::uint32_t before) {
    const auto depth = hn::LoadU(d, depths);
    // Where no lane asks for a neighbour, there may be no memory.
    const auto to_after = hn::Sub(hn::LoadU(d, depths + (after != 0 ? offset : 0)), depth);
    const auto to_before = hn::Sub(depth, hn::LoadU(d, depths - (before != 0 ? offset : 0)));
    return hn::IfThenElse(lanes_of_bits(d, before), to_before, hn::IfThenElseZero(lanes_of_bits(d, after), to_after));
}

// Lanes(d) pixels of a run, of which `first` is the first.
template <TileLanding kLanding, class D>
HWY_INLINE void splat_some(D d, BandContext& band, const SplatRun& run, const PixelMatrix& m, int first) {
    const auto bits = [&](std::uint16_t mask) {
        return (std::uint32_t{mask} >> static_cast<unsigned>(first)) & ((1U << hn::Lanes(d)) - 1U);
    };
    if (bits(run.points) == 0) return;
    const int x = run.x_px + first;
    const float* depths = band.pixels->depth.row(run.y_px).data() + x;
    const std::ptrdiff_t width = band.pixels->depth.width();
    const LaneMatrices<D> matrices = same_matrices(d, m, run.y_px);
    const PlacedPoints<D> points = place_points(d, matrices, x, hn::LoadU(d, depths));
    const auto gradient_x = slopes(d, depths, 1, bits(run.after_x), bits(run.before_x));
    const auto gradient_y = slopes(d, depths, width, bits(run.after_y), bits(run.before_y));
    const Footprints<D> size = footprints(d, matrices, points, gradient_x, gradient_y);
    const auto wanted = lanes_of_bits(d, bits(run.points));
    write_points<kLanding>(d, band, points, size, wanted, band.pixels->colour.row(run.y_px).data() + x);
}

// The same of a smooth run.
template <TileLanding kLanding, class D>
HWY_INLINE void splat_all(D d, BandContext& band, const SplatRun& run, const PixelMatrix& m, int first) {
    const int x = run.x_px + first;
    const float* depths = band.pixels->depth.row(run.y_px).data() + x;
    const auto depth = hn::LoadU(d, depths);
    const LaneMatrices<D> matrices = same_matrices(d, m, run.y_px);
    const PlacedPoints<D> points = place_points(d, matrices, x, depth);
    const auto gradient_x = hn::Sub(hn::LoadU(d, depths + 1), depth);
    const auto gradient_y = hn::Sub(hn::LoadU(d, depths + band.pixels->depth.width()), depth);
    const Footprints<D> size = footprints(d, matrices, points, gradient_x, gradient_y);
    write_points<kLanding>(d, band, points, size, AllLanes{}, band.pixels->colour.row(run.y_px).data() + x);
}

// Blocks follow each other down a column, each row of which is in a page of its own: no processor foresees that, and
// where rows are no whole pages long, waiting for it took half of the time. Inlined, because GCC drops calls of
// functions that do nothing but this.
HWY_INLINE void fetch(const CpuPixels& pixels, const SplatRun& run) {
    __builtin_prefetch(pixels.depth.row(run.y_px).data() + run.x_px);
    __builtin_prefetch(pixels.colour.row(run.y_px).data() + run.x_px);
}

// As many as a tile has blocks. With 32 `splat` took 5 % longer, or a fifth where rows are no whole pages long; with
// 128 as long.
constexpr std::size_t kRunsAhead = 64;

// Beside the first and the last pixel of the image there is no memory, and a row's last block may not be whole.
bool must_be_placed_one_by_one(const SplatRun& run, glm::ivec2 size_px) {
    const int end_x = run.x_px + kBlockWidth_px;
    return (run.y_px == 0 && run.x_px == 0) || end_x > size_px.x || (run.y_px + 1 == size_px.y && end_x == size_px.x);
}

template <TileLanding kLanding>
void splat_tile(BandContext& band, const SplatTiles& tiles, const TileRuns& tile) {
    const hn::CappedTag<float, kBlockWidth_px> d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const std::span<const SplatRun> runs{tiles.runs};
    const auto for_each = [&](std::size_t begin, std::size_t end, const auto& place) LW_INLINE_LAMBDA {
        for (std::size_t i = begin; i < end; ++i) {
            fetch(*band.pixels, runs[std::min(i + kRunsAhead, runs.size() - 1)]);
            if (const PixelMatrix* m = band.matrices->find(runs[i].object)) place(runs[i], *m);
        }
    };
    for_each(tile.first, tile.first_other, [&](const SplatRun& run, const PixelMatrix& m) LW_INLINE_LAMBDA {
        for (int at = 0; at < kBlockWidth_px; at += lanes) splat_all<kLanding>(d, band, run, m, at);
    });
    for_each(tile.first_other, tile.end, [&](const SplatRun& run, const PixelMatrix& m) LW_INLINE_LAMBDA {
        if (must_be_placed_one_by_one(run, tiles.size_px)) {
            for (int at = 0; at < kBlockWidth_px; ++at) splat_some<kLanding>(d1, band, run, m, at);
            return;
        }
        for (int at = 0; at < kBlockWidth_px; at += lanes) splat_some<kLanding>(d, band, run, m, at);
    });
}

void splat_band_here(const SplatInput& input, int band, std::span<const TileLanding> landings, RowRange target_rows,
                     KeyRing& keys) {
    const SplatTiles& tiles = *input.tiles;
    // Never more rows than the ring holds, whatever the bounds said.
    target_rows.end = std::min(target_rows.end, target_rows.begin + keys.slots());
    BandContext context{input.pixels, input.matrices, &keys, target_rows, {}};
    for (int tile = 0; tile < tiles.tiles_per_band(); ++tile) {
        const TileLanding landing = landings[static_cast<std::size_t>(tile)];
        const TileRuns& runs = tiles.runs_of(band, tile);
        if (landing == TileLanding::inside) splat_tile<TileLanding::inside>(context, tiles, runs);
        if (landing == TileLanding::crossing) splat_tile<TileLanding::crossing>(context, tiles, runs);
    }
    context.pending.write(keys.data());
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(splat_band_here);

void splat_band(const SplatInput& input, int band, std::span<const TileLanding> landings, RowRange target_rows,
                KeyRing& keys) {
    HWY_DYNAMIC_DISPATCH(splat_band_here)(input, band, landings, target_rows, keys);
}

}  // namespace lw
#endif
