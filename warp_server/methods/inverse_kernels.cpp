#include "warp_server/methods/inverse_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/inverse_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_sampling.h"
#include "warp_server/methods/target_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr float kSmallestW = 1e-12F;  // places divided by less could overflow

using VI = hn::VFromD<DI>;
using Lanes = hn::Mask<DF>;

// Where source places land in the target, Lanes(DF) of them.
struct Landed {
    VF x, y, depth;
};

class Searcher {
public:
    Searcher(const InverseInput& input, DisplayFrame& out)
        : input_{input},
          out_{out},
          reader_{*input.linear},
          size_px_{input.pixels->depth.size_px()},
          depths_{input.pixels->depth.pixels().data()},
          ids_{input.pixels->object_id.pixels().data()} {}

    void search_row(int y) {
        const int lanes = static_cast<int>(hn::Lanes(DF{}));
        for (int x = 0; x < out_.depth.width(); x += lanes) search(x, y);
    }

private:
    // Lanes(DF) pixels from column x on, some of them beyond the row.
    HWY_INLINE void search(int x, int y) {
        const VF pixel_x = hn::Add(lanes_from(DF{}, static_cast<float>(x)), hn::Set(DF{}, 0.5F));
        const VF pixel_y = hn::Set(DF{}, static_cast<float>(y) + 0.5F);
        const VF limit_x = hn::Set(DF{}, static_cast<float>(size_px_.x) - 1e-3F);
        const VF limit_y = hn::Set(DF{}, static_cast<float>(size_px_.y) - 1e-3F);
        const auto within = [](Lanes wanted, VF place, VF limit) {
            return hn::Min(hn::Max(hn::IfThenElseZero(wanted, place), hn::Zero(DF{})), limit);
        };
        const auto begin = [&](int row) {
            const glm::mat3& h = input_.source_from_target;
            const VF start = hn::Set(DF{}, h[2][row] + pixel_row(h, row, y));
            return hn::Add(start, hn::Mul(pixel_x, hn::Set(DF{}, h[0][row])));
        };
        const VF begin_w = begin(2);
        Lanes active = hn::Gt(begin_w, hn::Zero(DF{}));
        VF source_x = within(active, hn::Div(begin(0), begin_w), limit_x);
        VF source_y = within(active, hn::Div(begin(1), begin_w), limit_y);
        const VF zero = hn::Zero(DF{});
        Landed landed{zero, zero, zero};
        VF error_x = zero;
        VF error_y = zero;
        for (int step = 0;; ++step) {
            active = place(active, source_x, source_y, landed);
            error_x = hn::Sub(pixel_x, landed.x);
            error_y = hn::Sub(pixel_y, landed.y);
            if (step == input_.steps || hn::AllFalse(DF{}, active)) break;
            source_x = within(active, hn::Add(source_x, error_x), limit_x);
            source_y = within(active, hn::Add(source_y, error_y), limit_y);
        }
        const VF error2 = hn::Add(hn::Mul(error_x, error_x), hn::Mul(error_y, error_y));
        const auto near_enough = hn::Le(error2, hn::Set(DF{}, kAcceptedErrorPx * kAcceptedErrorPx));
        const auto in_front = hn::Le(landed.depth, hn::Set(DF{}, 1.0F));
        write(x, y, hn::And(active, hn::And(near_enough, in_front)), source_x, source_y, landed.depth);
    }

    [[nodiscard]] static float pixel_row(const glm::mat3& h, int row, int y) {
        return (static_cast<float>(y) + 0.5F) * h[1][row];
    }

    // Where the lanes `wanted` of source places land; true for those that can be placed.
    HWY_INLINE Lanes place(Lanes wanted, VF source_x, VF source_y, Landed& landed) const {
        const VI index = hn::Add(hn::Mul(truncated(source_y), hn::Set(DI{}, size_px_.x)), truncated(source_x));
        const VF depth = hn::GatherIndex(DF{}, depths_, index);
        const auto usable = hn::And(hn::Ge(depth, hn::Zero(DF{})), hn::Le(depth, hn::Set(DF{}, 1.0F)));
        HWY_ALIGN std::int32_t at[kMaxLanes];
        HWY_ALIGN std::int32_t id_lanes[kMaxLanes];
        hn::Store(index, DI{}, at);
        for (std::size_t lane = 0; lane < hn::Lanes(DF{}); ++lane) id_lanes[lane] = ids_[at[lane]];
        const VI ids = hn::Load(DI{}, id_lanes);
        auto valid = hn::Lt(hn::Zero(DF{}), hn::Zero(DF{}));
        auto remaining = hn::And(wanted, usable);
        while (!hn::AllFalse(DF{}, remaining)) {  // one turn per object, and most vectors have one
            const std::int32_t id = id_lanes[hn::FindFirstTrue(DF{}, remaining)];
            const auto same = hn::RebindMask(DF{}, hn::Eq(ids, hn::Set(DI{}, id)));
            const auto group = hn::And(remaining, same);
            remaining = hn::AndNot(same, remaining);
            const PixelMatrix* m = input_.matrices->find(static_cast<ObjectId>(id));
            if (m == nullptr) continue;
            const auto row = [&](float one, float of_y, float of_x, float of_z) {
                const VF sum = hn::Add(hn::Set(DF{}, one), hn::Mul(source_y, hn::Set(DF{}, of_y)));
                return hn::Add(hn::Add(sum, hn::Mul(source_x, hn::Set(DF{}, of_x))),
                               hn::Mul(depth, hn::Set(DF{}, of_z)));
            };
            const VF w = row(m->one.w, m->y.w, m->x.w, m->z.w);
            const VF scale = hn::Div(hn::Set(DF{}, 1.0F), w);
            const auto assign = [&](VF& to, VF value) { to = hn::IfThenElse(group, value, to); };
            assign(landed.x, hn::Mul(row(m->one.x, m->y.x, m->x.x, m->z.x), scale));
            assign(landed.y, hn::Mul(row(m->one.y, m->y.y, m->x.y, m->z.y), scale));
            assign(landed.depth, hn::Mul(hn::Mul(depth, hn::Set(DF{}, m->depth_scale)), scale));
            valid = hn::Or(valid, hn::And(group, hn::Gt(w, hn::Set(DF{}, kSmallestW))));
        }
        return valid;
    }

    HWY_INLINE void write(int x, int y, Lanes reached, VF source_x, VF source_y, VF depth) {
        const auto centre = [](VF place) { return hn::Sub(place, hn::Set(DF{}, 0.5F)); };
        const auto colour = encoder_.encoded(reader_.read(reader_.taps_of(centre(source_x), centre(source_y))));
        write_target(x, y, reached, colour, depth, out_);
    }

    const InverseInput& input_;
    DisplayFrame& out_;
    ColourReader reader_;
    ColourEncoder encoder_;
    glm::ivec2 size_px_;
    const float* depths_;
    const ObjectId* ids_;
};

void search_rows_here(const InverseInput& input, RowRange rows, DisplayFrame& out) {
    Searcher searcher{input, out};
    for (int y = rows.begin; y < rows.end; ++y) searcher.search_row(y);
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(search_rows_here);

void search_rows(const InverseInput& input, RowRange rows, DisplayFrame& out) {
    HWY_DYNAMIC_DISPATCH(search_rows_here)(input, rows, out);
}

}  // namespace lw
#endif
