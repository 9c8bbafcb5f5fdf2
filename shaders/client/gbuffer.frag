#version 450 core
#include "client_blocks.h"
#include "client/octahedral.glsl"

in vec3 v_normal_relative;
flat in uint v_object_id;
#ifdef VERTEX_COLOUR
in vec4 v_colour;
#endif
#ifdef TEXTURED
in vec2 v_uv;
#endif
#ifdef BASE_COLOUR_TEXTURE
layout(binding = kUnitBaseColour) uniform sampler2D u_base_colour;
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
layout(binding = kUnitMetallicRoughness) uniform sampler2D u_metallic_roughness;
#endif
#ifdef NORMAL_TEXTURE
in vec4 v_tangent_relative;
layout(binding = kUnitNormal) uniform sampler2D u_normal;
#endif
#ifdef EMISSIVE_TEXTURE
layout(binding = kUnitEmissive) uniform sampler2D u_emissive;
#endif

#ifdef PART
layout(binding = kUnitBehind) uniform sampler2D u_behind;
#endif

#if defined(PACKED) || defined(SHARED_COLOUR)
#include "billboards/packed_surface.glsl"
#endif
#ifdef PACKED
layout(location = 0) out uvec2 o_packed;
#else
layout(location = 0) out vec4 o_albedo_roughness;
layout(location = 1) out vec2 o_normal;
layout(location = 2) out vec4 o_emissive_metallic;
#ifndef BILLBOARD
layout(location = 3) out uint o_object_id;
#endif
#endif

#ifdef TEXTURED
vec2 uv_of(int unit) {
    vec3 uv1 = vec3(v_uv, 1.0);
    return vec2(dot(material.uv_rows[2 * unit].xyz, uv1), dot(material.uv_rows[2 * unit + 1].xyz, uv1));
}
#endif

#ifdef PART
bool is_left_out() {
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_per_px_x.xyz + gl_FragCoord.y * frame.ray_per_px_y.xyz;
    float distance_m = length(ray) * frame.near_m.x / gl_FragCoord.z;
    bool in_range = distance_m >= frame.part.x && distance_m < frame.part.y;
    if (v_object_id == 0u && !in_range) return true;
    int samples = int(frame.part.z);
    if (samples == 0) return false;
    // The last tiles of a picture reach beyond it.
    ivec2 pixel = min(frame.tiles.yz + ivec2(gl_FragCoord.xy) / samples, textureSize(u_behind, 0) - 1);
    return gl_FragCoord.z >= texelFetch(u_behind, pixel, 0).r;
}
#endif

void main() {
#ifdef PART
    if (is_left_out()) discard;
#endif
    vec4 base_colour = material.base_colour;
#ifdef VERTEX_COLOUR
    base_colour *= v_colour;
#endif
#ifdef BASE_COLOUR_TEXTURE
    base_colour *= texture(u_base_colour, uv_of(kUnitBaseColour));
#endif
#ifdef ALPHA_MASK
    if (base_colour.a < material.factors.w) discard;
#endif

    vec2 metallic_roughness = material.factors.xy;
#ifdef METALLIC_ROUGHNESS_TEXTURE
    metallic_roughness *= texture(u_metallic_roughness, uv_of(kUnitMetallicRoughness)).bg;
#endif

    vec3 emissive = material.emissive.rgb;
#ifdef EMISSIVE_TEXTURE
    emissive *= texture(u_emissive, uv_of(kUnitEmissive)).rgb;
#endif

    vec3 normal = normalize(v_normal_relative);
#ifdef NORMAL_TEXTURE
    vec3 tangent = v_tangent_relative.xyz - normal * dot(normal, v_tangent_relative.xyz);
    tangent *= inversesqrt(max(dot(tangent, tangent), 1e-20));
    vec3 bitangent = cross(normal, tangent) * v_tangent_relative.w;
    vec3 bump = texture(u_normal, uv_of(kUnitNormal)).xyz * 2.0 - 1.0;
    bump.xy *= material.factors.z;
    normal = normalize(tangent * bump.x + bitangent * bump.y + normal * max(bump.z, 1e-3));
#endif
#ifdef DOUBLE_SIDED
    if (!gl_FrontFacing) normal = -normal;
#endif

#ifdef UNLIT
    // Its colour is all it emits; without albedo and as a metal nothing else is reflected.
    emissive = base_colour.rgb;
    base_colour.rgb = vec3(0.0);
    metallic_roughness = vec2(1.0);
#endif

    // Square roots spend the 8 bits about as evenly as the eye does, and are cheap.
    vec4 albedo_roughness = vec4(sqrt(clamp(base_colour.rgb, 0.0, 1.0)), metallic_roughness.y);
    vec2 stored_normal = octahedral_from_unit(normal) * 0.5 + 0.5;
    vec4 emissive_metallic = vec4(sqrt(clamp(emissive, 0.0, 1.0)), metallic_roughness.x);
#ifdef PACKED
    o_packed = packed_surface(albedo_roughness, stored_normal, emissive_metallic);
#elif defined(SHARED_COLOUR)
    float share;
    o_albedo_roughness = shared_colour(albedo_roughness, emissive_metallic, share);
    o_normal = stored_normal;
    o_emissive_metallic = vec4(emissive_metallic.a, share, 0.0, 0.0);
#else
    o_albedo_roughness = albedo_roughness;
    o_normal = stored_normal;
    o_emissive_metallic = emissive_metallic;
#ifndef BILLBOARD
    o_object_id = v_object_id;
#endif
#endif
}
