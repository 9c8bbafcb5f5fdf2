#include "warp_server/fill_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/fill_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr std::int32_t kNoCost = std::numeric_limits<std::int32_t>::max();

template <class D>
struct Candidates {
    hn::VFromD<D> depth;
    hn::VFromD<hn::RebindToSigned<D>> cost;
    hn::VFromD<hn::RebindToSigned<D>> index;
    hn::VFromD<hn::RebindToSigned<D>>
        is_uncovered;  // as a mask: it was chosen against a nearer surface at the other end
};

// The farther one; the cheaper one when both are about as far.
template <class D>
HWY_INLINE Candidates<D> background_of(D d, const Candidates<D>& a, const Candidates<D>& b) {
    const hn::RebindToSigned<D> di;
    const auto b_is_farther = hn::Lt(b.depth, a.depth);
    const auto farther = hn::Min(a.depth, b.depth);
    const auto nearer = hn::Max(a.depth, b.depth);
    const auto is_same = hn::Le(hn::Sub(nearer, farther), hn::Mul(hn::Set(d, kSameDepthPart), nearer));
    const auto b_farther_i = hn::RebindMask(di, b_is_farther);
    const auto nearer_cost = hn::IfThenElse(b_farther_i, a.cost, b.cost);
    const auto farther_cost = hn::IfThenElse(b_farther_i, b.cost, a.cost);
    const auto take_cheaper = hn::And(hn::RebindMask(di, is_same), hn::Lt(nearer_cost, farther_cost));
    const auto take_b = hn::Xor(b_farther_i, take_cheaper);
    const auto both_exist = hn::Lt(hn::Max(a.cost, b.cost), hn::Set(di, kNoCost));
    return {hn::IfThenElse(hn::RebindMask(d, take_b), b.depth, a.depth), hn::IfThenElse(take_b, b.cost, a.cost),
            hn::IfThenElse(take_b, b.index, a.index),
            hn::VecFromMask(di, hn::And(both_exist, hn::Not(hn::RebindMask(di, is_same))))};
}

// Vectors start at multiples of their length, so threads that share a picture at such columns never touch the same
// pixels. Most runs are of a few pixels and take one short vector: a gather takes as long as its vector is wide. Lanes
// outside of the part must not be written to the picture; what the scratch holds for them may change, since each of its
// entries is set before it is used.
template <class Some>
HWY_INLINE void for_columns(int begin, int end, int width, const Some& some) {
    const DF d;
    const hn::CappedTag<float, 4> d4;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int few = static_cast<int>(hn::Lanes(d4));
    int x = begin / few * few;
    if (few < lanes && end - x <= few && x + few <= width) return some(d4, x);
    x = begin / lanes * lanes;
    for (; x < end && x + lanes <= width; x += lanes) some(d, x);
    for (x = std::max(x, begin); x < end; ++x) some(d1, x);
}

template <class D>
HWY_INLINE hn::Mask<D> within(D d, int x, int begin, int end) {
    const hn::RebindToSigned<D> di;
    const auto column = lanes_from(di, x);
    return hn::RebindMask(d, hn::And(hn::Gt(column, hn::Set(di, begin - 1)), hn::Lt(column, hn::Set(di, end))));
}

// A single lane is always within; told to store some lanes of one, Highway would store those that are not there too.
template <class D>
HWY_INLINE void store_within(D d, hn::Vec<D> values, hn::Mask<D> within, hn::TFromD<D>* to) {
    if constexpr (hn::MaxLanes(D{}) == 1) {
        hn::StoreU(values, d, to);
    } else {
        hn::BlendedStore(values, within, d, to);
    }
}

template <class D>
HWY_INLINE hn::Mask<D> holes_at(D d, const DisplayFrame& frame, int x, int y) {
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> d8;
    const auto* coverage = reinterpret_cast<const std::uint8_t*>(frame.coverage.row(y).data());
    const auto is_hole =
        hn::Eq(hn::PromoteTo(di, hn::LoadU(d8, coverage + x)), hn::Set(di, static_cast<std::int32_t>(Coverage::hole)));
    return hn::RebindMask(d, is_hole);
}

void look_below_here(DisplayFrame& frame, const HolePart& part, HoleScratch& scratch) {
    const int y = part.run.y;
    const int below = y + 1;
    const bool is_last = below == frame.depth.height();
    for_columns(part.columns.begin, part.columns.end, frame.depth.width(), [&](auto d, int x) LW_INLINE_LAMBDA {
        using D = decltype(d);
        const hn::RebindToSigned<D> di;
        std::int32_t* rows = scratch.row_below.data() + x;
        auto row = hn::Set(di, -1);
        if (!is_last) {
            row = hn::IfThenElse(hn::RebindMask(di, holes_at(d, frame, x, below)), hn::LoadU(di, rows),
                                 hn::Set(di, below));
        }
        hn::StoreU(row, di, rows);
        store_within(d, hn::BitCast(d, row), within(d, x, part.columns.begin, part.columns.end),
                     frame.depth.row(y).data() + x);
    });
}

// A reached pixel beside a run. One that does not exist is infinitely near, so it is never chosen.
struct RowEnd {
    float depth = std::numeric_limits<float>::infinity();
    std::int32_t index = -1;
};

RowEnd row_end(const DisplayFrame& frame, int x, int y) {
    if (x < 0 || x >= frame.depth.width()) return {};
    return {frame.depth.at(x, y), y * frame.depth.width() + x};
}

// What all pixels of a run share.
struct RunContext {
    const DisplayFrame& frame;
    const HoleRun& run;
    RowRange columns;
    const FillCosts& costs;
    RowEnd left, right;
};

template <class D>
HWY_INLINE Candidates<D> along_row(D d, const RowEnd& end, hn::VFromD<hn::RebindToSigned<D>> distance_px,
                                   std::int32_t cost_per_px) {
    const hn::RebindToSigned<D> di;
    const auto cost = end.index >= 0 ? hn::Mul(distance_px, hn::Set(di, cost_per_px)) : hn::Set(di, kNoCost);
    return {hn::Set(d, end.depth), cost, hn::Set(di, end.index), hn::Zero(di)};
}

template <class D, class VI>
HWY_INLINE Candidates<D> along_column(D /*d*/, const RunContext& context, int x, VI row, hn::VFromD<D> depth,
                                      std::int32_t cost_per_px) {
    const hn::RebindToSigned<D> di;
    const auto exists = hn::Gt(row, hn::Set(di, -1));
    const auto cost = hn::Mul(hn::Abs(hn::Sub(row, hn::Set(di, context.run.y))), hn::Set(di, cost_per_px));
    const auto index = hn::Add(hn::Mul(row, hn::Set(di, context.frame.depth.width())), lanes_from(di, x));
    return {depth, hn::IfThenElse(exists, cost, hn::Set(di, kNoCost)), hn::IfThenElse(exists, index, hn::Set(di, -1)),
            hn::Zero(di)};
}

template <class D>
HWY_INLINE Candidates<D> end_above(D d, const RunContext& context, int x, HoleScratch& scratch) {
    const hn::RebindToSigned<D> di;
    auto row = hn::Set(di, -1);
    auto depth = hn::Set(d, std::numeric_limits<float>::infinity());
    const int above = context.run.y - 1;
    if (above >= 0) {
        const auto is_hole = holes_at(d, context.frame, x, above);
        row = hn::IfThenElse(hn::RebindMask(di, is_hole), hn::LoadU(di, scratch.row_above.data() + x),
                             hn::Set(di, above));
        depth = hn::IfThenElse(is_hole, hn::LoadU(d, scratch.depth_above.data() + x),
                               hn::LoadU(d, context.frame.depth.row(above).data() + x));
    }
    hn::StoreU(row, di, scratch.row_above.data() + x);
    hn::StoreU(depth, d, scratch.depth_above.data() + x);
    return along_column(d, context, x, row, depth, context.costs.above);
}

template <class D>
HWY_INLINE Candidates<D> end_below(D d, const RunContext& context, int x) {
    const hn::RebindToSigned<D> di;
    const float* own_row = context.frame.depth.row(context.run.y).data() + x;
    const auto asked = within(d, x, context.columns.begin, context.columns.end);
    const auto row = hn::IfThenElse(hn::RebindMask(di, asked), hn::BitCast(di, hn::LoadU(d, own_row)), hn::Set(di, -1));
    Candidates<D> end = along_column(d, context, x, row, hn::Zero(d), context.costs.below);
    const auto place = hn::Max(end.index, hn::Zero(di));
    end.depth = hn::IfThenElse(hn::RebindMask(d, hn::Gt(end.index, hn::Set(di, -1))),
                               hn::GatherIndex(d, context.frame.depth.pixels().data(), place),
                               hn::Set(d, std::numeric_limits<float>::infinity()));
    return end;
}

template <class D>
HWY_INLINE void choose_some(D d, const RunContext& context, int x, HoleScratch& scratch) {
    const hn::RebindToSigned<D> di;
    const auto column = lanes_from(di, x);
    const auto to_left = hn::Sub(column, hn::Set(di, context.run.begin - 1));
    const auto to_right = hn::Sub(hn::Set(di, context.run.end), column);
    const auto in_row = background_of(d, along_row(d, context.left, to_left, context.costs.left),
                                      along_row(d, context.right, to_right, context.costs.right));
    const auto in_column = background_of(d, end_above(d, context, x, scratch), end_below(d, context, x));
    const auto best = background_of(d, in_row, in_column);
    // Where only one of both has a foreground to uncover from, that one is right; where both have, the cheaper one.
    const auto cheaper = hn::Lt(in_column.cost, in_row.cost);
    const auto row_is_clear = hn::MaskFromVec(in_row.is_uncovered);
    const auto column_is_clear = hn::MaskFromVec(in_column.is_uncovered);
    const auto column_is_better = hn::And(column_is_clear, hn::Or(hn::Not(row_is_clear), cheaper));
    const auto is_clear = hn::Or(row_is_clear, column_is_clear);
    const auto choice = [&](auto of_row, auto of_column, auto of_best) LW_INLINE_LAMBDA {
        return hn::IfThenElse(is_clear, hn::IfThenElse(column_is_better, of_column, of_row), of_best);
    };
    hn::StoreU(choice(in_row.index, in_column.index, best.index), di, scratch.chosen.data() + x);
    hn::StoreU(choice(in_row.cost, in_column.cost, best.cost), di, scratch.cost.data() + x);
    const auto is_clear_f = hn::RebindMask(d, is_clear);
    const auto clear_depth = hn::IfThenElse(hn::RebindMask(d, column_is_better), in_column.depth, in_row.depth);
    hn::StoreU(hn::IfThenElse(is_clear_f, clear_depth, best.depth), d, scratch.depth.data() + x);
}

void choose_background_here(const DisplayFrame& frame, const HolePart& part, const FillCosts& costs,
                            HoleScratch& scratch) {
    const HoleRun& run = part.run;
    const RunContext context{
        frame, run, part.columns, costs, row_end(frame, run.begin - 1, run.y), row_end(frame, run.end, run.y)};
    for_columns(part.columns.begin, part.columns.end, frame.depth.width(),
                [&](auto d, int x) LW_INLINE_LAMBDA { choose_some(d, context, x, scratch); });
}

void copy_background_here(DisplayFrame& frame, const HolePart& part, Rgba8 nothing, const HoleScratch& scratch) {
    const auto* from = reinterpret_cast<const std::uint32_t*>(frame.colour.pixels().data());
    auto* colours = reinterpret_cast<std::uint32_t*>(frame.colour.row(part.run.y).data());
    float* depths = frame.depth.row(part.run.y).data();
    for_columns(part.columns.begin, part.columns.end, frame.depth.width(), [&](auto d, int x) LW_INLINE_LAMBDA {
        using D = decltype(d);
        const hn::RebindToSigned<D> di;
        const hn::RebindToUnsigned<D> du;
        // Lanes outside of the part hold what an earlier run chose there, or nothing.
        const auto in = within(d, x, part.columns.begin, part.columns.end);
        const auto chosen = hn::LoadU(di, scratch.chosen.data() + x);
        const auto exists = hn::And(in, hn::RebindMask(d, hn::Gt(chosen, hn::Set(di, -1))));
        const auto place = hn::IfThenElseZero(hn::RebindMask(di, exists), chosen);
        const auto colour = hn::IfThenElse(hn::RebindMask(du, exists), hn::GatherIndex(du, from, place),
                                           hn::Set(du, std::bit_cast<std::uint32_t>(nothing)));
        store_within(du, colour, hn::RebindMask(du, in), colours + x);
        store_within(d, hn::IfThenElseZero(exists, hn::LoadU(d, scratch.depth.data() + x)), in, depths + x);
    });
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(look_below_here);
HWY_EXPORT(choose_background_here);
HWY_EXPORT(copy_background_here);

void HoleScratch::resize(int width) {
    const auto columns = static_cast<std::size_t>(width);
    for (auto* numbers : {&row_below, &row_above, &chosen, &cost}) numbers->resize(columns);
    for (auto* depths : {&depth_above, &depth}) depths->resize(columns);
}

void look_below(DisplayFrame& frame, const HolePart& part, HoleScratch& scratch) {
    HWY_DYNAMIC_DISPATCH(look_below_here)(frame, part, scratch);
}

void choose_background(const DisplayFrame& frame, const HolePart& part, const FillCosts& costs, HoleScratch& scratch) {
    HWY_DYNAMIC_DISPATCH(choose_background_here)(frame, part, costs, scratch);
}

void copy_background(DisplayFrame& frame, const HolePart& part, Rgba8 nothing, const HoleScratch& scratch) {
    HWY_DYNAMIC_DISPATCH(copy_background_here)(frame, part, nothing, scratch);
}

}  // namespace lw
#endif
