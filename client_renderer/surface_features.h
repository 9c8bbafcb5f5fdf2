#pragma once
/// What a G-buffer shader variant has to do. Each combination that a scene uses is a program of its own: on a software
/// GL every feature that is compiled in costs time on every pixel.

#include <cstdint>
#include <string>

#include "scene/scene.h"

namespace lw {

struct SurfaceFeatures {
    bool vertex_colour = false;
    bool base_colour_texture = false;
    bool metallic_roughness_texture = false;
    bool normal_texture = false;
    bool emissive_texture = false;
    bool alpha_mask = false;
    bool double_sided = false;
    bool unlit = false;

    friend auto operator<=>(const SurfaceFeatures&, const SurfaceFeatures&) = default;
};

/// `has_image[i]` says whether image i of the scene was uploaded. Unlit materials ignore all but their base colour.
[[nodiscard]] SurfaceFeatures features_of(const scene::Material& material, bool vertex_colour,
                                          const std::vector<bool>& has_image);

/// The features as preprocessor lines for shaders/client/gbuffer.*.
[[nodiscard]] std::string defines_of(const SurfaceFeatures& features);

}  // namespace lw
