#include "scene/gltf_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "scene/gltf_images.h"

namespace lw::scene {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";
constexpr const char* kUnlit = "KHR_materials_unlit";
constexpr const char* kEmissiveStrength = "KHR_materials_emissive_strength";

// Where blended materials are cut when they are drawn as masks: half covered is covered.
constexpr float kBlendCutoff = 0.5f;

float number_of(const tinygltf::Value& value) { return static_cast<float>(value.GetNumberAsDouble()); }

glm::vec2 vec2_of(const tinygltf::Value& extension, const char* name, glm::vec2 missing) {
    if (!extension.Has(name)) return missing;
    const tinygltf::Value& value = extension.Get(name);
    return {number_of(value.Get(0)), number_of(value.Get(1))};
}

/// translation * rotation * scale of KHR_texture_transform (its README gives the matrices).
glm::mat3 uv_transform_of(const tinygltf::ExtensionMap& extensions) {
    const auto found = extensions.find(kTransform);
    if (found == extensions.end()) return glm::mat3{1.0f};
    const glm::vec2 offset = vec2_of(found->second, "offset", glm::vec2{0.0f});
    const glm::vec2 scale = vec2_of(found->second, "scale", glm::vec2{1.0f});
    const float rotation_rad = found->second.Has("rotation") ? number_of(found->second.Get("rotation")) : 0.0f;
    const float cosine = std::cos(rotation_rad);
    const float sine = std::sin(rotation_rad);
    return {glm::vec3{cosine * scale.x, -sine * scale.x, 0.0f}, glm::vec3{sine * scale.y, cosine * scale.y, 0.0f},
            glm::vec3{offset, 1.0f}};
}

int uv_set_of(int tex_coord, const tinygltf::ExtensionMap& extensions) {
    const auto found = extensions.find(kTransform);
    if (found == extensions.end() || !found->second.Has("texCoord")) return tex_coord;
    return found->second.Get("texCoord").GetNumberAsInt();
}

TextureWrap wrap_of(int code) {
    if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::clamp;
    return code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror : TextureWrap::repeat;
}

/// The four texture references of a material that we use, as one type.
struct TextureReference {
    int texture = kNone;
    int uv_set = 0;
    const tinygltf::ExtensionMap* extensions = nullptr;
};

template <class Info>
TextureReference reference_of(const Info& info) {
    return {info.index, uv_set_of(info.texCoord, info.extensions), &info.extensions};
}

std::array<TextureReference, 4> references_of(const tinygltf::Material& material) {
    return {reference_of(material.pbrMetallicRoughness.baseColorTexture), reference_of(material.normalTexture),
            reference_of(material.pbrMetallicRoughness.metallicRoughnessTexture),
            reference_of(material.emissiveTexture)};
}

TextureUse texture_use(const GltfSource& source, const TextureReference& reference, const ImportedImages& images) {
    TextureUse use;
    if (reference.texture < 0) return use;
    const tinygltf::Texture& texture = source.model.textures[static_cast<std::size_t>(reference.texture)];
    use.image = images.scene_image(texture.source);
    use.uv_transform = uv_transform_of(*reference.extensions);
    if (texture.sampler >= 0) {
        const tinygltf::Sampler& sampler = source.model.samplers[static_cast<std::size_t>(texture.sampler)];
        use.wrap_u = wrap_of(sampler.wrapS);
        use.wrap_v = wrap_of(sampler.wrapT);
        use.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    return use;
}

float unit_interval(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

void import_alpha(GltfSource& source, const tinygltf::Material& from, Material& material) {
    if (from.alphaMode == "MASK") material.alpha_cutoff = static_cast<float>(from.alphaCutoff);
    if (from.alphaMode == "BLEND") {
        material.alpha_cutoff = kBlendCutoff;
        warn_once(source, "blended materials are drawn as masks");
    }
}

Material import_material(GltfSource& source, const tinygltf::Material& from, const ImportedImages& images) {
    Material material;
    material.name = from.name;
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i)
        material.base_colour[i] = unit_interval(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    material.metallic = unit_interval(pbr.metallicFactor);
    material.roughness = unit_interval(pbr.roughnessFactor);
    double strength = 1.0;
    const auto strong = from.extensions.find(kEmissiveStrength);
    if (strong != from.extensions.end() && strong->second.Has("emissiveStrength")) {
        strength = std::clamp(strong->second.Get("emissiveStrength").GetNumberAsDouble(), 0.0, 1e6);
    }
    for (int i = 0; i < 3 && from.emissiveFactor.size() == 3; ++i) {
        material.emissive[i] =
            static_cast<float>(strength * std::clamp(from.emissiveFactor[static_cast<std::size_t>(i)], 0.0, 1.0));
    }
    material.normal_scale = static_cast<float>(from.normalTexture.scale);
    material.double_sided = from.doubleSided;
    material.unlit = from.extensions.count(kUnlit) != 0;
    import_alpha(source, from, material);
    const std::array<TextureReference, 4> references = references_of(from);
    material.base_colour_texture = texture_use(source, references[0], images);
    material.normal_texture = texture_use(source, references[1], images);
    material.metallic_roughness_texture = texture_use(source, references[2], images);
    material.emissive_texture = texture_use(source, references[3], images);
    return material;
}

bool uses_several_uv_sets(const tinygltf::Material& material) {
    int first = kNone;
    for (const TextureReference& reference : references_of(material)) {
        if (reference.texture < 0) continue;
        if (first != kNone && first != reference.uv_set) return true;
        first = reference.uv_set;
    }
    return false;
}

}  // namespace

int uv_set_of(const GltfSource& source, int material) {
    if (material < 0) return 0;
    for (const TextureReference& reference :
         references_of(source.model.materials[static_cast<std::size_t>(material)])) {
        if (reference.texture >= 0) return reference.uv_set;
    }
    return 0;
}

void import_materials(GltfSource& source, Scene& scene) {
    std::set<int> used_images;
    for (const tinygltf::Material& material : source.model.materials) {
        for (const TextureReference& reference : references_of(material)) {
            if (reference.texture < 0) continue;
            const int image = source.model.textures[static_cast<std::size_t>(reference.texture)].source;
            if (image >= 0) used_images.insert(image);
        }
        if (uses_several_uv_sets(material)) {
            warn_once(source, "materials with several sets of texture coordinates use one of them");
        }
    }
    const ImportedImages images = import_images(source, used_images, scene.images);
    source.budget.charge(source.model.materials.size(), 3 * sizeof(Material), "materials");
    for (const tinygltf::Material& material : source.model.materials) {
        scene.materials.push_back(import_material(source, material, images));
    }
}

}  // namespace lw::scene
