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

constexpr float kNoNeighbour = 8.0F;  // a depth that lies on no surface: depths are at most 1

// Keys on their way to the pixels, gathered so that many points are placed in a row before the first key is written.
// Placing a point is a long chain of dependent operations, which the processor works off for several blocks at once
// until it has guessed a branch wrong; and where a loop over the lanes that are left will end, nobody can foresee.
class PendingKeys {
public:
    template <class D, class VU, class VI>
    HWY_INLINE void add(D d, hn::Mask<D> wanted, VU high, VU low, VI place) {
        const hn::RebindToUnsigned<D> du;
        const hn::RebindToSigned<D> di;
        hn::StoreU(hn::Compress(high, hn::RebindMask(du, wanted)), du, high_ + count_);
        hn::StoreU(hn::Compress(low, hn::RebindMask(du, wanted)), du, low_ + count_);
        hn::StoreU(hn::Compress(place, hn::RebindMask(di, wanted)), di, place_ + count_);
        count_ += hn::CountTrue(d, wanted);
    }
    HWY_INLINE void write_if_many(WinnerKey* keys) {
        if (count_ > kMany) write(keys);
    }
    void write(WinnerKey* keys) {
        for (std::size_t i = 0; i < count_; ++i) {
            const WinnerKey key = (WinnerKey{high_[i]} << 32U) | low_[i];
            WinnerKey& winner = keys[place_[i]];
            // Without a branch: where the head turned sideways nobody foresees which of two points lies closer to the
            // pixel, and guesses took a third of the time.
            const WinnerKey before = winner;
            winner = key > before ? key : before;
        }
        count_ = 0;
    }

private:
    static constexpr std::size_t kMany = 1024;                   // fits the first cache; 128 took a tenth more time
    static constexpr std::size_t kRoom = kMany + 5 * kMaxLanes;  // one block adds up to four times, and stores whole

    std::size_t count_ = 0;
    std::uint32_t high_[kRoom];
    std::uint32_t low_[kRoom];
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

// Writes the points of Lanes(d) pixels of one row from column x on, as far as `wanted`.
template <TileLanding kLanding, class D>
HWY_INLINE void write_points(D d, BandContext& band, const PlacedPoints<D>& points, const Footprints<D>& size,
                             hn::Mask<D> wanted, const Rgba8* colours) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    KeyRing& keys = *band.keys;

    // Pixels whose centres lie in [place - half, place + half), and one at least.
    const auto half_px = hn::Set(d, 0.5F);
    const auto one = hn::Set(d, 1.0F);
    const auto begin_of = [&](hn::Vec<D> centre, hn::Vec<D> half) { return hn::Ceil(hn::Sub(centre, half)); };
    const auto end_of = [&](hn::Vec<D> centre, hn::Vec<D> half, hn::Vec<D> begin) {
        return hn::Max(hn::Ceil(hn::Add(centre, half)), hn::Add(begin, one));
    };
    const auto centre_x = hn::Sub(points.x_px, half_px);
    const auto centre_y = hn::Sub(points.y_px, half_px);
    auto x_begin = begin_of(centre_x, size.half_x_px);
    auto y_begin = begin_of(centre_y, size.half_y_px);
    auto x_end = end_of(centre_x, size.half_x_px, x_begin);
    auto y_end = end_of(centre_y, size.half_y_px, y_begin);
    auto valid = hn::And(wanted, points.in_front);
    if constexpr (kLanding == TileLanding::crossing) {
        const auto clamp = [&](hn::Vec<D> value, int least, int greatest) {
            return hn::Min(hn::Max(value, hn::Set(d, static_cast<float>(least))),
                           hn::Set(d, static_cast<float>(greatest)));
        };
        const int end_column = keys.first_column() + keys.width();
        x_begin = clamp(x_begin, keys.first_column(), end_column);
        x_end = clamp(x_end, keys.first_column(), end_column);
        y_begin = clamp(y_begin, band.target_rows.begin, band.target_rows.end);
        y_end = clamp(y_end, band.target_rows.begin, band.target_rows.end);
        valid = hn::And(valid, hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end)));
    }
    const auto columns = hn::Sub(x_end, x_begin);
    const auto rows = hn::Sub(y_end, y_begin);
    if (hn::AllFalse(d, valid)) return;

    const auto dx = hn::Sub(x_begin, centre_x);
    const auto dy = hn::Sub(y_begin, centre_y);
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
    const auto wide = hn::And(valid, hn::Gt(columns, one));
    const auto tall = hn::And(valid, hn::Gt(rows, one));
    if (hn::AllFalse(d, hn::Or(wide, tall))) return;
    const auto place_below = hn::Add(row_start(hn::Add(y_first, hn::Set(di, 1))), x_first);
    const auto dx_right = hn::Add(dx, one);
    const auto dy_below = hn::Add(dy, one);
    const auto right = hn::Set(di, 1);
    band.pending.add(d, wide, high_of_key(d, parts, dx_right, dy), parts.low, hn::Add(place, right));
    band.pending.add(d, tall, high_of_key(d, parts, dx, dy_below), parts.low, place_below);
    const auto both = hn::And(wide, tall);
    if (!hn::AllFalse(d, both)) {
        band.pending.add(d, both, high_of_key(d, parts, dx_right, dy_below), parts.low, hn::Add(place_below, right));
    }

    const auto two = hn::Set(d, 2.0F);
    const auto large = hn::And(valid, hn::Or(hn::Gt(columns, two), hn::Gt(rows, two)));
    if (hn::AllFalse(d, large)) return;
    HWY_ALIGN float lanes[7][kMaxLanes];
    hn::Store(points.x_px, d, lanes[0]);
    hn::Store(points.y_px, d, lanes[1]);
    hn::Store(points.depth, d, lanes[2]);
    hn::Store(x_begin, d, lanes[3]);
    hn::Store(x_end, d, lanes[4]);
    hn::Store(y_begin, d, lanes[5]);
    hn::Store(y_end, d, lanes[6]);
    for (std::uint32_t bits = bits_of(d, large); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        write_large_point(keys, lanes[0][lane], lanes[1][lane], lanes[2][lane],
                          {static_cast<int>(lanes[3][lane]), static_cast<int>(lanes[4][lane])},
                          {static_cast<int>(lanes[5][lane]), static_cast<int>(lanes[6][lane])}, colours[lane]);
    }
}

// A block whose pixels and neighbours are of one object and usable.
template <TileLanding kLanding, class D>
HWY_INLINE void splat_uniform(D d, BandContext& band, int x, int y, ObjectId object, const PixelMatrix& m) {
    const float* depths = band.pixels->depth.row(y).data() + x;
    const std::ptrdiff_t width = band.pixels->depth.width();
    const Rgba8* colours = band.pixels->colour.row(y).data() + x;
    const auto depth = hn::LoadU(d, depths);
    const LaneMatrices<D> matrices = same_matrices(d, m, y);
    const PlacedPoints<D> points = place_points(d, matrices, x, depth);
    const auto gradient_x = one_sided_differences(d, depth, hn::LoadU(d, depths - 1), hn::LoadU(d, depths + 1));
    const auto gradient_y = one_sided_differences(d, depth, hn::LoadU(d, depths - width), hn::LoadU(d, depths + width));
    const Footprints<D> size = footprints(d, matrices, points, gradient_x, gradient_y);
    // Object 0's background is not a point. Other objects may be infinitely far away and still move.
    const auto wanted = hn::Gt(depth, hn::Set(d, object == 0 ? 0.0F : -1.0F));
    write_points<kLanding>(d, band, points, size, wanted, colours);
}

template <class D>
hn::VFromD<hn::RebindToUnsigned<D>> load_ids(D d, const ObjectId* ids) {
    const hn::RebindToUnsigned<D> du;
    const hn::Rebind<std::uint16_t, D> d16;
    (void)d;
    return hn::PromoteTo(du, hn::LoadU(d16, ids));
}

// Depths of the neighbours `offset` pixels away, kNoNeighbour where they are of another object or unusable.
template <class D, class Ids>
hn::Vec<D> neighbour_depths(D d, const float* depths, const ObjectId* ids, std::ptrdiff_t offset, Ids own_ids) {
    const auto depth = hn::LoadU(d, depths + offset);
    const auto same_object = hn::RebindMask(d, hn::Eq(load_ids(d, ids + offset), own_ids));
    const auto usable = hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
    return hn::IfThenElse(hn::And(same_object, usable), depth, hn::Set(d, kNoNeighbour));
}

// Lanes(d) pixels from column x on, of any objects.
template <TileLanding kLanding, class D>
HWY_INLINE void splat_mixed(D d, BandContext& band, int x, int y) {
    const hn::RebindToUnsigned<D> du;
    const CpuPixels& pixels = *band.pixels;
    const int width = pixels.depth.width();
    const float* depths = pixels.depth.row(y).data() + x;
    const ObjectId* id_row = pixels.object_id.row(y).data() + x;
    const auto depth = hn::LoadU(d, depths);
    const auto ids = load_ids(d, id_row);
    const auto background = hn::And(hn::Eq(depth, hn::Zero(d)), hn::RebindMask(d, hn::Eq(ids, hn::Zero(du))));
    const auto usable = hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
    auto remaining = hn::AndNot(background, usable);
    if (hn::AllFalse(d, remaining)) return;

    // Reading one pixel beyond a row's end meets the next row, which the masks below undo; only the very first and last
    // pixel of the image have no memory beside them, and the caller hands those over one lane at a time.
    const auto none = hn::Set(d, kNoNeighbour);
    const bool at_left = x == 0;
    const bool at_right = x + static_cast<int>(hn::Lanes(d)) == width;
    const bool alone = hn::Lanes(d) == 1;
    auto left = none;
    auto right = none;
    if (!(at_left && alone)) left = neighbour_depths(d, depths, id_row, -1, ids);
    if (!(at_right && alone)) right = neighbour_depths(d, depths, id_row, 1, ids);
    if (at_left) left = hn::IfThenElse(hn::FirstN(d, 1), none, left);
    if (at_right) right = hn::IfThenElse(hn::FirstN(d, hn::Lanes(d) - 1), right, none);
    const auto above = y == 0 ? none : neighbour_depths(d, depths, id_row, -std::ptrdiff_t{width}, ids);
    const auto below =
        y + 1 == pixels.depth.height() ? none : neighbour_depths(d, depths, id_row, std::ptrdiff_t{width}, ids);
    const auto gradient_x = one_sided_differences(d, depth, left, right);
    const auto gradient_y = one_sided_differences(d, depth, above, below);

    // Lanes of several objects are placed together, each by its own matrix.
    auto wanted = hn::MaskFromVec(hn::Zero(d));
    auto matrices = LaneMatrices<D>{};
    while (!hn::AllFalse(d, remaining)) {  // one turn per object
        const ObjectId id = id_row[hn::FindFirstTrue(d, remaining)];
        const auto same = hn::RebindMask(d, hn::Eq(ids, hn::Set(du, std::uint32_t{id})));
        const auto group = hn::And(remaining, same);
        remaining = hn::AndNot(same, remaining);
        const PixelMatrix* m = band.matrices->find(id);
        if (m == nullptr) continue;
        wanted = hn::Or(wanted, group);
        matrices = with_matrix(d, matrices, group, *m, y);
    }
    const PlacedPoints<D> points = place_points(d, matrices, x, depth);
    write_points<kLanding>(d, band, points, footprints(d, matrices, points, gradient_x, gradient_y), wanted,
                           pixels.colour.row(y).data() + x);
}

// Any run of pixels; at the first and last pixel of the image one by one.
template <TileLanding kLanding>
void splat_run(BandContext& band, int x, int end_x, int y) {
    const DF d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const glm::ivec2 size_px = band.pixels->depth.size_px();
    while (x < end_x) {
        const bool beside_nothing = (y == 0 && x == 0) || (y == size_px.y - 1 && x + lanes >= size_px.x);
        if (x + lanes <= end_x && !beside_nothing) {
            splat_mixed<kLanding>(d, band, x, y);
            x += lanes;
        } else {
            splat_mixed<kLanding>(d1, band, x++, y);
        }
    }
}

// Blocks follow each other down a column, each row of which is in a page of its own: no processor foresees that.
// Inlined, because GCC drops calls of functions that do nothing but this.
HWY_INLINE void fetch_ahead(const CpuPixels& pixels, int x, int y) {
    __builtin_prefetch(pixels.depth.row(y).data() + x + kTileWidth_px);
    __builtin_prefetch(pixels.colour.row(y).data() + x + kTileWidth_px);
    __builtin_prefetch(pixels.object_id.row(y).data() + x + kTileWidth_px);
}

template <TileLanding kLanding>
void splat_block(BandContext& band, const SplatTiles& tiles, int block, int y) {
    const std::size_t i =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.blocks_per_row) + static_cast<std::size_t>(block);
    const BlockKind kind = tiles.kinds[i];
    const int x = block * kBlockWidth_px;
    fetch_ahead(*band.pixels, x, y);
    if (kind == BlockKind::empty) return;
    if (kind == BlockKind::mixed) {
        splat_run<kLanding>(band, x, std::min(x + kBlockWidth_px, tiles.size_px.x), y);
        return;
    }
    const ObjectId object = tiles.objects[i];
    const PixelMatrix* m = band.matrices->find(object);
    if (m == nullptr) return;
    const hn::CappedTag<float, kBlockWidth_px> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int at = 0; at < kBlockWidth_px; at += lanes) {
        splat_uniform<kLanding>(d, band, x + at, y, object, *m);
    }
}

template <TileLanding kLanding>
void splat_tile(BandContext& band, const SplatTiles& tiles, RowRange blocks, RowRange rows) {
    for (int block = blocks.begin; block < blocks.end; ++block) {
        // Down, not along: a block is mostly of the same kind as the one above it, which spares wrong guesses, and
        // where rows of the source stand across the target, neighbours meet in the cache.
        for (int y = rows.begin; y < rows.end; ++y) splat_block<kLanding>(band, tiles, block, y);
    }
}

void splat_band_here(const SplatInput& input, int band, std::span<const TileLanding> landings, RowRange target_rows,
                     KeyRing& keys) {
    const SplatTiles& tiles = *input.tiles;
    // Never more rows than the ring holds, whatever the bounds said.
    target_rows.end = std::min(target_rows.end, target_rows.begin + keys.slots());
    BandContext context{input.pixels, input.matrices, &keys, target_rows, {}};
    const RowRange rows{band * kBandHeight_px, std::min((band + 1) * kBandHeight_px, tiles.size_px.y)};
    const int blocks_per_tile = kTileWidth_px / kBlockWidth_px;
    for (int tile = 0; tile < tiles.tiles_per_band(); ++tile) {
        const TileLanding landing = landings[static_cast<std::size_t>(tile)];
        const RowRange blocks{tile * blocks_per_tile, std::min((tile + 1) * blocks_per_tile, tiles.blocks_per_row)};
        if (landing == TileLanding::inside) splat_tile<TileLanding::inside>(context, tiles, blocks, rows);
        if (landing == TileLanding::crossing) splat_tile<TileLanding::crossing>(context, tiles, blocks, rows);
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
