/// Edge cells of `surface`: several surfaces meet in them, and each covers a pixel as much as its corners weigh.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_FRAGMENTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_FRAGMENTS_H
#undef LW_WARP_SERVER_METHODS_SURFACE_FRAGMENTS_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_FRAGMENTS_H
#endif

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_solving.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

inline constexpr float kSmallestCoverage = 1.0F / 512.0F;  // less changes no 8-bit colour

/// Draws edge cells as fragments.
class FragmentPainter {
public:
    FragmentPainter(const PreparedSurface& prepared, const PatchList& list, SurfaceCanvas& canvas)
        : list_{list},
          canvas_{canvas},
          source_size_px_{prepared.size_px},
          linear_{prepared.linear_colours.get()},
          depths_{canvas.frame().depth.pixels().data()} {}

    /// Lane k shows patch `first + k * stride` at the target pixel with index k of `indices`, where `inside`.
    template <class M>
    HWY_INLINE void paint(std::size_t first, std::size_t stride, const Solved& solved, hn::VFromD<DI> pixels,
                          M inside) {
        HWY_ALIGN std::int32_t indices[kMaxLanes];
        HWY_ALIGN float depths[kMaxLanes];
        HWY_ALIGN float u[kMaxLanes];
        HWY_ALIGN float v[kMaxLanes];
        const auto in_cell = [](VF place) { return hn::Min(hn::Max(place, hn::Zero(DF{})), hn::Set(DF{}, 1.0F)); };
        hn::Store(pixels, DI{}, indices);
        hn::Store(solved.depth, DF{}, depths);
        hn::Store(in_cell(solved.dx), DF{}, u);
        hn::Store(in_cell(solved.dy), DF{}, v);
        for (std::uint32_t bits = bits_of(DF{}, inside); bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            if (depths_[indices[lane]] >= depths[lane]) continue;
            paint_fragment(first + lane * stride, static_cast<std::size_t>(indices[lane]), depths[lane], u[lane],
                           v[lane]);
        }
    }

private:
    // Weighs the corners of its own surface alone, and covers as much as they weigh.
    HWY_INLINE void paint_fragment(std::size_t patch, std::size_t index, float depth, float u, float v) {
        const int x = static_cast<int>(list_.x[patch]);
        const int y = static_cast<int>(list_.y[patch]);
        const std::size_t right = x + 1 < source_size_px_.x ? 1 : 0;
        const std::size_t down = y + 1 < source_size_px_.y ? static_cast<std::size_t>(source_size_px_.x) : 0;
        const std::uint64_t* first = linear_ +
                                     static_cast<std::size_t>(y) * static_cast<std::size_t>(source_size_px_.x) +
                                     static_cast<std::size_t>(x);
        const std::uint64_t words[4] = {first[0], first[right], first[down], first[right + down]};
        const float weights[4] = {(1.0F - u) * (1.0F - v), u * (1.0F - v), (1.0F - u) * v, u * v};
        glm::vec3 linear{0.0F};
        float coverage = 0.0F;
        for (std::uint32_t corners = list_.corners[patch]; corners != 0; corners &= corners - 1) {
            const auto corner = static_cast<std::size_t>(__builtin_ctz(corners));
            const std::uint64_t word = words[corner];
            coverage += weights[corner];
            linear += weights[corner] * glm::vec3{static_cast<float>(word & 0xFFFFU),
                                                  static_cast<float>(word >> 16U & 0xFFFFU),
                                                  static_cast<float>(word >> 32U & 0xFFFFU)};
        }
        if (coverage < kSmallestCoverage) return;
        canvas_.put_fragment(index, depth, coverage, linear * (1.0F / coverage));
    }

    const PatchList& list_;
    SurfaceCanvas& canvas_;
    glm::ivec2 source_size_px_;
    const std::uint64_t* linear_;
    const float* depths_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
