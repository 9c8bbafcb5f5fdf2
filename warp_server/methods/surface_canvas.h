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

    /// Makes room for `count` more fragments.
    void reserve_fragments(std::size_t count) {
        if (fragments_.size() < fragment_count_ + count) fragments_.resize(2 * (fragment_count_ + count));
    }

    /// A surface that covers a share of pixel `index`, which must be in the band. There must be room.
    /// @param coverage  in (0, 1]
    /// @param linear    its colour in linear light, 0 to kLinearOne
    void put_fragment(std::size_t index, float depth, float coverage, const glm::vec3& linear) {
        fragments_[fragment_count_++] = {linear, depth, coverage, -1, static_cast<std::uint32_t>(index)};
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
    // Fragments are sorted by stretches of this many pixels, whose lists and picture fit a cache.
    static constexpr unsigned kStretchBits = 10;
    static constexpr std::size_t kStretch = std::size_t{1} << kStretchBits;

    // What becomes of fragments that cover too little of a pixel to be shown.
    enum class Uncovered { drop, wait };

    [[nodiscard]] std::size_t pixel_count() const;
    void composite_fragments_so_far(Uncovered uncovered);
    void sort_fragments(std::size_t pixel_count);
    void composite_stretch(std::size_t stretch, Uncovered uncovered);
    void put_off_uncovered(std::size_t first);
    // One pixel with any number of fragments, as composite_fragments has it.
    void composite(std::size_t pixel);
    // The same with the pixel's fragments, nearest first.
    void composite(std::size_t pixel, std::span<const SurfaceFragment* const> sorted, float covered);
    [[nodiscard]] std::size_t count_fragments(std::int32_t newest, float opaque_depth) const;

    DisplayFrame* frame_ = nullptr;
    RowRange band_;
    SurfaceSkips skips_;
    std::size_t first_index_ = 0;             // of the band's first pixel
    std::vector<SurfaceFragment> fragments_;  // as they came: the first fragment_count_ of them
    std::size_t fragment_count_ = 0;
    std::vector<SurfaceFragment> waiting_;         // put off until finish()
    std::vector<SurfaceFragment> sorted_;          // by stretches, in the order they came within each
    std::vector<std::uint32_t> stretch_begin_;     // of each stretch its first in sorted_, and one more
    std::array<std::int32_t, kStretch> newest_{};  // of each pixel of a stretch: its newest fragment, or -1
    std::vector<std::uint32_t> touched_;           // pixels of a stretch that have fragments
    std::vector<const SurfaceFragment*> many_sorted_;
    std::vector<PartlyCovered> partly_covered_;
};

}  // namespace lw
