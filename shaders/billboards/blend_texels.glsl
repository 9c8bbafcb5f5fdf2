// What lies between the centres of two texels of a billboard is between what they hold.

struct StoredSurface {
    vec4 albedo_roughness;
    vec2 normal;
    vec4 emissive_metallic;
};

// Rounding must not blend what is seen from where it was drawn: there the pixels' centres are texels' centres.
const float kAtCentre = 0.01;

// The texel beside `texel` towards `place`, both counted from the slot's first one and within its `size`, and how much
// of it shows: nothing at the centre of `texel`, half at its edge.
ivec2 texel_beside(ivec2 texel, vec2 place, vec2 size, out float share) {
    vec2 off = clamp(place - (vec2(texel) + 0.5), vec2(-0.5), vec2(0.5));
    vec2 far = abs(off);
    vec2 towards = far.x > far.y ? vec2(sign(off.x), 0.0) : vec2(0.0, sign(off.y));
    share = max(far.x, far.y);
    if (share < kAtCentre) share = 0.0;
    return ivec2(clamp(vec2(texel) + towards, vec2(0.0), size - 1.0));
}

// Not over creases, where normals part (nor over the fold of the octahedron, on whose sides equal normals are stored
// apart), nor over the edge of a metal or of what is unlit. Differences are added, so that what is equal stays so.
StoredSurface blended(StoredSurface s, StoredSurface other, float share) {
    vec2 turn = abs(other.normal - s.normal);
    float metal = abs(other.emissive_metallic.a - s.emissive_metallic.a);
    if (max(turn.x, turn.y) > 0.25 || metal > 0.5) share = 0.0;
    return StoredSurface(s.albedo_roughness + share * (other.albedo_roughness - s.albedo_roughness),
                   s.normal + share * (other.normal - s.normal),
                   s.emissive_metallic + share * (other.emissive_metallic - s.emissive_metallic));
}
