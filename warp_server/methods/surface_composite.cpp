#include "warp_server/methods/surface_composite.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/surface_composite.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "core/colour.h"
#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_sampling.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr float kNoDepth = -2.0F;  // behind everything
constexpr int kWordsPerFragment = sizeof(SurfaceFragment) / sizeof(float);

// One fragment of each of Lanes(DF) pixels; the words of SurfaceFragment.
struct Fragments {
    VF depth;
    hn::VFromD<DI> coverage_red, green_blue;

    // Of a word's two fields.
    [[nodiscard]] static HWY_INLINE VF first(hn::VFromD<DI> word) {
        return hn::ConvertTo(DF{}, hn::And(word, hn::Set(DI{}, 0xFFFF)));
    }
    [[nodiscard]] static HWY_INLINE VF second(hn::VFromD<DI> word) {
        return hn::ConvertTo(DF{}, hn::ShiftRight<16>(word));
    }

    [[nodiscard]] HWY_INLINE VF coverage() const {
        return hn::Mul(second(coverage_red), hn::Set(DF{}, 1.0F / static_cast<float>(kLinearOne)));
    }
    [[nodiscard]] HWY_INLINE VF red() const { return first(coverage_red); }
    [[nodiscard]] HWY_INLINE VF green() const { return second(green_blue); }
    [[nodiscard]] HWY_INLINE VF blue() const { return first(green_blue); }
};

// Nearer first; the rest only makes the order total.
HWY_INLINE hn::Mask<DF> goes_before(const Fragments& a, const Fragments& b) {
    const auto then = [](auto greater, auto equal, hn::Mask<DF> rest) {
        return hn::Or(hn::RebindMask(DF{}, greater), hn::And(hn::RebindMask(DF{}, equal), rest));
    };
    const auto by_green = hn::RebindMask(DF{}, hn::Gt(a.green_blue, b.green_blue));
    const auto by_coverage =
        then(hn::Gt(a.coverage_red, b.coverage_red), hn::Eq(a.coverage_red, b.coverage_red), by_green);
    return then(hn::Gt(a.depth, b.depth), hn::Eq(a.depth, b.depth), by_coverage);
}

HWY_INLINE void order(Fragments& a, Fragments& b) {
    const auto swapped = goes_before(b, a);
    const auto exchange = [&](auto& x, auto& y, auto d) {
        const auto mask = hn::RebindMask(d, swapped);
        const auto first = hn::IfThenElse(mask, y, x);
        y = hn::IfThenElse(mask, x, y);
        x = first;
    };
    exchange(a.depth, b.depth, DF{});
    exchange(a.coverage_red, b.coverage_red, DI{});
    exchange(a.green_blue, b.green_blue, DI{});
}

HWY_INLINE void sort(Fragments (&list)[kMostFragmentsAtOnce], int length) {
    static_assert(kMostFragmentsAtOnce == 4, "the network below sorts four");
    if (length < 2) return;
    if (length > 2) {
        order(list[0], list[2]);
        order(list[1], list[3]);
    }
    order(list[0], list[1]);
    if (length > 2) {
        order(list[2], list[3]);
        order(list[1], list[2]);
    }
}

// Lanes(DF) pixels or fewer.
class Batch {
public:
    Batch(const FragmentLists& lists, const std::uint32_t* touched, std::size_t count)
        : lists_{lists}, touched_{touched}, count_{count} {}

    // Composites; bits of the pixels that have too many fragments.
    HWY_INLINE std::uint32_t run() {
        read_opaque();
        const VF opaque_depth = hn::Load(DF{}, depth_);
        const auto has_opaque = hn::Ge(opaque_depth, hn::Zero(DF{}));
        auto at = hn::Load(DI{}, newest_);
        Fragments list[kMostFragmentsAtOnce];
        VF kept = hn::Zero(DF{});  // number of fragments that are not behind what is opaque
        int length = 0;
        const auto none = Fragments{hn::Set(DF{}, kNoDepth), hn::Zero(DI{}), hn::Zero(DI{})};
        std::fill(std::begin(list), std::end(list), none);
        while (length < kMostFragmentsAtOnce) {
            const auto valid = hn::Gt(at, hn::Set(DI{}, -1));
            if (hn::AllFalse(DI{}, valid)) break;
            list[length++] = gather(at, hn::RebindMask(DF{}, valid), opaque_depth, kept);
            at = next(at, valid);
        }
        const std::uint32_t too_many = bits_of(DI{}, hn::Gt(at, hn::Set(DI{}, -1)));
        sort(list, length);
        compose(list, length, kept, opaque_depth, has_opaque, too_many);
        return too_many;
    }

private:
    HWY_INLINE void read_opaque() {
        for (std::size_t i = 0; i < hn::Lanes(DF{}); ++i) {
            const std::size_t pixel = touched_[std::min(i, count_ - 1)];
            newest_[i] = lists_.newest[pixel];
            depth_[i] = lists_.depths[pixel];
            colour_[i] = reinterpret_cast<const std::uint32_t*>(lists_.colours)[pixel];
        }
    }

    [[nodiscard]] HWY_INLINE hn::VFromD<DI> word(hn::VFromD<DI> at, int index) const {
        const auto words = hn::Mul(hn::Max(at, hn::Zero(DI{})), hn::Set(DI{}, kWordsPerFragment));
        return hn::Add(words, hn::Set(DI{}, index));
    }

    [[nodiscard]] HWY_INLINE Fragments gather(hn::VFromD<DI> at, hn::Mask<DF> valid, VF opaque_depth, VF& kept) const {
        const auto* depths = reinterpret_cast<const float*>(lists_.fragments.data());
        const auto* words = reinterpret_cast<const std::int32_t*>(lists_.fragments.data());
        const VF depth = hn::GatherIndex(DF{}, depths, word(at, 0));
        const auto keep = hn::AndNot(hn::Lt(depth, opaque_depth), valid);
        kept = hn::Add(kept, hn::IfThenElseZero(keep, hn::Set(DF{}, 1.0F)));
        const auto kept_word = [&](int index) {
            return hn::IfThenElseZero(hn::RebindMask(DI{}, keep), hn::GatherIndex(DI{}, words, word(at, index)));
        };
        return {hn::IfThenElse(keep, depth, hn::Set(DF{}, kNoDepth)), kept_word(1), kept_word(2)};
    }

    [[nodiscard]] HWY_INLINE hn::VFromD<DI> next(hn::VFromD<DI> at, hn::Mask<DI> valid) const {
        const auto* words = reinterpret_cast<const std::int32_t*>(lists_.fragments.data());
        return hn::IfThenElse(valid, hn::GatherIndex(DI{}, words, word(at, 3)), hn::Set(DI{}, -1));
    }

    HWY_INLINE void compose(const Fragments (&list)[kMostFragmentsAtOnce], int length, VF kept, VF opaque_depth,
                            hn::Mask<DF> has_opaque, std::uint32_t too_many) {
        VF red = hn::Zero(DF{});
        VF green = red;
        VF blue = red;
        VF left = hn::Set(DF{}, 1.0F);
        VF covered = red;
        VF largest_share = red;
        VF depth = opaque_depth;
        for (int i = 0; i < length; ++i) {
            const Fragments& fragment = list[i];
            const auto is_last = hn::AndNot(has_opaque, hn::Eq(kept, hn::Set(DF{}, static_cast<float>(i + 1))));
            const VF coverage = fragment.coverage();
            const VF share = hn::IfThenElse(is_last, left, hn::Mul(left, coverage));
            covered = hn::Add(covered, coverage);
            red = hn::Add(red, hn::Mul(share, fragment.red()));
            green = hn::Add(green, hn::Mul(share, fragment.green()));
            blue = hn::Add(blue, hn::Mul(share, fragment.blue()));
            left = hn::Sub(left, share);
            const auto larger = hn::Gt(share, largest_share);
            largest_share = hn::IfThenElse(larger, share, largest_share);
            depth = hn::IfThenElse(larger, fragment.depth, depth);
        }
        const VF behind = hn::IfThenElseZero(has_opaque, hn::Mul(left, hn::Set(DF{}, static_cast<float>(kLinearOne))));
        const auto colour = hn::Load(DU{}, colour_);
        const auto opaque = [&](auto shifted) {
            const auto level = hn::BitCast(DI{}, hn::And(shifted, hn::Set(DU{}, 0xFFU)));
            return hn::Mul(behind, hn::GatherIndex(DF{}, linear_from_srgb8_table().data(), level));
        };
        red = hn::Add(red, opaque(colour));
        green = hn::Add(green, opaque(hn::ShiftRight<8>(colour)));
        blue = hn::Add(blue, opaque(hn::ShiftRight<16>(colour)));
        depth = hn::IfThenElse(hn::And(has_opaque, hn::Ge(left, largest_share)), opaque_depth, depth);

        const auto whole = [](VF linear) {
            const VF rounded = hn::Add(linear, hn::Set(DF{}, 0.5F));
            const VF most = hn::Set(DF{}, static_cast<float>(kLinearOne));
            return hn::BitCast(DU{}, truncated(hn::Min(hn::Max(rounded, hn::Zero(DF{})), most)));
        };
        const auto enough = hn::Or(has_opaque, hn::Ge(covered, hn::Set(DF{}, 0.5F)));
        const auto shown = hn::And(enough, hn::Gt(kept, hn::Zero(DF{})));
        const auto composed = encoder_.encoded({whole(red), whole(green), whole(blue)});
        const auto any = hn::Gt(covered, hn::Zero(DF{}));
        const auto partly = hn::AndNot(has_opaque, hn::And(any, hn::Lt(covered, hn::Set(DF{}, kWholeCover))));
        const std::uint32_t bits = bits_of(DF{}, partly) & ~too_many & ((1U << count_) - 1U);
        if (bits != 0) keep_partly_covered(bits, covered, composed, depth);
        write(composed, depth, shown, too_many);
    }

    HWY_INLINE void keep_partly_covered(std::uint32_t bits, VF covered, hn::VFromD<DU> colour, VF depth) {
        HWY_ALIGN float shares[kMaxLanes];
        HWY_ALIGN float depths[kMaxLanes];
        HWY_ALIGN std::uint32_t colours[kMaxLanes];
        hn::Store(covered, DF{}, shares);
        hn::Store(depth, DF{}, depths);
        hn::Store(colour, DU{}, colours);
        for (; bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            lists_.partly_covered->push_back(
                {lists_.first_pixel + touched_[lane], shares[lane], depths[lane], std::bit_cast<Rgba8>(colours[lane])});
        }
    }

    // Every pixel, what is not shown as it was: without branches, which nothing could predict.
    HWY_INLINE void write(hn::VFromD<DU> colour, VF depth, hn::Mask<DF> shown, std::uint32_t too_many) {
        const auto left_alone = lanes_of_bits(DI{}, too_many);
        const auto written = hn::AndNot(hn::RebindMask(DF{}, left_alone), shown);
        hn::Store(hn::IfThenElse(written, depth, hn::Load(DF{}, depth_)), DF{}, depth_);
        hn::Store(hn::IfThenElse(hn::RebindMask(DU{}, written), colour, hn::Load(DU{}, colour_)), DU{}, colour_);
        hn::Store(hn::IfThenElse(left_alone, hn::Load(DI{}, newest_), hn::Set(DI{}, -1)), DI{}, newest_);
        for (std::size_t i = 0; i < count_; ++i) {
            const std::size_t pixel = touched_[i];
            lists_.newest[pixel] = newest_[i];
            lists_.depths[pixel] = depth_[i];
            reinterpret_cast<std::uint32_t*>(lists_.colours)[pixel] = colour_[i];
        }
    }

    const FragmentLists& lists_;
    const std::uint32_t* touched_;
    std::size_t count_;
    ColourEncoder encoder_;
    HWY_ALIGN std::int32_t newest_[kMaxLanes];
    HWY_ALIGN float depth_[kMaxLanes];
    HWY_ALIGN std::uint32_t colour_[kMaxLanes];
};

std::size_t composite_fragments_here(const FragmentLists& lists, std::span<std::uint32_t> touched) {
    const std::size_t lanes = hn::Lanes(DF{});
    std::size_t left = 0;
    for (std::size_t i = 0; i < touched.size(); i += lanes) {
        const std::size_t count = std::min(lanes, touched.size() - i);
        std::uint32_t too_many = Batch{lists, touched.data() + i, count}.run() & ((1U << count) - 1U);
        for (; too_many != 0; too_many &= too_many - 1) {
            touched[left++] = touched[i + static_cast<std::size_t>(__builtin_ctz(too_many))];
        }
    }
    return left;
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(composite_fragments_here);

std::size_t composite_fragments(const FragmentLists& lists, std::span<std::uint32_t> touched) {
    return HWY_DYNAMIC_DISPATCH(composite_fragments_here)(lists, touched);
}

}  // namespace lw
#endif
