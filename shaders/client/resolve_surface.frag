#version 450 core
// One pixel from SAMPLES x SAMPLES samples, all of one surface: that of the sample with the median depth. A mean over
// several surfaces would travel with a depth that none of them has, as a halo. Alpha is the share of the samples that
// are on it. With QUARTERS it draws instead, at twice the size, what the same surface shows in each quarter of the pixel.
#include "client_blocks.h"
#include "client/srgb.glsl"

layout(binding = kUnitSampleColour) uniform sampler2D u_colour;
layout(binding = kUnitSampleDepth) uniform sampler2D u_depth;
layout(binding = kUnitSampleId) uniform usampler2D u_object_id;
uniform ivec2 u_first_px;  // pixel of the layer that the first samples belong to

layout(location = 0) out vec4 o_colour;
#ifndef QUARTERS
layout(location = 1) out float o_depth;
layout(location = 2) out uint o_object_id;
#endif

const int kSamples = SAMPLES * SAMPLES;
// Of the depth: what lies this close to a sample's plane is on its surface. At 1 m that is 1 cm: less than what shows
// by parallax between display frames, more than what curvature and creases do within a pixel.
const float kSameSurface = 0.01;

float depths[kSamples];
uint ids[kSamples];

ivec2 sample_of(ivec2 first, int i) {
    return first + ivec2(i % SAMPLES, i / SAMPLES);
}

// Rank (count - 1) / 2 from the nearest on: of two surfaces that share the pixel evenly the nearer one shows, so that
// thin things keep their pixels.
int median_sample() {
    for (int i = 0; i < kSamples; ++i) {
        int nearer = 0;
        for (int j = 0; j < kSamples; ++j) {
            nearer += depths[j] > depths[i] || (depths[j] == depths[i] && j < i) ? 1 : 0;
        }
        if (nearer == (kSamples - 1) / 2) return i;
    }
    return 0;
}

struct Neighbour {
    float depth;
    bool usable;  // of the same object, and no background
};

Neighbour neighbour(ivec2 place, uint id) {
    ivec2 inside = clamp(place, ivec2(0), textureSize(u_depth, 0) - 1);
    float depth = texelFetch(u_depth, inside, 0).r;
    return Neighbour(depth, inside == place && depth > 0.0 && texelFetch(u_object_id, inside, 0).r == id);
}

// Change of depth per sample along `step`. Three samples of one plane have no second difference; of the three triples
// that contain `place` the straightest one counts, if it is straight at all.
float slope(ivec2 place, ivec2 step, float depth, uint id) {
    Neighbour before2 = neighbour(place - 2 * step, id);
    Neighbour before = neighbour(place - step, id);
    Neighbour after = neighbour(place + step, id);
    Neighbour after2 = neighbour(place + 2 * step, id);
    float straightest = kSameSurface * depth;
    float result = 0.0;
    float bend = abs(before.depth - 2.0 * depth + after.depth);
    if (before.usable && after.usable && bend < straightest) {
        straightest = bend;
        result = 0.5 * (after.depth - before.depth);
    }
    bend = abs(before2.depth - 2.0 * before.depth + depth);
    if (before2.usable && before.usable && bend < straightest) {
        straightest = bend;
        result = depth - before.depth;
    }
    bend = abs(depth - 2.0 * after.depth + after2.depth);
    if (after.usable && after2.usable && bend < straightest) result = after.depth - depth;
    return result;
}

void main() {
#ifdef QUARTERS
    ivec2 quarter = ivec2(gl_FragCoord.xy) & 1;
    vec3 quarter_colour = vec3(0.0);
    float quarter_count = 0.0;
    ivec2 first = ((ivec2(gl_FragCoord.xy) >> 1) - u_first_px) * SAMPLES;
#else
    ivec2 first = (ivec2(gl_FragCoord.xy) - u_first_px) * SAMPLES;
#endif
    float nearest = 0.0;
    float farthest = 2.0;
    bool one_object = true;
    for (int i = 0; i < kSamples; ++i) {
        depths[i] = texelFetch(u_depth, sample_of(first, i), 0).r;
        ids[i] = texelFetch(u_object_id, sample_of(first, i), 0).r;
        nearest = max(nearest, depths[i]);
        farthest = min(farthest, depths[i]);
        one_object = one_object && ids[i] == ids[0];
    }

    // Most pixels hold one surface, seen so evenly that neither a median nor a plane is needed to tell.
    int median = 0;
    vec2 gradient = vec2(0.0);
    bool one_surface = one_object && nearest - farthest <= kSameSurface * farthest;
#ifdef QUARTERS
    if (one_surface) {
        ivec2 first_of_quarter = first + quarter * (SAMPLES / 2);
        for (int y = 0; y < SAMPLES / 2; ++y) {
            for (int x = 0; x < SAMPLES / 2; ++x) {
                quarter_colour += texelFetch(u_colour, first_of_quarter + ivec2(x, y), 0).rgb;
            }
        }
        o_colour = vec4(srgb_from_linear(quarter_colour * (4.0 / float(kSamples))), 1.0);
        return;
    }
#endif
    if (!one_surface) {
        median = median_sample();
        if (depths[median] > 0.0) {
            ivec2 place = sample_of(first, median);
            gradient = vec2(slope(place, ivec2(1, 0), depths[median], ids[median]),
                            slope(place, ivec2(0, 1), depths[median], ids[median]));
        }
    }

#ifndef QUARTERS
    vec3 colour = vec3(0.0);
    float off_plane = 0.0;
    float count = 0.0;
#endif
    for (int i = 0; i < kSamples; ++i) {
        ivec2 offset = sample_of(ivec2(0), i) - sample_of(ivec2(0), median);
        float difference = depths[i] - depths[median] - dot(gradient, vec2(offset));
        // Background is flat: its tolerance is zero, and it is on no surface but its own.
        bool on_surface = ids[i] == ids[median] && (depths[i] > 0.0) == (depths[median] > 0.0) &&
                          abs(difference) <= kSameSurface * depths[median];
#ifdef QUARTERS
        if (sample_of(ivec2(0), i) / (SAMPLES / 2) != quarter) continue;
        quarter_colour += texelFetch(u_colour, sample_of(first, i), 0).rgb;
        quarter_count += on_surface ? 1.0 : 0.0;
#else
        if (one_surface || on_surface) {
            colour += texelFetch(u_colour, sample_of(first, i), 0).rgb;
            off_plane += difference;
            count += 1.0;
        }
#endif
    }
#ifdef QUARTERS
    o_colour = vec4(srgb_from_linear(quarter_colour * (4.0 / float(kSamples))), quarter_count * (4.0 / float(kSamples)));
#else
    // The mean plane at the pixel's centre, wherever the samples on it lie: depth stays affine on planes.
    vec2 to_centre = 0.5 * float(SAMPLES - 1) - vec2(sample_of(ivec2(0), median));
    float depth = depths[median] + off_plane / count + dot(gradient, to_centre);
    // A centre beyond the horizon of the plane, or nearer than the near plane, has no depth of it.
    if (depth <= 0.0 || depth > 1.0) depth = depths[median];
    o_colour = vec4(srgb_from_linear(colour / count), count / float(kSamples));
    o_depth = depth;
    o_object_id = ids[median];
#endif
}
