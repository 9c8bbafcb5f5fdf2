#version 450 core
// Copies a billboard's surface into the scene's G-buffer, or lights it for a picture (LIT), and corrects its depth.
// Flat: the quad's texel, as deep as it was behind or before the plane. Warped: the texel that belongs here, found along
// the pixel's ray. BLENDED: between it and the one beside it.
#include "billboard_blocks.h"
#include "billboards/blend_texels.glsl"
#include "billboards/packed_surface.glsl"
#ifdef LIT
#include "client_blocks.h"
#include "client/surface_light.glsl"
#endif

uniform float u_near_m;

layout(binding = kUnitAtlasDepth) uniform sampler2D u_depth;
#ifdef PACKED
layout(binding = kUnitAtlasSurface) uniform usampler2D u_surface;
#else
layout(binding = kUnitAtlasSurface) uniform sampler2D u_albedo_roughness;  // the shared colour where there is one
layout(binding = kUnitAtlasNormal) uniform sampler2D u_normal;
layout(binding = kUnitAtlasEmissive) uniform sampler2D u_emissive_metallic;
#endif

#ifdef WARPED
noperspective in vec3 v_texel_from_ray;
flat in vec4 v_relief;
flat in vec2 v_range;
#else
noperspective in vec2 v_texel;
#endif
flat in vec4 v_slot;
flat in vec3 v_depth;
flat in float v_nearer;  // a version that fades in lies before the one that it replaces
flat in uint v_object_id;

#ifdef LIT
layout(location = 0) out vec4 o_colour;
layout(location = 1) out uint o_object_id;
#else
layout(location = 0) out vec4 o_albedo_roughness;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_emissive_metallic;
layout(location = 3) out uint o_object_id;
#endif

// The inverse distance of a texel, counted from the slot's first one, from the eye that drew it; 0 where it is empty.
float inverse_drawn_at(ivec2 texel) {
    float stored = texelFetch(u_depth, ivec2(v_slot.xy) + texel, 0).r;
    return stored == 0.0 ? 0.0 : stored * v_depth.x + v_depth.y;
}

StoredSurface surface_at(ivec2 texel) {
    ivec2 place = ivec2(v_slot.xy) + texel;
    StoredSurface s;
#ifdef PACKED
    unpack_surface(texelFetch(u_surface, place, 0).rg, s.albedo_roughness, s.normal, s.emissive_metallic);
#elif defined(SHARED_COLOUR)
    s.normal = texelFetch(u_normal, place, 0).rg;
    split_colour(texelFetch(u_albedo_roughness, place, 0), texelFetch(u_emissive_metallic, place, 0).rg,
                 s.albedo_roughness, s.emissive_metallic);
#else
    s.albedo_roughness = texelFetch(u_albedo_roughness, place, 0);
    s.normal = texelFetch(u_normal, place, 0).rg;
    s.emissive_metallic = texelFetch(u_emissive_metallic, place, 0);
#endif
    return s;
}

#ifdef BLENDED
// Share of the depth by which two texels of one surface may differ: at a slant of 80 degrees and with texels of a third
// of 2 mrad they do by 0.004.
const float kSameDepth = 0.005;

// What lies at `place` in `texel`, and its inverse distance.
StoredSurface blended_at(ivec2 texel, vec2 place, inout float inverse_drawn) {
    float share;
    ivec2 other = texel_beside(texel, place, v_slot.zw, share);
    float inverse_other = inverse_drawn_at(other);
    if (abs(inverse_other - inverse_drawn) > kSameDepth * inverse_drawn) share = 0.0;
    inverse_drawn += share * (inverse_other - inverse_drawn);
    return blended(surface_at(texel), surface_at(other), share);
}
#endif

#ifdef WARPED
// The texel under the pixel's ray where that is at inverse distance q: with the texel at infinity, a, and how it moves,
// b, it is (a + q b).xy / (a + q b).z, and the ray is q / (a + q b).z away from the eye that drew the billboard, in
// inverse distance.
vec2 place_at(float q) {
    vec3 s = v_texel_from_ray + q * v_relief.xyz;
    return s.xy / s.z;
}

float q_of(float inverse_drawn) {
    return inverse_drawn * v_texel_from_ray.z / (1.0 - inverse_drawn * v_relief.z);
}

struct Candidate {
    ivec2 texel;
    float inverse_drawn;
    float q;  // inverse distance at which the ray would meet the texel's surface; 0: there is none
};

// What the billboard holds where the ray is at inverse distance q.
Candidate candidate_at(float q) {
    vec2 place = floor(place_at(q));
    vec2 inside = clamp(place, vec2(0.0), v_slot.zw - 1.0);
    float inverse_drawn = inverse_drawn_at(ivec2(inside));
    bool empty = inverse_drawn == 0.0 || place != inside;
    return Candidate(ivec2(inside), inverse_drawn, empty ? 0.0 : q_of(inverse_drawn));
}

// Whether the ray is within the candidate's texel where it meets the texel's surface. There is one.
bool meets_its_texel(Candidate candidate) { return ivec2(floor(place_at(candidate.q))) == candidate.texel; }

// The ray is followed from its nearest place on. What shows is a texel that lies where its own surface crosses the ray:
// without that check whatever stands before something else grows by half a texel on each side.
Candidate followed() {
    int steps = int(v_relief.w);
    float q_step = (v_range.y - v_range.x) / float(steps);
    float tolerance = 0.75 * abs(q_step);
    Candidate hit = Candidate(ivec2(0), 0.0, 0.0);
    for (int i = 0; i < steps; ++i) {
        float q_try = v_range.x + (float(i) + 0.5) * q_step;
        Candidate near_by = candidate_at(q_try);
        Candidate found = candidate_at(near_by.q);
        // Where depth moves nothing by more than a texel, the texel at mid depth is right but where the ray is in the
        // other one at its surface. What is empty there stays empty: outlines must not grow.
        if (steps == 1 && found.q > 0.0 && !meets_its_texel(found)) found = near_by;
        bool hits = near_by.q > 0.0 && found.q > 0.0 && abs(near_by.q - q_try) <= tolerance &&
                    abs(found.q - near_by.q) <= tolerance;
        if (hits && hit.q == 0.0) hit = found;
    }
    return hit;
}
#endif

void main() {
#ifdef WARPED
    Candidate hit = followed();
    if (hit.q <= 0.0) discard;
    ivec2 texel = hit.texel;
    float inverse_drawn = hit.inverse_drawn;
    vec2 place = place_at(hit.q);
#else
    ivec2 texel = ivec2(clamp(floor(v_texel), vec2(0.0), v_slot.zw - 1.0));
    float inverse_drawn = inverse_drawn_at(texel);
    if (inverse_drawn == 0.0) discard;
    vec2 place = v_texel;
#endif
#ifdef BLENDED
    StoredSurface shown = blended_at(texel, place, inverse_drawn);
#else
    StoredSurface shown = surface_at(texel);
#endif
#ifdef WARPED
    float depth = u_near_m * q_of(inverse_drawn);
#else
    float distance_m = 1.0 / inverse_drawn + v_depth.z;
    if (distance_m < u_near_m) discard;
    float depth = u_near_m / distance_m;
#endif

    gl_FragDepth = depth * v_nearer;
    o_object_id = v_object_id;
#ifdef LIT
    o_colour = vec4(lit_surface(shown.albedo_roughness, shown.normal, shown.emissive_metallic, depth), 1.0);
#else
    o_albedo_roughness = shown.albedo_roughness;
    o_normal = shown.normal;
    o_emissive_metallic = shown.emissive_metallic;
#endif
}
