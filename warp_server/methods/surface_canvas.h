#pragma once
/// What `surface` draws into: opaque pixels with a depth test, and partly covering fragments along edges, put together
/// at the end.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "warp_server/warp_method.h"

namespace lw {

/// Draws into one display frame. One thread per canvas.
class SurfaceCanvas {
public:
    /// Starts a picture of the size of `out`, whose colour and depth it overwrites.
    void begin(DisplayFrame& out);

    [[nodiscard]] glm::ivec2 size_px() const { return frame_->colour.size_px(); }

    [[nodiscard]] bool shows_nearer(int x, int y, float depth) const { return frame_->depth.at(x, y) >= depth; }

    /// A surface that covers the whole pixel. The caller has asked shows_nearer().
    void put_opaque(int x, int y, float depth, Rgba8 colour) {
        frame_->depth.at(x, y) = depth;
        frame_->colour.at(x, y) = colour;
    }

    /// A surface that covers a share of the pixel.
    /// @param coverage  in (0, 1]
    /// @param linear    its colour in linear light
    void put_fragment(int x, int y, float depth, float coverage, const glm::vec3& linear);

    /// Puts fragments over what is opaque and marks coverage. A pixel of which less than half is covered is a hole.
    void finish();

private:
    struct Fragment {
        glm::vec3 linear;
        float depth;
        float coverage;
        std::int32_t next;  // index of the pixel's fragment before, or -1
    };
    static constexpr float kNothing = -1.0F;

    void composite(std::size_t pixel);

    DisplayFrame* frame_ = nullptr;
    std::vector<Fragment> fragments_;
    Image<std::int32_t> newest_;  // of each pixel: its newest fragment, or -1
    std::vector<std::size_t> touched_;
    std::vector<const Fragment*> sorted_;
};

}  // namespace lw
