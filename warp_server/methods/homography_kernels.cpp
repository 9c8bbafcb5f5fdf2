#include "warp_server/methods/homography_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/homography_kernels.cpp"
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

using VI = hn::VFromD<DI>;
using VU = hn::VFromD<DU>;
using Lanes = hn::Mask<DF>;

class Resampler {
public:
    Resampler(const HomographyInput& input, DisplayFrame& out)
        : input_{input},
          out_{out},
          reader_{*input.linear},
          size_px_{input.pixels->depth.size_px()},
          depths_{input.pixels->depth.pixels().data()} {}

    void resample_row(int y) {
        for (int x = 0; x < out_.depth.width(); x += static_cast<int>(hn::Lanes(DF{}))) resample(x, y);
    }

    [[nodiscard]] std::uint64_t bad_depths() const { return bad_depths_; }

private:
    // Lanes(DF) pixels from column x on, some of them perhaps beyond the row.
    HWY_INLINE void resample(int x, int y) {
        const glm::mat3& h = input_.source_from_target;
        const glm::vec3 row_start = h[2] + (static_cast<float>(y) + 0.5F) * h[1];
        const VF pixel_x = hn::Add(lanes_from(DF{}, static_cast<float>(x)), hn::Set(DF{}, 0.5F));
        const auto term = [&](int row) {
            return hn::Add(hn::Set(DF{}, row_start[row]), hn::Mul(pixel_x, hn::Set(DF{}, h[0][row])));
        };
        const VF w = term(2);
        const VF place_x = hn::Div(term(0), w);
        const VF place_y = hn::Div(term(1), w);
        const auto within = [](VF place, int size) {
            return hn::And(hn::Ge(place, hn::Zero(DF{})), hn::Lt(place, hn::Set(DF{}, static_cast<float>(size))));
        };
        const Lanes inside =
            hn::And(hn::Gt(w, hn::Zero(DF{})), hn::And(within(place_x, size_px_.x), within(place_y, size_px_.y)));
        if (hn::AllFalse(DF{}, inside)) return write_target(x, y, inside, hn::Zero(DU{}), hn::Zero(DF{}), out_);

        const VF source_x = hn::IfThenElseZero(inside, place_x);
        const VF source_y = hn::IfThenElseZero(inside, place_y);
        const VI nearest = index_of(truncated(source_x), truncated(source_y));
        const VF depth = hn::GatherIndex(DF{}, depths_, nearest);
        const Lanes usable = hn::And(hn::Ge(depth, hn::Zero(DF{})), hn::Le(depth, hn::Set(DF{}, 1.0F)));
        bad_depths_ += hn::CountTrue(DF{}, on_target(x, hn::AndNot(usable, inside)));
        const Lanes reached = hn::AndNot(shows_nothing(depth), inside);
        const VF target_depth =
            hn::Mul(hn::Mul(hn::IfThenElseZero(usable, depth), hn::Set(DF{}, input_.depth_scale)), w);
        write_target(x, y, reached, colour_at(source_x, source_y, nearest), hn::Min(target_depth, hn::Set(DF{}, 1.0F)),
                     out_);
    }

    // Those of the lanes that are no farther than the last column.
    [[nodiscard]] HWY_INLINE Lanes on_target(int x, Lanes lanes) const {
        const VI column = lanes_from(DI{}, x);
        return hn::And(lanes, hn::RebindMask(DF{}, hn::Lt(column, hn::Set(DI{}, out_.depth.width()))));
    }

    [[nodiscard]] HWY_INLINE VI index_of(VI column, VI row) const {
        return hn::Add(hn::Mul(row, hn::Set(DI{}, size_px_.x)), column);
    }

    [[nodiscard]] static HWY_INLINE Lanes shows_nothing(VF depth) {
        return hn::Eq(depth, hn::Set(DF{}, kNoSurfaceDepth));
    }

    [[nodiscard]] HWY_INLINE VU colour_at(VF source_x, VF source_y, VI nearest) const {
        const auto centre = [](VF place) { return hn::Sub(place, hn::Set(DF{}, 0.5F)); };
        const Taps taps = reader_.taps_of(centre(source_x), centre(source_y));
        const VU colour = encoder_.encoded(read(taps));
        if (!input_.has_empty_pixels) return colour;
        const Lanes beside = beside_nothing(taps);
        if (hn::AllFalse(DF{}, beside)) return colour;
        const auto* colours = reinterpret_cast<const std::uint32_t*>(input_.pixels->colour.pixels().data());
        const VU own = hn::Or(hn::GatherIndex(DU{}, colours, nearest), hn::Set(DU{}, 0xFF000000U));
        return hn::IfThenElse(hn::RebindMask(DU{}, beside), own, colour);
    }

    [[nodiscard]] HWY_INLINE LinearColours read(const Taps& taps) const {
        HWY_ALIGN std::int32_t x[kMaxLanes];
        HWY_ALIGN std::int32_t y[kMaxLanes];
        hn::Store(taps.x, DI{}, x);
        hn::Store(taps.y, DI{}, y);
        return reader_.read_along(taps, (1U << hn::Lanes(DF{})) - 1U, x, y);
    }

    // Does one of the four pixels that are mixed show nothing?
    [[nodiscard]] HWY_INLINE Lanes beside_nothing(const Taps& taps) const {
        const VI right = hn::Min(hn::Add(taps.x, hn::Set(DI{}, 1)), hn::Set(DI{}, size_px_.x - 1));
        const VI below = hn::Min(hn::Add(taps.y, hn::Set(DI{}, 1)), hn::Set(DI{}, size_px_.y - 1));
        const auto nothing_at = [&](VI column, VI row) {
            return shows_nothing(hn::GatherIndex(DF{}, depths_, index_of(column, row)));
        };
        return hn::Or(hn::Or(nothing_at(taps.x, taps.y), nothing_at(right, taps.y)),
                      hn::Or(nothing_at(taps.x, below), nothing_at(right, below)));
    }

    const HomographyInput& input_;
    DisplayFrame& out_;
    ColourReader reader_;
    ColourEncoder encoder_;
    glm::ivec2 size_px_;
    const float* depths_;
    std::uint64_t bad_depths_ = 0;
};

std::uint64_t resample_rows_here(const HomographyInput& input, RowRange rows, DisplayFrame& out) {
    Resampler resampler{input, out};
    for (int y = rows.begin; y < rows.end; ++y) resampler.resample_row(y);
    return resampler.bad_depths();
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(resample_rows_here);

std::uint64_t resample_rows(const HomographyInput& input, RowRange rows, DisplayFrame& out) {
    return HWY_DYNAMIC_DISPATCH(resample_rows_here)(input, rows, out);
}

}  // namespace lw
#endif
