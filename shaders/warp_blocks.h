#pragma once
// Bindings and block layouts of the warp shaders: included by C++ and by GLSL.

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>

namespace lw::glsl {
using uint = std::uint32_t;
using vec4 = glm::vec4;
#endif

// Texture units of a source layer.
#define LW_WARP_COLOUR_UNIT 0  // the stored bytes, nearest
#define LW_WARP_DEPTH_UNIT 1
#define LW_WARP_OBJECT_ID_UNIT 2
#define LW_WARP_SMOOTH_COLOUR_UNIT 3  // the same colours, bilinear in linear light

// Texture units of a picture that was drawn and is now composed with what lies over it.
#define LW_WARP_DRAWN_COLOUR_UNIT 4
#define LW_WARP_DRAWN_DEPTH_UNIT 5
#define LW_WARP_DRAWN_COVERAGE_UNIT 6

// Image units of the compute shaders.
#define LW_WARP_KEY_IMAGE 0
#define LW_WARP_INDEX_IMAGE 1
#define LW_WARP_COLOUR_IMAGE 2
#define LW_WARP_DEPTH_IMAGE 3
#define LW_WARP_COVERAGE_IMAGE 4

// Shader storage buffers.
#define LW_WARP_OBJECTS_BINDING 0
#define LW_WARP_COUNTERS_BINDING 1
#define LW_WARP_PATCHES_BINDING 2
#define LW_WARP_FRAGMENTS_BINDING 3

// Where an object's source pixels go, by columns: h = x_px * x + y_px * y + one + depth * z, each column as (x, y, w)
// of the homogeneous target pixel (h.x, h.y) / h.w. What is left of the vectors:
//   one.w  1 when the object has a usable placement, else 0: its pixels are counted and skipped
//   z.w    scale of the depth: target depth = z.w * depth / h.w
struct WarpObject {
    vec4 x;
    vec4 y;
    vec4 one;
    vec4 z;
};

// A piece of plane of `surface`: warp_server/methods/surface_classify.h, PatchList.
struct WarpPatch {
    vec4 plane;   // column and row of its origin's pixel; depth there; depth per pixel along x
    vec4 limits;  // left, right, top, bottom, relative to the origin, source pixels
    float gradient_y;
    uint object_id;
    uint corners;
    uint unused;
};

// A surface that covers a part of a target pixel.
struct WarpFragment {
    vec4 linear_coverage;  // colour in linear light, share of the pixel
    float depth;
    uint next;  // of the same pixel's fragments, or kNoFragment
    uint unused_0;
    uint unused_1;
};
const uint kNoFragment = 0xFFFFFFFFu;

#ifdef __cplusplus
}  // namespace lw::glsl
#endif
