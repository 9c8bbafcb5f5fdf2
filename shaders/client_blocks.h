#pragma once
// What the client's shaders and their C++ side agree on: locations, binding numbers, block layouts. Both languages
// include this file. Blocks are std140 and made of 16-byte members, so both sides lay them out the same way; a test
// compares the offsets.
//
// "Relative" space: oriented as the world, its origin in the eye; so that float positions keep their precision however
// far the eye is from the world's origin.

#ifdef __cplusplus
#include <glm/glm.hpp>

#define LW_BLOCK(NAME, BINDING) struct alignas(16) NAME
#define LW_BLOCK_END(INSTANCE)

namespace lw::shader {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
#else
#define LW_BLOCK(NAME, BINDING) layout(std140, binding = BINDING) uniform NAME
#define LW_BLOCK_END(INSTANCE) INSTANCE
#endif

// Vertex attributes: per vertex, then per instance.
const int kAttributePosition = 0;
const int kAttributeNormal = 1;  // w is the tangent's handedness
const int kAttributeColour = 2;
const int kAttributeUv = 3;
const int kAttributeTangent = 4;
const int kAttributeRow0 = 5;  // rows of relative_from_object, 3x4
const int kAttributeRow1 = 6;
const int kAttributeRow2 = 7;
const int kAttributeObjectId = 8;

// Texture units of the G-buffer pass.
const int kUnitBaseColour = 0;
const int kUnitMetallicRoughness = 1;
const int kUnitNormal = 2;
const int kUnitEmissive = 3;
const int kUnitBehind = 4;  // of a part of the scene: depths at and beyond which nothing is drawn

// Texture units of the full-screen passes.
const int kUnitGAlbedo = 0;    // sqrt(albedo), roughness
const int kUnitGNormal = 1;    // octahedral, relative space, 0.5 * n + 0.5
const int kUnitGEmissive = 2;  // sqrt(emissive), metallic
const int kUnitGDepth = 3;
const int kUnitSource = 0;        // of a copy or an average
const int kUnitSampleColour = 0;  // of the resolve per surface
const int kUnitSampleDepth = 1;
const int kUnitSampleId = 2;
const int kAttributeSkyCorner = 0;

const int kBindingFrame = 0;
const int kBindingMaterial = 1;
const int kBindingLights = 2;
const int kBindingTiles = 0;  // storage buffer

const int kMaxLights = 64;  // one bit each in a tile's mask
const int kLightTilePx = 32;

// The sky. Its parts are told apart where they are drawn and before.
const float kHorizonBlend = 0.06f;  // sine of the depression at which the ground is all there is
const float kSunGlow = 0.04f;       // of the sun's irradiance, by the eighth power of the cosine of the angle to it
const float kSunHalo = 0.12f;       // by the 96th

LW_BLOCK(FrameBlock, kBindingFrame) {
    vec4 clip_x;  // clip.x = dot(clip_x.xyz, position_relative), and so on; clip.z is near_m
    vec4 clip_y;
    vec4 clip_w;
    vec4 ray_origin;  // ray_relative = ray_origin + x_px * ray_per_px_x + y_px * ray_per_px_y, at distance_m = 1
    vec4 ray_per_px_x;
    vec4 ray_per_px_y;
    vec4 sun_direction;   // relative, towards the sun, unit
    vec4 sun_irradiance;  // linear
    vec4 near_m;          // x
    ivec4 tiles;          // x: light tiles per row; y, z: the layer's pixel at which the picture being drawn begins
    vec4 part;            // x, y: range of static surfaces drawn, metres along the ray; z: samples per limit, or 0
}
LW_BLOCK_END(frame);

LW_BLOCK(MaterialBlock, kBindingMaterial) {
    vec4 base_colour;  // linear
    vec4 emissive;     // linear; w: 1 when unlit
    vec4 factors;      // metallic, roughness, normal scale, alpha cutoff
    vec4 uv_rows[8];   // two rows of the uv transform (xyz) per texture unit of the G-buffer pass
}
LW_BLOCK_END(material);

LW_BLOCK(LightsBlock, kBindingLights) {
    vec4 position_range[kMaxLights];  // relative; w: range in metres
    vec4 intensity[kMaxLights];       // linear
}
LW_BLOCK_END(lights);

#ifdef __cplusplus
}  // namespace lw::shader
#endif
