#version 450 core
// Copies a billboard's surface into the scene's G-buffer, or lights it for a picture (LIT), and corrects its depth. Flat: the quad's texel, as deep as it
// was behind or before the plane. Warped: the texel that belongs here, found along the pixel's ray.
#include "billboard_blocks.h"
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

#ifdef WARPED
struct Candidate {
    ivec2 texel;
    float q;  // inverse distance at which the ray would meet the texel's surface; 0: there is none
};

// What the billboard holds where the pixel's ray is at inverse distance q. With the texel under the ray at infinity, a,
// and how it moves, b: texel = (a + q b).xy / (a + q b).z, and the ray is q / (a + q b).z away from the eye that drew
// the billboard, in inverse distance.
Candidate candidate_at(float q) {
    vec3 a = v_texel_from_ray;
    vec3 b = v_relief.xyz;
    vec3 s = a + q * b;
    vec2 place = floor(s.xy / s.z);
    vec2 inside = clamp(place, vec2(0.0), v_slot.zw - 1.0);
    ivec2 texel = ivec2(v_slot.xy + inside);
    float stored = texelFetch(u_depth, texel, 0).r;
    float inverse_drawn = stored * v_depth.x + v_depth.y;
    bool empty = stored == 0.0 || place != inside;
    return Candidate(texel, empty ? 0.0 : inverse_drawn * a.z / (1.0 - inverse_drawn * b.z));
}

// Whether the ray is within the candidate's texel where it meets the texel's surface. There is one.
bool meets_its_texel(Candidate candidate) {
    vec3 s = v_texel_from_ray + candidate.q * v_relief.xyz;
    return ivec2(v_slot.xy + floor(s.xy / s.z)) == candidate.texel;
}
#endif

void read_surface(ivec2 texel, out vec4 albedo_roughness, out vec2 normal, out vec4 emissive_metallic) {
#ifdef PACKED
    unpack_surface(texelFetch(u_surface, texel, 0).rg, albedo_roughness, normal, emissive_metallic);
#elif defined(SHARED_COLOUR)
    normal = texelFetch(u_normal, texel, 0).rg;
    split_colour(texelFetch(u_albedo_roughness, texel, 0), texelFetch(u_emissive_metallic, texel, 0).rg,
                 albedo_roughness, emissive_metallic);
#else
    albedo_roughness = texelFetch(u_albedo_roughness, texel, 0);
    normal = texelFetch(u_normal, texel, 0).rg;
    emissive_metallic = texelFetch(u_emissive_metallic, texel, 0);
#endif
}

void main() {
#ifdef WARPED
    // The ray is followed from its nearest place on. What shows is a texel that lies where its own surface crosses the
    // ray: without that check whatever stands before something else grows by half a texel on each side.
    int steps = int(v_relief.w);
    float q_step = (v_range.y - v_range.x) / float(steps);
    float tolerance = 0.75 * abs(q_step);
    float q = 0.0;
    ivec2 texel = ivec2(0);
    for (int i = 0; i < steps; ++i) {
        float q_try = v_range.x + (float(i) + 0.5) * q_step;
        Candidate near_by = candidate_at(q_try);
        Candidate found = candidate_at(near_by.q);
        // Where depth moves nothing by more than a texel, the texel at mid depth is right but where the ray is in the
        // other one at its surface. What is empty there stays empty: outlines must not grow.
        if (steps == 1 && found.q > 0.0 && !meets_its_texel(found)) found = near_by;
        bool hit = near_by.q > 0.0 && found.q > 0.0 && abs(near_by.q - q_try) <= tolerance &&
                   abs(found.q - near_by.q) <= tolerance;
        if (hit && q == 0.0) {
            q = found.q;
            texel = found.texel;
        }
    }
    if (q <= 0.0) discard;
    float depth = u_near_m * q;
#else
    ivec2 texel = ivec2(v_slot.xy + clamp(floor(v_texel), vec2(0.0), v_slot.zw - 1.0));
    float stored = texelFetch(u_depth, texel, 0).r;
    if (stored == 0.0) discard;
    float distance_m = 1.0 / (stored * v_depth.x + v_depth.y) + v_depth.z;
    if (distance_m < u_near_m) discard;
    float depth = u_near_m / distance_m;
#endif

    gl_FragDepth = depth * v_nearer;
    o_object_id = v_object_id;
#ifdef LIT
    vec4 albedo_roughness;
    vec2 normal;
    vec4 emissive_metallic;
    read_surface(texel, albedo_roughness, normal, emissive_metallic);
    o_colour = vec4(lit_surface(albedo_roughness, normal, emissive_metallic, depth), 1.0);
#else
    read_surface(texel, o_albedo_roughness, o_normal, o_emissive_metallic);
#endif
}
