#include "warp_server/methods/splat_resolve.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/splat_resolve.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <bit>
#include <optional>

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// Where the pixels of one target row lie in the source by the rotation alone, before the division by w.
template <class D>
class RowPlaces {
public:
    HWY_INLINE RowPlaces(D /*d*/, const glm::mat3& h, int y)
        : start_{h[2] + (static_cast<float>(y) + 0.5F) * h[1]}, along_x_{h[0]} {}

    [[nodiscard]] HWY_INLINE hn::Vec<D> x_px_of(D d, int x) const {
        return hn::Add(lanes_from(d, static_cast<float>(x)), hn::Set(d, 0.5F));
    }
    /// 0: x * w, 1: y * w, 2: w.
    [[nodiscard]] HWY_INLINE hn::Vec<D> term(D d, hn::Vec<D> x_px, int component) const {
        return hn::Add(hn::Set(d, start_[component]), hn::Mul(x_px, hn::Set(d, along_x_[component])));
    }

private:
    glm::vec3 start_;
    glm::vec3 along_x_;
};

// Where Lanes(d) target pixels lie in the source by the rotation alone.
template <class D>
struct SourcePlaces {
    hn::Vec<D> x_px, y_px;
    hn::Mask<D> inside;
};

template <class D>
HWY_INLINE SourcePlaces<D> source_places(D d, const glm::mat3& h, glm::ivec2 size_px, int x, int y) {
    const RowPlaces<D> places{d, h, y};
    const auto x_px = places.x_px_of(d, x);
    const auto w = places.term(d, x_px, 2);
    const auto per_w = hn::Div(hn::Set(d, 1.0F), w);
    const auto place_x = hn::Mul(places.term(d, x_px, 0), per_w);
    const auto place_y = hn::Mul(places.term(d, x_px, 1), per_w);
    const auto within = [&](hn::Vec<D> place, int size) {
        return hn::And(hn::Ge(place, hn::Zero(d)), hn::Lt(place, hn::Set(d, static_cast<float>(size))));
    };
    return {place_x, place_y,
            hn::And(hn::Gt(w, hn::Zero(d)), hn::And(within(place_x, size_px.x), within(place_y, size_px.y)))};
}

// What a vector of target pixels shows.
template <class D>
struct Shown {
    hn::Vec<hn::RebindToUnsigned<D>> colour;
    hn::Mask<D> reached;
};

bool is_background(const CpuPixels& pixels, std::size_t i) {
    return pixels.depth.pixels()[i] == 0.0F && pixels.object_id.pixels()[i] == 0;
}

// Of 2 * Lanes(d) values in a row, the ones at `index`.
template <class D, class V, class VI>
HWY_INLINE V pick(D d, V first, V second, VI index) {
    const hn::RebindToSigned<D> di;
    const auto lanes = hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d)));
    const auto in_first = hn::Lt(index, lanes);
    const auto in_second = hn::IfThenElse(in_first, index, hn::Sub(index, lanes));
    const auto indices = hn::IndicesFromVec(d, hn::BitCast(hn::RebindToUnsigned<D>{}, in_second));
    return hn::IfThenElse(hn::RebindMask(d, in_first), hn::TableLookupLanes(first, indices),
                          hn::TableLookupLanes(second, indices));
}

// The background of target pixels whose places lie on one source row, in columns [first, first + 2 * Lanes(d)).
template <class D, class VI>
HWY_INLINE void add_background_row(D d, const SplatInput& input, int first, int row, VI column, hn::Mask<D> group,
                                   Shown<D>& shown) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint16_t, D> d16;
    const CpuPixels& pixels = *input.pixels;
    const auto lanes = hn::Lanes(d);
    const auto offset =
        hn::Sub(hn::IfThenElse(hn::RebindMask(di, group), column, hn::Set(di, first)), hn::Set(di, first));
    const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.depth.width()) +
                           static_cast<std::size_t>(first);
    auto seen = group;
    const BackgroundShare share = input.tiles->background_in(first, first + 2 * static_cast<int>(lanes), row);
    if (share == BackgroundShare::none) return;
    if (share == BackgroundShare::some) {
        const float* depths = pixels.depth.pixels().data() + at;
        __builtin_prefetch(depths + pixels.depth.width());
        const ObjectId* ids = pixels.object_id.pixels().data() + at;
        const auto depth = pick(d, hn::LoadU(d, depths), hn::LoadU(d, depths + lanes), offset);
        const auto id =
            pick(du, hn::PromoteTo(du, hn::LoadU(d16, ids)), hn::PromoteTo(du, hn::LoadU(d16, ids + lanes)), offset);
        seen = hn::And(seen, hn::And(hn::Eq(depth, hn::Zero(d)), hn::RebindMask(d, hn::Eq(id, hn::Zero(du)))));
    }
    const auto* colours = reinterpret_cast<const std::uint32_t*>(pixels.colour.pixels().data() + at);
    __builtin_prefetch(colours + pixels.depth.width());  // of the next row, which lies in another page
    const auto colour = pick(du, hn::LoadU(du, colours), hn::LoadU(du, colours + lanes), offset);
    shown.colour = hn::IfThenElse(hn::RebindMask(du, seen), colour, shown.colour);
    shown.reached = hn::Or(shown.reached, seen);
}

// The same one by one, for places that lie wide apart or at the end of the image.
template <class D, class VI>
HWY_NOINLINE void add_background_pixels(D d, const CpuPixels& pixels, VI column, VI row, hn::Mask<D> wanted,
                                        Shown<D>& shown) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    HWY_ALIGN std::int32_t columns[kMaxLanes];
    HWY_ALIGN std::int32_t rows[kMaxLanes];
    HWY_ALIGN std::uint32_t colours[kMaxLanes];
    HWY_ALIGN std::uint32_t reached[kMaxLanes];
    hn::Store(column, di, columns);
    hn::Store(row, di, rows);
    hn::Store(shown.colour, du, colours);
    hn::Store(hn::VecFromMask(du, hn::RebindMask(du, shown.reached)), du, reached);
    for (std::uint32_t bits = bits_of(d, wanted); bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
        const std::size_t source =
            static_cast<std::size_t>(rows[lane]) * static_cast<std::size_t>(pixels.depth.width()) +
            static_cast<std::size_t>(columns[lane]);
        if (!is_background(pixels, source)) continue;
        colours[lane] = std::bit_cast<std::uint32_t>(pixels.colour.pixels()[source]);
        reached[lane] = 0xFFFFFFFFU;
    }
    shown.colour = hn::Load(du, colours);
    shown.reached = hn::RebindMask(d, hn::MaskFromVec(hn::Load(du, reached)));
}

// Shows the background where no point is.
template <class D>
HWY_INLINE void add_background(D d, const SplatInput& input, const glm::mat3& h, int x, int y, Shown<D>& shown) {
    const hn::RebindToSigned<D> di;
    const CpuPixels& pixels = *input.pixels;
    const SourcePlaces<D> places = source_places(d, h, pixels.depth.size_px(), x, y);
    auto wanted = hn::AndNot(shown.reached, places.inside);
    if (hn::AllFalse(d, wanted)) return;
    const auto column = truncated(hn::IfThenElseZero(places.inside, places.x_px));
    const auto row = truncated(hn::IfThenElseZero(places.inside, places.y_px));
    HWY_ALIGN std::int32_t rows[kMaxLanes];
    hn::Store(row, di, rows);
    const int span = 2 * static_cast<int>(hn::Lanes(d));
    const std::size_t last = hn::Lanes(d) - 1;
    if (rows[0] == rows[last] && hn::AllTrue(d, wanted)) {
        // Places along a target row move one way in the source: what holds of the ends holds between.
        HWY_ALIGN std::int32_t columns[kMaxLanes];
        hn::Store(column, di, columns);
        const auto [least, greatest] = std::minmax(columns[0], columns[last]);
        const int first = std::min(least, pixels.depth.width() - span);
        if (first >= 0 && greatest < first + span) {
            add_background_row(d, input, first, rows[0], column, wanted, shown);
            return;
        }
    }
    while (!hn::AllFalse(d, wanted)) {  // one turn per source row, and most vectors of a level head have one
        const int group_row = rows[hn::FindFirstTrue(d, wanted)];
        const auto group = hn::And(wanted, hn::RebindMask(d, hn::Eq(row, hn::Set(di, group_row))));
        const auto columns = hn::IfThenElse(hn::RebindMask(di, group), column, hn::Set(di, pixels.depth.width()));
        const int first = std::min(hn::GetLane(hn::MinOfLanes(di, columns)), pixels.depth.width() - span);
        const auto far_apart = hn::And(group, hn::RebindMask(d, hn::Gt(column, hn::Set(di, first + span - 1))));
        if (first < 0 || !hn::AllFalse(d, far_apart)) {
            add_background_pixels(d, pixels, column, row, wanted, shown);
            return;
        }
        add_background_row(d, input, first, group_row, column, group, shown);
        wanted = hn::AndNot(group, wanted);
    }
}

template <class D>
HWY_INLINE void show(D /*d*/, const Shown<D>& shown, std::size_t at, DisplayFrame& out) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> d8;
    const auto opaque = hn::Or(shown.colour, hn::Set(du, 0xFF000000U));
    hn::StoreU(opaque, du, reinterpret_cast<std::uint32_t*>(out.colour.pixels().data() + at));
    const auto coverage = hn::IfThenElseZero(hn::RebindMask(di, shown.reached), hn::Set(di, 1));
    hn::StoreU(hn::DemoteTo(d8, coverage), d8, reinterpret_cast<std::uint8_t*>(out.coverage.pixels().data() + at));
}

// Lanes(d) target pixels and their keys, which are cleared.
template <class D>
HWY_INLINE void resolve_keys(D d, const SplatInput& input, const glm::mat3& h, int x, int y, WinnerKey* keys,
                             DisplayFrame& out) {
    const hn::RebindToUnsigned<D> du;
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out.colour.width()) + static_cast<std::size_t>(x);
    auto* words = reinterpret_cast<std::uint32_t*>(keys);
    hn::VFromD<decltype(du)> low;
    hn::VFromD<decltype(du)> high;
    hn::LoadInterleaved2(du, words, low, high);
    hn::StoreU(hn::Zero(du), du, words);
    hn::StoreU(hn::Zero(du), du, words + hn::Lanes(du));
    const auto rest = hn::Or(hn::ShiftLeft<6>(hn::And(high, hn::Set(du, 0x1FFU))), hn::ShiftRight<26>(low));
    const auto depth = hn::Or(hn::ShiftLeft<15>(hn::ShiftRight<17>(high)), rest);
    hn::StoreU(hn::BitCast(d, depth), d, out.depth.pixels().data() + at);
    // The low word's rest of the depth goes with the alpha.
    Shown<D> shown{low, hn::RebindMask(d, hn::Ne(high, hn::Zero(du)))};
    if (!hn::AllTrue(d, shown.reached)) add_background(d, input, h, x, y, shown);
    show(d, shown, at, out);
}

// The same where all keys are 0.
template <class D>
HWY_INLINE void resolve_unreached(D d, const SplatInput& input, const glm::mat3& h, int x, int y, DisplayFrame& out) {
    const hn::RebindToUnsigned<D> du;
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out.colour.width()) + static_cast<std::size_t>(x);
    hn::StoreU(hn::Zero(d), d, out.depth.pixels().data() + at);
    Shown<D> shown{hn::Zero(du), hn::MaskFromVec(hn::Zero(d))};
    add_background(d, input, h, x, y, shown);
    show(d, shown, at, out);
}

// Runs of target pixels that no point reached, most of which show nothing but background of one or two source rows.
constexpr int kRun_px = kTileWidth_px;

// Where a run lies in the source when all of it shows background.
struct BackgroundRun {
    int row;          // the upper of at most two
    int last_row;     // the lower
    bool rightwards;  // along the target row
};

// Places along a target row move one way in the source: what holds of the two ends holds between.
std::optional<BackgroundRun> background_run(const SplatInput& input, const glm::mat3& h, int x, int y) {
    constexpr float kRounding_px = 0.01F;
    const glm::vec2 size_px{input.pixels->depth.size_px()};
    glm::vec2 ends[2];
    for (const int end : {0, 1}) {
        const glm::vec3 place =
            h * glm::vec3{static_cast<float>(x + end * (kRun_px - 1)) + 0.5F, static_cast<float>(y) + 0.5F, 1.0F};
        if (!(place.z > 0.0F)) return std::nullopt;
        ends[end] = glm::vec2{place} / place.z;
    }
    const glm::vec2 least = glm::min(ends[0], ends[1]) - kRounding_px;
    const glm::vec2 greatest = glm::max(ends[0], ends[1]) + kRounding_px;
    const bool inside = least.x >= 0.0F && least.y >= 0.0F && greatest.x < size_px.x && greatest.y < size_px.y;
    if (!inside) return std::nullopt;
    const auto row = static_cast<int>(least.y);
    const auto last_row = static_cast<int>(greatest.y);
    if (last_row > row + 1) return std::nullopt;
    const auto begin_x = static_cast<int>(least.x);
    const auto end_x = static_cast<int>(greatest.x) + 1;
    for (const int seen : {row, last_row}) {
        if (input.tiles->background_in(begin_x, end_x, seen) != BackgroundShare::all) return std::nullopt;
    }
    return BackgroundRun{row, last_row, ends[0].x <= ends[1].x};
}

// False when the places of a vector lie too wide apart for this. May have shown some by then.
template <bool kTwoRows, class D>
HWY_INLINE bool show_background_run(D d, const SplatInput& input, const glm::mat3& h, const BackgroundRun& run, int x,
                                    int y, DisplayFrame& out) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> d8;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int width = input.pixels->depth.width();
    const int last_first = width - 2 * lanes;  // two vectors are read at once
    if (last_first < 0) return false;
    const auto* upper = reinterpret_cast<const std::uint32_t*>(input.pixels->colour.row(run.row).data());
    const auto* lower = reinterpret_cast<const std::uint32_t*>(input.pixels->colour.row(run.last_row).data());
    auto* colours = reinterpret_cast<std::uint32_t*>(out.colour.row(y).data() + x);
    auto* depths = out.depth.row(y).data() + x;
    auto* coverages = reinterpret_cast<std::uint8_t*>(out.coverage.row(y).data() + x);
    const RowPlaces<D> places{d, h, y};
    const auto lower_y = hn::Set(d, static_cast<float>(run.row + 1));
    const std::size_t least_lane = run.rightwards ? 0 : hn::Lanes(d) - 1;
    HWY_ALIGN std::int32_t columns[kMaxLanes];
    for (int i = 0; i < kRun_px; i += lanes) {
        const auto x_px = places.x_px_of(d, x + i);
        const auto per_w = hn::Div(hn::Set(d, 1.0F), places.term(d, x_px, 2));
        const auto column = truncated(hn::Mul(places.term(d, x_px, 0), per_w));
        hn::Store(column, di, columns);
        const int first = std::min(columns[least_lane], last_first);
        if (columns[hn::Lanes(d) - 1 - least_lane] - first >= 2 * lanes) return false;
        __builtin_prefetch(lower + first + width);  // of the next row, which lies in another page
        const auto offset = hn::Sub(column, hn::Set(di, first));
        const auto shown_of = [&](const std::uint32_t* row) LW_INLINE_LAMBDA {
            return pick(du, hn::LoadU(du, row + first), hn::LoadU(du, row + first + lanes), offset);
        };
        auto colour = shown_of(upper);
        if constexpr (kTwoRows) {
            const auto in_lower = hn::Ge(hn::Mul(places.term(d, x_px, 1), per_w), lower_y);
            colour = hn::IfThenElse(hn::RebindMask(du, in_lower), shown_of(lower), colour);
        }
        hn::StoreU(hn::Or(colour, hn::Set(du, 0xFF000000U)), du, colours + i);
        hn::StoreU(hn::Zero(d), d, depths + i);
        hn::StoreU(hn::Set(d8, 1), d8, coverages + i);
    }
    return true;
}

void resolve_rows_here(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows, KeyRing& keys,
                       DisplayFrame& out) {
    const DF d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const glm::mat3& h = background.source_px_from_target_px;
    for (int y = target_rows.begin; y < target_rows.end; ++y) {
        WinnerKey* row = keys.row(y);
        const int end = keys.first_column() + keys.width();
        int x = keys.first_column();
        for (; x + lanes <= end; x += lanes, row += lanes) resolve_keys(d, input, h, x, y, row, out);
        for (; x < end; ++x, ++row) resolve_keys(d1, input, h, x, y, row, out);
    }
}

void resolve_unreached_here(const SplatInput& input, const BackgroundLookup& background, const PixelRect& target,
                            DisplayFrame& out) {
    const DF d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const glm::mat3& h = background.source_px_from_target_px;
    const auto one_by_one = [&](int x, int end_x, int y) {
        for (; x + lanes <= end_x; x += lanes) resolve_unreached(d, input, h, x, y, out);
        for (; x < end_x; ++x) resolve_unreached(d1, input, h, x, y, out);
    };
    for (int y = target.first_px.y; y < target.end_px.y; ++y) {
        int x = target.first_px.x;
        for (; x + kRun_px <= target.end_px.x; x += kRun_px) {
            const std::optional<BackgroundRun> run = background_run(input, h, x, y);
            const bool shown =
                run && (run->row == run->last_row ? show_background_run<false>(d, input, h, *run, x, y, out)
                                                  : show_background_run<true>(d, input, h, *run, x, y, out));
            if (!shown) one_by_one(x, x + kRun_px, y);
        }
        one_by_one(x, target.end_px.x, y);
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(resolve_rows_here);
HWY_EXPORT(resolve_unreached_here);

void resolve_rows(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows, KeyRing& keys,
                  DisplayFrame& out) {
    HWY_DYNAMIC_DISPATCH(resolve_rows_here)(input, background, target_rows, keys, out);
}

void resolve_unreached(const SplatInput& input, const BackgroundLookup& background, const PixelRect& target,
                       DisplayFrame& out) {
    HWY_DYNAMIC_DISPATCH(resolve_unreached_here)(input, background, target, out);
}

}  // namespace lw
#endif
