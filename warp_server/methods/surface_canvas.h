#pragma once
/// What `surface` draws into: opaque pixels with a depth test, and partly covering fragments along edges, put together
/// at the end.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "warp_server/methods/row_range.h"
#include "warp_server/methods/surface_composite.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Patches and tiles found not to be seen before they were drawn.
struct SurfaceSkips {
    std::uint64_t empty = 0;    ///< their object has no placement, or they show their back
    std::uint64_t outside = 0;  ///< of the picture
    std::uint64_t hidden = 0;   ///< behind what was there, in this band
};

/// Draws a band of rows of one display frame. One thread per canvas; canvases of one frame have bands of their own.
class SurfaceCanvas {
public:
    /// Starts a picture in the rows `band` of `out`, whose colour and depth there it overwrites, or goes on with them.
    void begin(DisplayFrame& out, RowRange band, StackBase base);

    [[nodiscard]] DisplayFrame& frame() const { return *frame_; }
    [[nodiscard]] RowRange band() const { return band_; }
    /// After finish(): pixels of the band that are covered in part, with nothing behind.
    [[nodiscard]] const std::vector<PartlyCovered>& partly_covered() const { return partly_covered_; }
    /// Since begin().
    [[nodiscard]] SurfaceSkips& skips() { return skips_; }
    [[nodiscard]] const SurfaceSkips& skips() const { return skips_; }

    /// A surface that covers a share of pixel `index`, which must be in the band.
    void put_fragment(std::size_t index, const SurfaceFragment& fragment) {
        fragments_.put(index - first_index_, fragment);
    }

    /// One layer of several is drawn. Its fragments in one pixel are parts of one place, so they are put together now:
    /// what other layers have behind must not shine through between them (of a walk through `city` that cost 2 % of
    /// FLIP). Where they cover less than half, with nothing opaque behind, they wait for what all layers have.
    void finish_layer() { composite_fragments_so_far(Uncovered::wait); }

    /// Puts fragments over what is opaque and marks coverage. A pixel of which less than half is covered is a hole.
    void finish();

private:
    static constexpr int kNothingByte = 0xBF;  // four of them make the float -1.498: farther than every depth

    static constexpr std::size_t kFewFragments = 8;

    // The fragments of a stretch, by pixel.
    struct Stretch {
        std::size_t first_pixel;                                      // number in the picture
        std::array<std::int32_t, SurfaceFragments::kStretch> newest;  // of each pixel: a fragment, or -1
        // The first touched_count are pixels that have any, each once; room for one more.
        std::array<std::uint32_t, SurfaceFragments::kStretch + 1> touched;
        std::size_t touched_count = 0;
    };
    struct WaitingFragment {
        std::size_t pixel;  // number in the picture
        SurfaceFragment fragment;
    };

    // What becomes of fragments that cover too little of a pixel to be shown.
    enum class Uncovered { drop, wait };

    [[nodiscard]] std::size_t pixel_count() const;
    void composite_fragments_so_far(Uncovered uncovered);
    void list_fragments(std::size_t number, Stretch& stretch);
    void composite_stretch(Stretch& stretch, Uncovered uncovered);
    void put_off_uncovered(Stretch& stretch);
    // One pixel with any number of fragments, as composite_fragments has it.
    void composite(std::size_t pixel, std::int32_t newest);
    // The same with the pixel's fragments, nearest first.
    void composite(std::size_t pixel, std::span<const SurfaceFragment* const> sorted);
    [[nodiscard]] std::size_t count_fragments(std::int32_t newest, float opaque_depth) const;
    [[nodiscard]] const SurfaceFragment& fragment(std::int32_t index) const {
        return fragments_.all()[static_cast<std::size_t>(index)];
    }

    DisplayFrame* frame_ = nullptr;
    RowRange band_;
    SurfaceSkips skips_;
    std::size_t first_index_ = 0;  // of the band's first pixel
    SurfaceFragments fragments_;
    std::array<Stretch, 2> stretches_;      // in turns
    std::vector<WaitingFragment> waiting_;  // put off until finish()
    std::vector<const SurfaceFragment*> many_sorted_;
    std::vector<PartlyCovered> partly_covered_;
};

}  // namespace lw
