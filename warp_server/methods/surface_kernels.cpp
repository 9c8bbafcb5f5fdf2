#include "warp_server/methods/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/surface_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>
#include <vector>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_fragment_queue.h"
#include "warp_server/methods/surface_placing.h"
#include "warp_server/methods/surface_queues.h"
#include "warp_server/methods/surface_reader.h"
#include "warp_server/methods/surface_sampling.h"
#include "warp_server/methods/surface_solving.h"
#include "warp_server/methods/surface_tolerances.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr int kPrefetchRows = 3;  // blocks are narrow, so that the next rows come before this row's next lines
constexpr int kFewColumnsPx = 8;  // fewer are drawn row by row no faster than one by one
constexpr int kLongRowPx = 64;    // from here on finding out where a row begins and ends pays
constexpr int kSmallBoxPx = 3;    // a cell's box is one to three pixels wide unless it is magnified

// How far the shares of pixels count: what stands still shows the source as it is.
float share_trust(float moved_px) {
    constexpr float kFullyMovedPx = 0.25F;
    return std::min(moved_px / kFullyMovedPx, 1.0F);
}

// Within a narrow box of target pixels, lanes run over several of its rows: lane k of a box w wide is at (k % w, k /
// w).
struct LaneOffsets {
    HWY_ALIGN float x[kMaxLanes + 1][kMaxLanes];
    HWY_ALIGN float y[kMaxLanes + 1][kMaxLanes];
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

// Of a tile's kTileSize rows the values of the rows `row`.
HWY_INLINE hn::VFromD<DI> row_value(const std::int32_t* values, hn::VFromD<DI> row) {
#if LW_HAS_WIDE_LOOKUPS
    const hn::VFromD<DI> all{_mm512_castsi256_si512(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(values)))};
    return hn::TableLookupLanes(all, hn::IndicesFromVec(DI{}, row));
#else
    return hn::GatherIndex(DI{}, values, row);
#endif
}

// The cells of a tile's surface (SurfaceTiles).
struct TileCells {
    const std::uint32_t* rows;

    [[nodiscard]] HWY_INLINE hn::VFromD<DI> corners(hn::VFromD<DI> column, hn::VFromD<DI> row) const {
        const auto cells = row_value(reinterpret_cast<const std::int32_t*>(rows), row);
        const auto shift = hn::BitCast(DU{}, hn::ShiftLeft<2>(column));
        return hn::And(hn::BitCast(DI{}, hn::Shr(hn::BitCast(DU{}, cells), shift)), hn::Set(DI{}, kAllCorners));
    }
};

class Painter {
public:
    Painter(const PatchInput& input, SurfaceCanvas& canvas, std::vector<std::uint32_t>& behind)
        : input_{input},
          behind_{behind},
          reader_{input.prepared->linear, has_lattice(input) ? &input.prepared->lattice : nullptr},
          runs_{reader_, encoder_, canvas.frame()},
          queue_{reader_, encoder_, runs_, canvas.frame()},
          fragments_{reader_.pixels(), edge_lattices(input), input.prepared->size_px, canvas},
          target_width_{canvas.frame().depth.width()},
          band_{target_width_, canvas.frame().depth.height(), canvas.band()},
          skips_{canvas.skips()},
          depths_{canvas.frame().depth.pixels().data()} {}

    void paint_patches(const PatchList& list, ListRange range) {
        const auto paint = [&](std::size_t first, std::uint32_t bits, const PlacedPatches& placed, auto d) {
            if constexpr (std::is_same_v<decltype(d), DF>) {
                const std::uint32_t small = small_boxes(bits, placed);
                if (small != 0) paint_small(list, first, small, placed);
                bits &= ~small;
            }
            for (; bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
                if (is_hidden(lane, placed)) {
                    ++skips_.hidden;
                } else {
                    paint_one(list, first + lane, lane, placed);
                }
            }
        };
        place_all(list, range, paint);
        queue_.flush();
        fragments_.flush();
    }

    void paint_tiles(const SurfaceTiles& tiles, ListRange range) {
        const auto paint = [&](std::size_t first, std::uint32_t bits, const PlacedPatches& placed, auto) {
            fetch_cells(tiles, first + kTilesAhead);
            for (; bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
                if (is_hidden(lane, placed)) {
                    ++skips_.hidden;
                } else {
                    paint_tile(tiles, first + lane, lane, placed);
                }
            }
        };
        place_all(tiles.surfaces, range, paint);
        queue_.flush();
        fragments_.flush();
    }

private:
    static constexpr std::size_t kPatchesAhead = 64;
    static constexpr std::size_t kTilesAhead = 16;

    [[nodiscard]] static bool has_lattice(const PatchInput& input) {
        return input.between_pixels && !input.prepared->lattice.empty();
    }

    [[nodiscard]] static const std::uint16_t* edge_lattices(const PatchInput& input) {
        const std::vector<std::uint16_t>& values = input.prepared->edge_lattices;
        return has_lattice(input) && !values.empty() ? values.data() : nullptr;
    }

    // As many patches at once as there are lanes; `paint` gets those that have pixels here, object by object.
    template <class Paint>
    HWY_INLINE void place_all(const PatchList& list, ListRange range, const Paint& paint) {
        const hn::CappedTag<float, 1> d1;
        const std::size_t lanes = hn::Lanes(DF{});
        std::size_t i = range.begin;
        for (; i + lanes <= range.end; i += lanes) {
            fetch(list, i + kPatchesAhead);
            place_some(DF{}, list, i, paint);
        }
        for (; i < range.end; ++i) place_some(d1, list, i, paint);
    }

    // Ten arrays are more than the hardware follows by itself. Beyond their ends asking does no harm.
    static HWY_INLINE void fetch(const PatchList& list, std::size_t at) {
        for (const std::vector<float>* values : {&list.x, &list.y, &list.depth, &list.gradient_x, &list.gradient_y,
                                                 &list.left, &list.right, &list.top, &list.bottom}) {
            __builtin_prefetch(values->data() + at);
        }
        __builtin_prefetch(list.object_id.data() + at);
        __builtin_prefetch(list.corners.data() + at);
        if (!list.edge_number.empty()) __builtin_prefetch(list.edge_number.data() + at);
    }

    // What `fetch` leaves out, of as many tiles as there are lanes.
    HWY_INLINE void fetch_cells(const SurfaceTiles& tiles, std::size_t at) const {
        for (const std::vector<float>* values :
             {&tiles.edge_left, &tiles.edge_right, &tiles.edge_top, &tiles.edge_bottom}) {
            __builtin_prefetch(values->data() + at);
        }
        constexpr std::size_t kPerLine = 64 / sizeof(std::uint32_t) / kTileSize;  // tiles
        for (std::size_t i = 0; i < hn::Lanes(DF{}); i += kPerLine) {
            __builtin_prefetch(tiles.cells.data() + kTileSize * (at + i));
            if (fragments_.has_lattices()) __builtin_prefetch(tiles.edge_number.data() + kTileSize * (at + i));
        }
    }

    template <class D, class Paint>
    HWY_INLINE void place_some(D d, const PatchList& list, std::size_t first, const Paint& paint) {
        const hn::RebindToUnsigned<D> du;
        const hn::Rebind<std::uint16_t, D> d16;
        const auto ids = hn::PromoteTo(du, hn::LoadU(d16, list.object_id.data() + first));
        auto remaining = hn::Eq(hn::Zero(d), hn::Zero(d));
        while (!hn::AllFalse(d, remaining)) {
            const ObjectId id = list.object_id[first + static_cast<std::size_t>(hn::FindFirstTrue(d, remaining))];
            const auto same = hn::RebindMask(d, hn::Eq(ids, hn::Set(du, std::uint32_t{id})));
            const auto group = hn::And(remaining, same);
            remaining = hn::AndNot(same, remaining);
            const PixelMatrix* matrix = input_.matrices->find(id);
            if (matrix == nullptr) {
                if (band_.counts_skips()) skips_.empty += hn::CountTrue(d, group);
                continue;
            }
            share_trust_ = static_cast<std::int32_t>(kFullTrust * share_trust(matrix->moved_px)) << kTrustShift;
            PlacedPatches placed;
            const std::uint32_t bits = place_patches(d, list, first, *matrix, group, band_, placed, behind_, skips_);
            if (bits != 0) paint(first, bits, placed, d);
        }
    }

    // Is the patch behind what all of its box shows? Most are not, and show it at one of five places.
    [[nodiscard]] bool is_hidden(std::size_t lane, const PlacedPatches& placed) const {
        const int x0 = placed.x_begin[lane];
        const int x1 = placed.x_end[lane] - 1;
        const int y0 = placed.y_begin[lane];
        const int y1 = placed.y_end[lane] - 1;
        const auto depth_step = [](float step, float from, int first, int last) {
            return std::max(step * (static_cast<float>(first) + 0.5F - from),
                            step * (static_cast<float>(last) + 0.5F - from));
        };
        // Of the plane in the box, and a little more than rounding can add: the patch in it is no nearer.
        const float plane = placed.depth[lane] + depth_step(placed.depth_x[lane], placed.target_x[lane], x0, x1) +
                            depth_step(placed.depth_y[lane], placed.target_y[lane], y0, y1);
        const float nearest = std::max(plane, 0.0F) * (1.0F + 1e-5F);
        const auto row = [&](int y) {
            return depths_ + static_cast<std::ptrdiff_t>(y) * static_cast<std::ptrdiff_t>(target_width_);
        };
        const auto shows = [&](int x, int y) { return row(y)[x] <= nearest; };
        if (shows((x0 + x1) / 2, (y0 + y1) / 2)) return false;
        if (shows(x0, y0) || shows(x1, y0) || shows(x0, y1) || shows(x1, y1)) return false;
        for (int y = y0; y <= y1; ++y) {
            const float* depths = row(y);
            if (std::any_of(depths + x0, depths + x1 + 1, [&](float depth) { return depth <= nearest; })) return false;
        }
        return true;
    }

    // Those of the patches whose boxes hold so few pixels that solving one pixel of many patches at once is faster than
    // solving many pixels of one patch.
    static HWY_INLINE std::uint32_t small_boxes(std::uint32_t bits, const PlacedPatches& placed) {
        const auto size = [](const std::int32_t* begin, const std::int32_t* end) {
            return hn::Sub(hn::Load(DI{}, end), hn::Load(DI{}, begin));
        };
        const auto limit = hn::Set(DI{}, kSmallBoxPx + 1);
        const auto small = hn::And(hn::Lt(size(placed.x_begin, placed.x_end), limit),
                                   hn::Lt(size(placed.y_begin, placed.y_end), limit));
        return bits & bits_of(DI{}, small);
    }

    // One pixel of every patch at a time, column by column and row by row of their boxes.
    HWY_INLINE void paint_small(const PatchList& list, std::size_t first, std::uint32_t bits,
                                const PlacedPatches& placed) {
        HWY_ALIGN std::int32_t wanted_lanes[kMaxLanes];
        for (std::size_t lane = 0; lane < kMaxLanes; ++lane)
            wanted_lanes[lane] = static_cast<std::int32_t>(bits >> lane & 1U);
        const auto wanted = hn::Gt(hn::Load(DI{}, wanted_lanes), hn::Zero(DI{}));
        const auto x_end = hn::Load(DI{}, placed.x_end);
        const auto y_end = hn::Load(DI{}, placed.y_end);
        const Patch patch = many_patches(placed, list, first);
        const VF origin_x = hn::LoadU(DF{}, list.x.data() + first);
        const VF origin_y = hn::LoadU(DF{}, list.y.data() + first);
        const hn::Rebind<std::uint8_t, DF> d8;
        const auto corners = hn::PromoteTo(DI{}, hn::LoadU(d8, list.corners.data() + first));
        const bool is_whole = list.corners[first] == kAllCorners;  // as all of the list are, or none
        for (int dy = 0; dy < kSmallBoxPx; ++dy) {
            const auto y = hn::Add(hn::Load(DI{}, placed.y_begin), hn::Set(DI{}, dy));
            const auto wanted_rows = hn::And(wanted, hn::Lt(y, y_end));
            if (hn::AllFalse(DI{}, wanted_rows)) return;
            const PatchRow row = row_of(patch, hn::ConvertTo(DF{}, y));
            for (int dx = 0; dx < kSmallBoxPx; ++dx) {
                const auto x = hn::Add(hn::Load(DI{}, placed.x_begin), hn::Set(DI{}, dx));
                const auto used = hn::And(wanted_rows, hn::Lt(x, x_end));
                if (hn::AllFalse(DI{}, used)) break;
                Solved solved;
                const auto inside =
                    hn::And(hn::RebindMask(DF{}, used), solve(patch, row, hn::ConvertTo(DF{}, x), solved));
                if (hn::AllFalse(DF{}, inside)) continue;
                const auto pixel = hn::Add(hn::Mul(y, hn::Set(DI{}, target_width_)), x);
                if (is_whole) {
                    queue_.push(inside, pixel, solved.depth, hn::Add(origin_x, solved.dx),
                                hn::Add(origin_y, solved.dy));
                } else {
                    const auto cell = fragments_.has_lattices() ? hn::LoadU(DI{}, list.edge_number.data() + first)
                                                                : truncated(origin_x);
                    fragments_.push(inside, pixel, solved.depth, cell, truncated(origin_y), solved.dx, solved.dy,
                                    trusted(corners));
                }
            }
        }
    }

    // Solves every pixel of the patch's box, as many at once as there are lanes, and paints those inside of it.
    HWY_INLINE void paint_one(const PatchList& list, std::size_t index, std::size_t lane, const PlacedPatches& placed) {
        const Patch patch = one_patch(placed, lane, list, index);
        const VF origin_x = hn::Set(DF{}, list.x[index]);
        const VF origin_y = hn::Set(DF{}, list.y[index]);
        const std::uint8_t corners = list.corners[index];
        const int columns = placed.x_end[lane] - placed.x_begin[lane];
        if (corners == kAllCorners && columns >= kFewColumnsPx && target_width_ >= lanes()) {
            paint_runs(patch, origin_x, origin_y, lane, placed);
            return;
        }
        const auto push = [&](hn::Mask<DF> inside, hn::VFromD<DI> pixel, const Solved& solved) LW_INLINE_LAMBDA {
            if (corners == kAllCorners) {
                queue_.push(inside, pixel, solved.depth, hn::Add(origin_x, solved.dx), hn::Add(origin_y, solved.dy));
            } else {
                const auto cell =
                    fragments_.has_lattices() ? hn::Set(DI{}, list.edge_number[index]) : truncated(origin_x);
                fragments_.push(inside, pixel, solved.depth, cell, truncated(origin_y), solved.dx, solved.dy,
                                trusted(hn::Set(DI{}, corners)));
            }
        };
        solve_box(patch, lane, placed, push);
    }

    // Runs of pixels in a row, written where they are.
    HWY_INLINE void paint_runs(const Patch& patch, VF origin_x, VF origin_y, std::size_t lane,
                               const PlacedPatches& placed) {
        solve_rows(patch, lane, placed, [&](hn::Mask<DF> inside, int x, int y, const Solved& solved) LW_INLINE_LAMBDA {
            paint_run(origin_x, origin_y, solved, x, y, inside);
        });
    }

    // Calls `run` with the pixels of the box that are inside of the patch, as many of a row at once as there are lanes.
    // Pixels from column x on; each once.
    template <class Run>
    HWY_INLINE void solve_rows(const Patch& patch, std::size_t lane, const PlacedPatches& placed, const Run& run) {
        const VF lane_x = lanes_from(DF{}, 0.0F);
        const bool is_long = placed.x_end[lane] - placed.x_begin[lane] > kLongRowPx;
        for (int y = placed.y_begin[lane]; y < placed.y_end[lane]; ++y) {
            const PatchRow row = row_of(patch, hn::Set(DF{}, static_cast<float>(y)));
            const RowSpan box{placed.x_begin[lane], placed.x_end[lane]};
            const RowSpan span = is_long ? span_of(patch, row, box) : box;
            for (int x = span.begin; x < span.end; x += lanes()) {
                // A vector that would end beyond the row begins earlier.
                const int first = std::min(x, target_width_ - lanes());
                const VF pixel_x = hn::Add(lane_x, hn::Set(DF{}, static_cast<float>(first)));
                Solved solved;
                auto inside = solve(patch, row, pixel_x, solved);
                if (first < x) inside = hn::And(inside, hn::Ge(pixel_x, hn::Set(DF{}, static_cast<float>(x))));
                if (hn::AllFalse(DF{}, inside)) continue;
                run(inside, first, y, solved);
            }
        }
    }

    // Lanes `inside` of the row y from column x on.
    template <class M>
    HWY_INLINE void paint_run(VF origin_x, VF origin_y, const Solved& solved, int x, int y, M inside) {
        const std::size_t index =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(target_width_) + static_cast<std::size_t>(x);
        __builtin_prefetch(depths_ + index + kPrefetchRows * target_width_, 1);
        const VF shown = hn::LoadU(DF{}, depths_ + index);
        const auto not_behind = hn::And(inside, hn::Le(shown, solved.depth));
        const std::uint32_t bits = bits_of(DF{}, not_behind);
        if (bits == 0) return;
        // Places outside of the patch may be anything.
        const auto place = [&](VF origin, VF offset) {
            return hn::IfThenElseZero(not_behind, hn::Add(origin, offset));
        };
        const Taps taps = reader_.taps_of(place(origin_x, solved.dx), place(origin_y, solved.dy));
        hn::BlendedStore(solved.depth, not_behind, DF{}, depths_ + index);
        runs_.push(bits, bits_of(DF{}, hn::And(not_behind, hn::Eq(shown, solved.depth))), index, taps);
    }

    // Calls `push` with the pixels of the box that are inside of the patch, as many at once as there are lanes, over
    // several rows where they are short.
    template <class Push>
    HWY_INLINE void solve_box(const Patch& patch, std::size_t lane, const PlacedPatches& placed, const Push& push) {
        const int columns = std::min(placed.x_end[lane] - placed.x_begin[lane], lanes());
        const int rows = lanes() / columns;
        const auto set = [](int value) { return hn::Set(DF{}, static_cast<float>(value)); };
        const VF lane_x = hn::Load(DF{}, lane_offsets().x[columns]);
        const VF lane_y = hn::Load(DF{}, lane_offsets().y[columns]);
        const auto used = hn::Lt(lane_y, set(rows));
        const VF row_end = set(placed.y_end[lane]);
        const VF column_end = set(placed.x_end[lane]);
        const auto width = hn::Set(DI{}, target_width_);
        // Nearly all boxes are narrow: the inner loop is the one that goes on.
        for (int x = placed.x_begin[lane]; x < placed.x_end[lane]; x += columns) {
            const VF pixel_x = hn::Add(lane_x, set(x));
            const auto used_columns = hn::And(used, hn::Lt(pixel_x, column_end));
            for (int y = placed.y_begin[lane]; y < placed.y_end[lane]; y += rows) {
                const VF pixel_y = hn::Add(lane_y, set(y));
                Solved solved;
                auto inside = solve(patch, row_of(patch, pixel_y), pixel_x, solved);
                inside = hn::And(inside, hn::And(used_columns, hn::Lt(pixel_y, row_end)));
                if (hn::AllFalse(DF{}, inside)) continue;
                const auto pixel = hn::Add(hn::Mul(truncated(pixel_y), width), truncated(pixel_x));
                push(inside, pixel, solved);
            }
        }
    }

    HWY_INLINE void paint_tile(const SurfaceTiles& tiles, std::size_t index, std::size_t lane,
                               const PlacedPatches& placed) {
        const Patch patch = one_patch(placed, lane, tiles.surfaces, index);
        const auto set = [](float value) { return hn::Set(DF{}, value); };
        const VF origin_x = set(tiles.surfaces.x[index]);
        const VF origin_y = set(tiles.surfaces.y[index]);
        const TileCells cells{tiles.cells.data() + kTileSize * index};
        const std::int32_t* edge_numbers =
            fragments_.has_lattices() ? tiles.edge_number.data() + kTileSize * index : nullptr;
        const VF edge_left = set(tiles.edge_left[index]);
        const VF edge_right = set(tiles.edge_right[index]);
        const VF edge_top = set(tiles.edge_top[index]);
        const VF edge_bottom = set(tiles.edge_bottom[index]);
        const auto push = [&](hn::Mask<DF> inside, hn::VFromD<DI> pixel, const Solved& solved,
                              const auto& push_whole) LW_INLINE_LAMBDA {
            const auto cell_x = cell_of(solved.dx);
            const auto cell_y = cell_of(solved.dy);
            const auto corners = cells.corners(cell_x, cell_y);
            const auto is_whole = hn::RebindMask(DF{}, hn::Eq(corners, hn::Set(DI{}, kAllCorners)));
            push_whole(hn::And(inside, is_whole), pixel, solved);
            const auto is_any = hn::RebindMask(DF{}, hn::Gt(corners, hn::Zero(DI{})));
            const auto part = hn::And(inside, hn::AndNot(is_whole, is_any));
            if (hn::AllFalse(DF{}, part)) return;
            const auto in_columns = hn::And(hn::Ge(solved.dx, edge_left), hn::Le(solved.dx, edge_right));
            const auto in_rows = hn::And(hn::Ge(solved.dy, edge_top), hn::Le(solved.dy, edge_bottom));
            const auto fragment = hn::And(part, hn::And(in_columns, in_rows));
            const auto cell =
                hn::Add(edge_numbers != nullptr ? row_value(edge_numbers, cell_y) : truncated(origin_x), cell_x);
            fragments_.push(fragment, pixel, solved.depth, cell, hn::Add(truncated(origin_y), cell_y),
                            hn::Sub(solved.dx, hn::ConvertTo(DF{}, cell_x)),
                            hn::Sub(solved.dy, hn::ConvertTo(DF{}, cell_y)), trusted(corners));
        };
        if (placed.x_end[lane] - placed.x_begin[lane] >= kFewColumnsPx && target_width_ >= lanes()) {
            solve_rows(patch, lane, placed,
                       [&](hn::Mask<DF> inside, int x, int y, const Solved& solved) LW_INLINE_LAMBDA {
                           const auto pixel = lanes_from(DI{}, y * target_width_ + x);
                           push(inside, pixel, solved,
                                [&](hn::Mask<DF> whole, hn::VFromD<DI>, const Solved&)
                                    LW_INLINE_LAMBDA { paint_run(origin_x, origin_y, solved, x, y, whole); });
                       });
            return;
        }
        solve_box(
            patch, lane, placed, [&](hn::Mask<DF> inside, hn::VFromD<DI> pixel, const Solved& solved) LW_INLINE_LAMBDA {
                push(inside, pixel, solved, [&](hn::Mask<DF> whole, hn::VFromD<DI>, const Solved&) LW_INLINE_LAMBDA {
                    if (hn::AllFalse(DF{}, whole)) return;
                    queue_.push(whole, pixel, solved.depth, hn::Add(origin_x, solved.dx), hn::Add(origin_y, solved.dy));
                });
            });
    }

    // For FragmentQueue.
    [[nodiscard]] HWY_INLINE hn::VFromD<DI> trusted(hn::VFromD<DI> corners) const {
        return hn::Or(corners, hn::Set(DI{}, share_trust_));
    }

    [[nodiscard]] static HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(DF{})); }

    // The column or row of the cell at `place`, the tile's first or last where it is beyond.
    [[nodiscard]] static HWY_INLINE hn::VFromD<DI> cell_of(VF place) {
        const VF last = hn::Set(DF{}, static_cast<float>(kTileSize - 1));
        const VF from_begin = hn::Add(place, hn::Set(DF{}, kCellsBegin_px));
        return truncated(hn::Min(hn::Max(from_begin, hn::Zero(DF{})), last));
    }

    const PatchInput& input_;
    std::vector<std::uint32_t>& behind_;
    SurfaceReader reader_;
    ColourEncoder encoder_;
    RunQueue runs_;
    PixelQueue queue_;
    FragmentQueue fragments_;
    std::int32_t target_width_;
    TargetBand band_;
    SurfaceSkips& skips_;
    float* depths_;
    std::int32_t share_trust_ = 0;  // of the object whose patches are painted
};

void draw_patches_here(const PatchInput& input, const PatchList& list, ListRange range, SurfaceCanvas& canvas,
                       std::vector<std::uint32_t>& behind) {
    Painter{input, canvas, behind}.paint_patches(list, range);
}

void draw_tiles_here(const PatchInput& input, ListRange range, SurfaceCanvas& canvas,
                     std::vector<std::uint32_t>& behind) {
    Painter{input, canvas, behind}.paint_tiles(input.prepared->tiles, range);
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(draw_patches_here);
HWY_EXPORT(draw_tiles_here);

void draw_patches(const PatchInput& input, const PatchList& list, ListRange range, SurfaceCanvas& canvas,
                  std::vector<std::uint32_t>& behind) {
    if (range.begin < range.end) HWY_DYNAMIC_DISPATCH(draw_patches_here)(input, list, range, canvas, behind);
}

void draw_tiles(const PatchInput& input, ListRange range, SurfaceCanvas& canvas, std::vector<std::uint32_t>& behind) {
    if (range.begin < range.end) HWY_DYNAMIC_DISPATCH(draw_tiles_here)(input, range, canvas, behind);
}

}  // namespace lw
#endif
