// A corner of a billboard's quad, for every way of making quads.
uniform vec4 u_ndc_from_tangent;  // scale, offset

#ifdef WARPED
noperspective out vec3 v_texel_from_ray;
flat out vec4 v_relief;  // texel = (texel_from_ray + q * xyz).xy / .z at inverse distance q; w: texels it moves
flat out vec2 v_range;
#else
noperspective out vec2 v_texel;
#endif
// What a fragment needs of its billboard travels as constants of the quad: a software GL reads a storage buffer lane by
// lane.
flat out vec4 v_slot;
flat out vec3 v_depth;
flat out float v_nearer;
flat out uint v_object_id;

void emit_corner(BillboardRecord billboard, vec2 corner) {
    vec3 position_eye = billboard.centre.xyz + vec3(corner * vec2(billboard.centre.w, billboard.extent.x), 0.0);
    float distance_m = -position_eye.z;
    // Every pixel's depth is written by the fragment shader; this one only keeps the quad from being clipped.
    gl_Position = vec4(u_ndc_from_tangent.xy * position_eye.xy + u_ndc_from_tangent.zw * distance_m, 0.0, distance_m);
#ifdef WARPED
    vec3 ray = vec3(position_eye.xy / distance_m, -1.0);
    v_texel_from_ray = vec3(dot(billboard.texel_x.xyz, ray), dot(billboard.texel_y.xyz, ray),
                            dot(billboard.texel_w.xyz, ray));
    v_relief = vec4(billboard.texel_x.w, billboard.texel_y.w, billboard.texel_w.w, billboard.extent.w);
    v_range = billboard.range.xy;
#else
    v_texel = (vec2(corner.x, -corner.y) * 0.5 + 0.5) * billboard.slot.zw;
#endif
    v_slot = billboard.slot;
    v_depth = billboard.depth.xyz;
    v_nearer = billboard.extent.y;
    v_object_id = billboard.object.x;
}
