// Light of one surface pixel: sun, sky and point lights. GGX with the Smith-Schlick terms of glTF's metallic-roughness
// model (Khronos, glTF 2.0, appendix B). Wants client_blocks.h before it.
#include "client/octahedral.glsl"
#include "client/srgb.glsl"
#include "client/sky.glsl"
#include "client/tone.glsl"

#ifdef POINT_LIGHTS
layout(std430, binding = kBindingTiles) readonly buffer Tiles { uvec2 tile_lights[]; };
#endif

struct Surface {
    vec3 normal;
    vec3 to_eye;
    vec3 diffuse;   // albedo of the dielectric part, over pi
    vec3 specular;  // reflectance at normal incidence
    float alpha;    // roughness squared
    float n_eye;
};

// Radiance towards the eye per unit of irradiance on a surface that faces the light.
vec3 reflected(Surface s, vec3 to_light) {
    vec3 half_way = normalize(to_light + s.to_eye);
    float n_light = clamp(dot(s.normal, to_light), 0.0, 1.0);
    float n_half = clamp(dot(s.normal, half_way), 0.0, 1.0);
    float eye_half = clamp(dot(s.to_eye, half_way), 0.0, 1.0);
    float a2 = s.alpha * s.alpha;
    float d = n_half * n_half * (a2 - 1.0) + 1.0;
    float distribution = a2 / (3.14159265 * d * d);
    // Height-correlated Smith, after Hammon, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", GDC 2017.
    float visibility = 0.5 / max(mix(2.0 * n_light * s.n_eye, n_light + s.n_eye, s.alpha), 1e-4);
    float grazing = 1.0 - eye_half;
    float grazing2 = grazing * grazing;
    // Black reflects nothing at grazing angles either.
    float f90 = clamp(50.0 * s.specular.g, 0.0, 1.0);
    vec3 fresnel = s.specular + (f90 - s.specular) * (grazing2 * grazing2 * grazing);
    return n_light * (s.diffuse * (1.0 - fresnel) + fresnel * min(distribution * visibility, 64.0));
}

// Sky and ground seen in the surface, with the polynomial fit of the split sum (Karis, "Physically Based Shading on
// Mobile", 2014).
vec3 ambient(Surface s, float roughness) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * s.n_eye)) * r.x + r.y;
    vec2 scale_bias = vec2(-1.04, 1.04) * a004 + r.zw;
    float f90 = clamp(50.0 * s.specular.g, 0.0, 1.0);
    vec3 mirror = reflect(-s.to_eye, s.normal);
    vec3 mirrored = mix(sky_radiance(mirror), ambient_radiance(mirror), clamp(1.5 * roughness, 0.0, 1.0));
    vec3 diffuse = s.diffuse * 3.14159265 * ambient_radiance(s.normal);
    return diffuse + mirrored * (s.specular * scale_bias.x + f90 * scale_bias.y);
}

#ifdef POINT_LIGHTS
vec3 from_point_lights(Surface s, vec3 position_relative, ivec2 pixel) {
    uvec2 mask = tile_lights[(pixel.y / kLightTilePx) * frame.tiles.x + pixel.x / kLightTilePx];
    vec3 sum = vec3(0.0);
    while ((mask.x | mask.y) != 0u) {
        bool in_low = mask.x != 0u;
        int light = in_low ? findLSB(mask.x) : 32 + findLSB(mask.y);
        if (in_low) {
            mask.x &= mask.x - 1u;
        } else {
            mask.y &= mask.y - 1u;
        }
        vec4 position_range = lights.position_range[light];
        vec3 to_light = position_range.xyz - position_relative;
        float distance2 = max(dot(to_light, to_light), 1e-4);
        // Fades to zero at the range, as KHR_lights_punctual recommends: exactly zero beyond, so tiles do not show.
        float ratio2 = distance2 / (position_range.w * position_range.w);
        float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
        sum += reflected(s, to_light * inversesqrt(distance2)) * lights.intensity[light].rgb * (window / distance2);
    }
    return sum;
}
#endif

// What the display gets of a surface, encoded. The first three as the G-buffer holds them; `depth` is the pixel's.
vec3 lit_surface(vec4 albedo_roughness, vec2 stored_normal, vec4 emissive_metallic, float depth) {
    float distance_m = frame.near_m.x / depth;
    vec3 ray = frame.ray_origin.xyz + gl_FragCoord.x * frame.ray_per_px_x.xyz + gl_FragCoord.y * frame.ray_per_px_y.xyz;

    vec3 albedo = albedo_roughness.rgb * albedo_roughness.rgb;
    float metallic = emissive_metallic.a;
    float roughness = max(albedo_roughness.a, 0.08);  // below, highlights are smaller than a pixel and flicker
    Surface s;
    s.normal = unit_from_octahedral(stored_normal * 2.0 - 1.0);
    s.to_eye = -normalize(ray);
    s.diffuse = albedo * ((1.0 - metallic) * (1.0 / 3.14159265));
    s.specular = mix(vec3(0.04), albedo, metallic);
    s.alpha = roughness * roughness;
    s.n_eye = clamp(dot(s.normal, s.to_eye), 0.001, 1.0);

    vec3 radiance = emissive_metallic.rgb * emissive_metallic.rgb;
    radiance += reflected(s, frame.sun_direction.xyz) * frame.sun_irradiance.rgb;
    radiance += ambient(s, roughness);
#ifdef POINT_LIGHTS
    radiance += from_point_lights(s, ray * distance_m, ivec2(gl_FragCoord.xy));
#endif
    // An unlit surface is shown as it is. No lit one is stored like that but a rough black metal, which shows the same.
    bool unlit = albedo_roughness == vec4(0.0, 0.0, 0.0, 1.0) && metallic == 1.0;
    vec3 shown = unlit ? emissive_metallic.rgb * emissive_metallic.rgb : displayed(radiance);
    return srgb_from_linear(shown);
}
