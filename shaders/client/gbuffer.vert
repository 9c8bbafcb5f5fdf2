#version 450 core
#include "client_blocks.h"
#include "billboard_blocks.h"

layout(location = kAttributePosition) in vec3 a_position_object;
layout(location = kAttributeNormal) in vec4 a_normal_object;
layout(location = kAttributeRow0) in vec4 a_row0;
layout(location = kAttributeRow1) in vec4 a_row1;
layout(location = kAttributeRow2) in vec4 a_row2;
layout(location = kAttributeObjectId) in uint a_object_id;

#ifdef BILLBOARD
layout(location = kAttributeViewX) in vec4 a_view_x;
layout(location = kAttributeViewY) in vec4 a_view_y;
layout(location = kAttributeViewW) in vec4 a_view_w;
#endif

out vec3 v_normal_relative;
flat out uint v_object_id;
#ifdef VERTEX_COLOUR
layout(location = kAttributeColour) in vec4 a_colour;
out vec4 v_colour;
#endif
#ifdef TEXTURED
layout(location = kAttributeUv) in vec2 a_uv;
out vec2 v_uv;
#endif
#ifdef NORMAL_TEXTURE
layout(location = kAttributeTangent) in vec3 a_tangent_object;
out vec4 v_tangent_relative;
#endif

void main() {
    vec4 position_object = vec4(a_position_object, 1.0);
    vec3 position_relative =
        vec3(dot(a_row0, position_object), dot(a_row1, position_object), dot(a_row2, position_object));
#ifdef BILLBOARD
    // The billboard's own frustum, on its slot, with a depth range of its own.
    float distance_m = dot(a_view_w.xyz, position_relative);
    gl_Position = vec4(dot(a_view_x.xyz, position_relative), dot(a_view_y.xyz, position_relative),
                       a_view_x.w + a_view_y.w * distance_m, distance_m);
#else
    gl_Position = vec4(dot(frame.clip_x.xyz, position_relative), dot(frame.clip_y.xyz, position_relative),
                       frame.near_m.x, dot(frame.clip_w.xyz, position_relative));
#endif

    // Normals take the cofactors of the linear part: right for any scale, and for mirrored objects up to the sign.
    vec3 column_x = vec3(a_row0.x, a_row1.x, a_row2.x);
    vec3 column_y = vec3(a_row0.y, a_row1.y, a_row2.y);
    vec3 column_z = vec3(a_row0.z, a_row1.z, a_row2.z);
    vec3 yz = cross(column_y, column_z);
    vec3 normal = yz * a_normal_object.x + cross(column_z, column_x) * a_normal_object.y +
                  cross(column_x, column_y) * a_normal_object.z;
    float mirrored = dot(column_x, yz) < 0.0 ? -1.0 : 1.0;
    v_normal_relative = normal * mirrored;
    v_object_id = a_object_id;
#ifdef VERTEX_COLOUR
    v_colour = a_colour;
#endif
#ifdef TEXTURED
    v_uv = a_uv;
#endif
#ifdef NORMAL_TEXTURE
    v_tangent_relative = vec4(column_x * a_tangent_object.x + column_y * a_tangent_object.y +
                                  column_z * a_tangent_object.z,
                              a_normal_object.w * mirrored);
#endif
}
