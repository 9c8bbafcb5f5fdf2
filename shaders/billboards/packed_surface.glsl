// A surface whose albedo and emission share one colour and say by how much: exact where either is black (what does not
// glow, and what is unlit), otherwise a glow takes the hue of its surface.

// The shared colour and the roughness; `share` is that of the emission.
vec4 shared_colour(vec4 albedo_roughness, vec4 emissive_metallic, out float share) {
    vec3 albedo = albedo_roughness.rgb * albedo_roughness.rgb;
    vec3 emissive = emissive_metallic.rgb * emissive_metallic.rgb;
    vec3 sum = albedo + emissive;
    share = dot(emissive, vec3(1.0)) / max(dot(sum, vec3(1.0)), 1e-6);
    return vec4(sqrt(min(sum, 1.0)), albedo_roughness.a);
}

void split_colour(vec4 colour_roughness, vec2 metallic_share, out vec4 albedo_roughness, out vec4 emissive_metallic) {
    albedo_roughness = vec4(colour_roughness.rgb * sqrt(1.0 - metallic_share.y), colour_roughness.a);
    emissive_metallic = vec4(colour_roughness.rgb * sqrt(metallic_share.y), metallic_share.x);
}

// In eight bytes: normals of ten bits an axis, metalness and share of six.
uvec2 packed_surface(vec4 albedo_roughness, vec2 normal, vec4 emissive_metallic) {
    float share;
    vec4 colour_roughness = shared_colour(albedo_roughness, emissive_metallic, share);
    uvec4 low = uvec4(vec4(clamp(normal, 0.0, 1.0) * 1023.0, emissive_metallic.a * 63.0, share * 63.0) + 0.5);
    return uvec2(packUnorm4x8(colour_roughness), low.x | low.y << 10 | low.z << 20 | low.w << 26);
}

void unpack_surface(uvec2 stored, out vec4 albedo_roughness, out vec2 normal, out vec4 emissive_metallic) {
    normal = vec2(uvec2(stored.y, stored.y >> 10) & 1023u) * (1.0 / 1023.0);
    vec2 metallic_share = vec2(uvec2(stored.y >> 20, stored.y >> 26) & 63u) * (1.0 / 63.0);
    split_colour(unpackUnorm4x8(stored.x), metallic_share, albedo_roughness, emissive_metallic);
}
