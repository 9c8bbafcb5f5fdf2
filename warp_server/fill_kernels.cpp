#include "warp_server/fill_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/fill_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

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

// Lanes(d) pixels of the run from its pixel i on.
template <class D>
HWY_INLINE void choose_some(D d, const FillRun& run, int i, std::int32_t* chosen, std::int32_t* cost) {
    const hn::RebindToSigned<D> di;
    const auto columns = hn::Iota(di, run.begin + i);
    const auto no_cost = hn::Set(di, kNoCost);
    const auto along_row = [&](const FillEnd& end, auto distance_px, std::int32_t cost_per_px) {
        const auto end_cost = hn::Mul(distance_px, hn::Set(di, cost_per_px));
        return Candidates<D>{hn::Set(d, end.depth), end.index >= 0 ? end_cost : no_cost, hn::Set(di, end.index),
                             hn::Zero(di)};
    };
    const auto along_column = [&](const std::int32_t* rows, const float* depths, std::int32_t cost_per_px) {
        const auto row = hn::LoadU(di, rows + i);
        const auto distance_px = hn::Abs(hn::Sub(row, hn::Set(di, run.y)));
        const auto end_cost = hn::Mul(distance_px, hn::Set(di, cost_per_px));
        const auto exists = hn::Gt(row, hn::Set(di, -1));
        return Candidates<D>{hn::LoadU(d, depths + i), hn::IfThenElse(exists, end_cost, no_cost),
                             hn::Add(hn::Mul(row, hn::Set(di, run.width)), columns), hn::Zero(di)};
    };
    const auto in_row =
        background_of(d, along_row(run.left, hn::Sub(columns, hn::Set(di, run.begin - 1)), run.costs.left),
                      along_row(run.right, hn::Sub(hn::Set(di, run.end), columns), run.costs.right));
    const auto in_column = background_of(d, along_column(run.row_above, run.depth_above, run.costs.above),
                                         along_column(run.row_below, run.depth_below, run.costs.below));
    const auto best = background_of(d, in_row, in_column);
    // Where only one of both has a foreground to uncover from, that one is right; where both have, the cheaper one.
    const auto cheaper = hn::Lt(in_column.cost, in_row.cost);
    const auto row_is_clear = hn::MaskFromVec(in_row.is_uncovered);
    const auto column_is_clear = hn::MaskFromVec(in_column.is_uncovered);
    const auto column_is_better = hn::And(column_is_clear, hn::Or(hn::Not(row_is_clear), cheaper));
    const auto is_clear = hn::Or(row_is_clear, column_is_clear);
    const auto choice = [&](auto of_row, auto of_column, auto of_best) {
        return hn::IfThenElse(is_clear, hn::IfThenElse(column_is_better, of_column, of_row), of_best);
    };
    hn::StoreU(choice(in_row.index, in_column.index, best.index), di, chosen + i);
    hn::StoreU(choice(in_row.cost, in_column.cost, best.cost), di, cost + i);
}

void choose_background_here(const FillRun& run, std::int32_t* chosen, std::int32_t* cost) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int count = run.end - run.begin;
    int i = 0;
    for (; i + lanes <= count; i += lanes) choose_some(d, run, i, chosen, cost);
    for (; i < count; ++i) choose_some(d1, run, i, chosen, cost);
}

template <class D>
HWY_INLINE void follow_some(D d, int x, int row_beside, const Coverage* beside, const float* depth_beside,
                            std::int32_t* rows, float* depths) {
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> d8;
    const auto coverage = hn::PromoteTo(di, hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(beside) + x));
    const auto is_hole = hn::Eq(coverage, hn::Set(di, static_cast<std::int32_t>(Coverage::hole)));
    const auto row = hn::IfThenElse(is_hole, hn::LoadU(di, rows + x), hn::Set(di, row_beside));
    const auto depth =
        hn::IfThenElse(hn::RebindMask(d, is_hole), hn::LoadU(d, depths + x), hn::LoadU(d, depth_beside + x));
    hn::StoreU(row, di, rows + x);
    hn::StoreU(depth, d, depths + x);
}

void follow_columns_here(int begin, int end, int row_beside, const Coverage* beside, const float* depth_beside,
                         std::int32_t* rows, float* depths) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int x = begin;
    for (; x + lanes <= end; x += lanes) follow_some(d, x, row_beside, beside, depth_beside, rows, depths);
    for (; x < end; ++x) follow_some(d1, x, row_beside, beside, depth_beside, rows, depths);
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(choose_background_here);
HWY_EXPORT(follow_columns_here);

void choose_background(const FillRun& run, std::int32_t* chosen, std::int32_t* cost) {
    HWY_DYNAMIC_DISPATCH(choose_background_here)(run, chosen, cost);
}

void follow_columns(int begin, int end, int row_beside, const Coverage* beside, const float* depth_beside,
                    std::int32_t* rows, float* depths) {
    HWY_DYNAMIC_DISPATCH(follow_columns_here)(begin, end, row_beside, beside, depth_beside, rows, depths);
}

}  // namespace lw
#endif
