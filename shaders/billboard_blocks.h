#pragma once
// What the billboards' shaders and their C++ side agree on. Both languages include this file. The record is std430 and
// made of 16-byte members; a test compares the offsets.

#ifdef __cplusplus
#include <glm/glm.hpp>

namespace lw::shader {
using glm::uvec4;
using glm::vec4;
#endif

// Per instance of a mesh drawn into an atlas, besides its rows and its id (client_blocks.h).
const int kAttributeViewX = 9;  // clip.x = dot(view_x.xyz, position_relative); clip.z = view_x.w + view_y.w * clip.w
const int kAttributeViewY = 10;
const int kAttributeViewW = 11;

// Texture units of the pass that draws billboards.
const int kUnitAtlasDepth = 0;
const int kUnitAtlasSurface = 1;   // packed, or albedo and roughness
const int kUnitAtlasNormal = 2;    // not in the packed layout
const int kUnitAtlasEmissive = 3;  // not in the packed layout

const int kBindingBillboards = 1;  // storage buffers
const int kBindingActive = 2;

// Attributes when billboards are points that a geometry shader makes quads of: the record's members in their order.
const int kAttributeBillboard = 0;
const int kBillboardMembers = 9;

const int kMaxReliefTexels = 16;

// A billboard as one frame draws it. Eye space is that of the picture, the picture's axes.
struct BillboardRecord {
    vec4 centre;   // eye space, metres; w: half width of the quad
    vec4 extent;   // x: half height, y: what its depth is multiplied by, w: texels by which depth moves it
    vec4 slot;     // first texel in the atlas, texels in use
    vec4 depth;    // inverse distance when drawn = texel * x + y; z: flat: d_a - d_cc; w: unused
    vec4 texel_x;  // texel.x * w = dot(texel_x.xyz, ray) + inverse_distance * texel_x.w, ray at distance 1
    vec4 texel_y;
    vec4 texel_w;
    vec4 range;    // inverse distances now of nearest and farthest; z: of the plane
    uvec4 object;  // x: id
};

#ifdef __cplusplus
static_assert(sizeof(BillboardRecord) == 144);
}  // namespace lw::shader
#endif
