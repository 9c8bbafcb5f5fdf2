#pragma once
/// What `surface` draws into: opaque pixels with a depth test, and partly covering fragments along edges, put together
/// at the end.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "warp_server/methods/row_range.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Draws a band of rows of one display frame. One thread per canvas; canvases of one frame have bands of their own.
class SurfaceCanvas {
public:
    /// Starts a picture in the rows `band` of `out`, whose colour and depth there it overwrites.
    void begin(DisplayFrame& out, RowRange band);

    [[nodiscard]] DisplayFrame& frame() const { return *frame_; }
    [[nodiscard]] RowRange band() const { return band_; }

    /// A surface that covers a share of pixel `index`, which must be in the band.
    /// @param coverage  in (0, 1]
    /// @param linear    its colour in linear light, 0 to kLinearOne
    void put_fragment(std::size_t index, float depth, float coverage, const glm::vec3& linear) {
        std::int32_t& newest = newest_[index - first_index_];
        if (newest < 0) touched_.push_back(static_cast<std::uint32_t>(index - first_index_));
        fragments_.push_back({linear, depth, coverage, newest});
        newest = static_cast<std::int32_t>(fragments_.size()) - 1;
    }

    /// Puts fragments over what is opaque and marks coverage. A pixel of which less than half is covered is a hole.
    void finish();

private:
    struct Fragment {
        glm::vec3 linear;  // 0 to kLinearOne
        float depth;
        float coverage;
        std::int32_t next;  // index of the pixel's fragment before, or -1
    };
    static constexpr int kNothingByte = 0xBF;  // four of them make the float -1.498: farther than every depth

    void composite(std::size_t touched);
    // The fragments of a pixel that are not behind `opaque_depth`, nearest first, into sorted_; returns their coverage.
    float sort_fragments(std::int32_t newest, float opaque_depth);

    DisplayFrame* frame_ = nullptr;
    RowRange band_;
    std::size_t first_index_ = 0;  // of the band's first pixel
    std::vector<Fragment> fragments_;
    std::vector<std::int32_t> newest_;    // of each pixel of the band: its newest fragment, or -1
    std::vector<std::uint32_t> touched_;  // pixels with fragments, relative to the band
    std::vector<const Fragment*> sorted_;
};

}  // namespace lw
