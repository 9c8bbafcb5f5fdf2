#include "client_renderer/surface_features.h"

namespace lw {

SurfaceFeatures features_of(const scene::Material& material, bool vertex_colour, const std::vector<bool>& has_image) {
    const auto used = [&](const scene::TextureUse& use) {
        return use.image != scene::kNone && has_image[static_cast<std::size_t>(use.image)];
    };
    SurfaceFeatures features;
    features.vertex_colour = vertex_colour;
    features.base_colour_texture = used(material.base_colour_texture);
    features.alpha_mask = material.alpha_cutoff.has_value();
    features.double_sided = material.double_sided;
    features.unlit = material.unlit;
    if (!material.unlit) {
        features.metallic_roughness_texture = used(material.metallic_roughness_texture);
        features.normal_texture = used(material.normal_texture);
        features.emissive_texture = used(material.emissive_texture);
    }
    return features;
}

std::string defines_of(const SurfaceFeatures& features) {
    const bool textured = features.base_colour_texture || features.metallic_roughness_texture ||
                          features.normal_texture || features.emissive_texture;
    const std::pair<bool, const char*> names[] = {
        {textured, "TEXTURED"},
        {features.vertex_colour, "VERTEX_COLOUR"},
        {features.base_colour_texture, "BASE_COLOUR_TEXTURE"},
        {features.metallic_roughness_texture, "METALLIC_ROUGHNESS_TEXTURE"},
        {features.normal_texture, "NORMAL_TEXTURE"},
        {features.emissive_texture, "EMISSIVE_TEXTURE"},
        {features.alpha_mask, "ALPHA_MASK"},
        {features.double_sided, "DOUBLE_SIDED"},
        {features.unlit, "UNLIT"},
    };
    std::string defines;
    for (const auto& [present, name] : names) {
        if (present) defines.append("#define ").append(name).append("\n");
    }
    return defines;
}

}  // namespace lw
