// How large the point of a source pixel must be so that its surface has no cracks in the target: half the row sums of
// the absolute Jacobian d(target px) / d(source px). The CPU's twin is warp_server/methods/splat_footprint.h.
// Needs warp/source_layer.glsl and a uniform source_size_px.

const float kLargestHalfExtentPx = 2.0;
const float kSameSurfaceDepthPart = 0.03;
const float kClearlySmallerDepthPart = 1.0 / 1024.0;
const float kOtherSurface = 8.0;  // farther from any depth than that part

float neighbour_depth(ivec2 at, uint object_id) {
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, source_size_px))) return kOtherSurface;
    if (texelFetch(source_object_id, at, 0).r != object_id) return kOtherSurface;
    float depth = texelFetch(source_depth, at, 0).r;
    return is_usable_depth(depth) ? depth : kOtherSurface;
}

// The difference to the pixel after, or to the one before where that is clearly smaller: beside an edge it is the one
// that stays on the surface.
float one_sided_difference(float depth, float before, float after) {
    float to_before = depth - before;
    float to_after = after - depth;
    bool before_is_smaller = abs(to_before) + kClearlySmallerDepthPart * depth < abs(to_after);
    float chosen = before_is_smaller ? to_before : to_after;
    return abs(chosen) < kSameSurfaceDepthPart * depth ? chosen : 0.0;
}

// `h` is where the pixel goes, (x, y, w) homogeneous.
vec2 half_extent_px(WarpObject object, ivec2 at, uint object_id, float depth, vec3 h) {
    vec2 gradient = vec2(one_sided_difference(depth, neighbour_depth(at - ivec2(1, 0), object_id),
                                              neighbour_depth(at + ivec2(1, 0), object_id)),
                         one_sided_difference(depth, neighbour_depth(at - ivec2(0, 1), object_id),
                                              neighbour_depth(at + ivec2(0, 1), object_id)));
    vec3 along_x = object.x.xyz + gradient.x * object.z.xyz;
    vec3 along_y = object.y.xyz + gradient.y * object.z.xyz;
    vec2 place = h.xy / h.z;
    vec2 jacobian_x = (along_x.xy - place * along_x.z) / h.z;
    vec2 jacobian_y = (along_y.xy - place * along_y.z) / h.z;
    return clamp(0.5 * (abs(jacobian_x) + abs(jacobian_y)), 0.5, kLargestHalfExtentPx);
}
