/// What the vector loops of all CPU methods share. Included by files that Highway compiles for every instruction set.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_LANES_H
#undef LW_WARP_SERVER_METHODS_LANES_H
#else
#define LW_WARP_SERVER_METHODS_LANES_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

/// After the parameters of a lambda whose vectors must stay in registers.
#undef LW_INLINE_LAMBDA
#define LW_INLINE_LAMBDA __attribute__((always_inline))

/// 1 where vectors hold 64 bytes and a lookup may take its entries from two of them. This version of Highway has no
/// name for such lookups, so those who use them write the instruction.
#undef LW_HAS_WIDE_LOOKUPS
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
#define LW_HAS_WIDE_LOOKUPS 1
#else
#define LW_HAS_WIDE_LOOKUPS 0
#endif

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 32-bit lanes of the widest vector.
inline constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(float);

/// Whole vectors of pixels.
using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;

/// `first`, `first` + 1, and so on. hn::Iota writes its lanes one by one, reads them back as a vector, and waits for
/// that, wherever the compiler cannot work them out before: with AVX2 it took a third of the time of `splat`.
template <class D>
HWY_INLINE hn::Vec<D> lanes_from(D d, hn::TFromD<D> first) {
    HWY_ALIGN static constexpr hn::TFromD<D> kCount[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    static_assert(kMaxLanes <= 16);
    return hn::Add(hn::Load(d, kCount), hn::Set(d, first));
}

/// One bit per lane, the first lane lowest. Reads back exactly the bytes that are written: a wider read would wait for
/// the write to reach the cache.
template <class D, class M>
HWY_INLINE std::uint32_t bits_of(D d, M mask) {
    if constexpr (hn::MaxLanes(D{}) > 8) {
        std::uint16_t bits = 0;
        hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
        return bits;
    } else {
        std::uint8_t bits = 0;
        hn::StoreMaskBits(d, mask, &bits);
        return bits;
    }
}

/// The other way: a mask of the lanes whose bits are set.
template <class D>
HWY_INLINE hn::Mask<D> lanes_of_bits(D d, std::uint32_t bits) {
    std::uint8_t bytes[8] = {};  // as many as Highway may read
    std::memcpy(bytes, &bits, sizeof(bits));
    return hn::LoadMaskBits(d, bytes);
}

/// The whole part, towards zero, of values that a 32-bit number holds; of others anything. hn::ConvertTo saturates
/// them, which takes four more instructions.
template <class V>
HWY_INLINE auto truncated(V value) {
    const hn::RebindToSigned<hn::DFromV<V>> di;
    using VI [[maybe_unused]] = hn::VFromD<decltype(di)>;
#if HWY_TARGET == HWY_SCALAR || !HWY_ARCH_X86
    return hn::ConvertTo(di, value);
#else
    if constexpr (sizeof(value.raw) == sizeof(__m128)) {
        return VI{_mm_cvttps_epi32(value.raw)};
#if HWY_TARGET <= HWY_AVX2
    } else if constexpr (sizeof(value.raw) == sizeof(__m256)) {
        return VI{_mm256_cvttps_epi32(value.raw)};
#endif
#if HWY_TARGET <= HWY_AVX3
    } else {
        return VI{_mm512_cvttps_epi32(value.raw)};
#endif
    }
#endif
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
