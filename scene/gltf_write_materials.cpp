#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/png_encoder.h"
#include "scene/gltf_writer.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr int kNearest = 9728;
constexpr int kLinear = 9729;
constexpr int kLinearMipmapLinear = 9987;

int wrap_code(TextureWrap wrap) {
    switch (wrap) {
        case TextureWrap::clamp:
            return 33071;
        case TextureWrap::mirror:
            return 33648;
        case TextureWrap::repeat:
            break;
    }
    return 10497;
}

/// Offset, rotation and scale of KHR_texture_transform; nothing where the matrix has shear.
std::optional<json> transform_json(const glm::mat3& uv_transform) {
    const glm::dmat3 m{uv_transform};
    const double scale_u = std::hypot(m[0][0], m[0][1]);
    const double rotation_rad = std::atan2(-m[0][1], m[0][0]);
    const double scale_v = m[1][0] * std::sin(rotation_rad) + m[1][1] * std::cos(rotation_rad);
    const double shear = m[1][0] * std::cos(rotation_rad) - m[1][1] * std::sin(rotation_rad);
    const double largest = std::max(scale_u, std::abs(scale_v));
    // float matrices of rotated textures are off by a few 6e-8.
    if (std::abs(shear) > 1e-5 * largest) return std::nullopt;
    json transform = json::object();
    if (m[2][0] != 0.0 || m[2][1] != 0.0) transform["offset"] = {m[2][0], m[2][1]};
    if (rotation_rad != 0.0) transform["rotation"] = rotation_rad;
    if (scale_u != 1.0 || scale_v != 1.0) transform["scale"] = {scale_u, scale_v};
    return transform;
}

/// Textures and samplers are shared between equal uses.
class TextureTable {
public:
    explicit TextureTable(GltfWriter& writer) : writer_{writer} {}

    int texture(const TextureUse& use) {
        const auto key = std::tuple{use.image, use.wrap_u, use.wrap_v, use.nearest};
        const auto known = textures_.find(key);
        if (known != textures_.end()) return known->second;
        const int index = writer_.add("textures", {{"source", use.image}, {"sampler", sampler(use)}});
        textures_[key] = index;
        return index;
    }

private:
    int sampler(const TextureUse& use) {
        const auto key = std::tuple{use.wrap_u, use.wrap_v, use.nearest};
        const auto known = samplers_.find(key);
        if (known != samplers_.end()) return known->second;
        const int index = writer_.add("samplers", {{"wrapS", wrap_code(use.wrap_u)},
                                                   {"wrapT", wrap_code(use.wrap_v)},
                                                   {"magFilter", use.nearest ? kNearest : kLinear},
                                                   {"minFilter", use.nearest ? kNearest : kLinearMipmapLinear}});
        samplers_[key] = index;
        return index;
    }

    GltfWriter& writer_;
    std::map<std::tuple<int, TextureWrap, TextureWrap, bool>, int> textures_;
    std::map<std::tuple<TextureWrap, TextureWrap, bool>, int> samplers_;
};

/// False where the use cannot be written (shear).
bool write_use(const TextureUse& use, const char* name, TextureTable& table, GltfWriter& writer, json& object) {
    if (use.image == kNone) return true;
    json info = {{"index", table.texture(use)}};
    if (use.uv_transform != glm::mat3{1.0f}) {
        std::optional<json> transform = transform_json(use.uv_transform);
        if (!transform) return false;
        info["extensions"]["KHR_texture_transform"] = std::move(*transform);
        writer.use_extension("KHR_texture_transform");
    }
    object[name] = std::move(info);
    return true;
}

void write_emission(const Material& material, GltfWriter& writer, json& object) {
    const float strength = std::max({material.emissive.x, material.emissive.y, material.emissive.z});
    if (!(strength > 0.0f)) return;
    const glm::dvec3 factor = glm::dvec3{material.emissive} / std::max(1.0, static_cast<double>(strength));
    object["emissiveFactor"] = {factor.x, factor.y, factor.z};
    if (strength > 1.0f) {
        object["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
        writer.use_extension("KHR_materials_emissive_strength");
    }
}

std::optional<json> material_json(const Material& material, TextureTable& table, GltfWriter& writer) {
    json pbr = {{"metallicFactor", material.metallic}, {"roughnessFactor", material.roughness}};
    const glm::vec4& base = material.base_colour;
    if (base != glm::vec4{1.0f}) pbr["baseColorFactor"] = {base.r, base.g, base.b, base.a};
    json object = json::object();
    if (!material.name.empty()) object["name"] = material.name;
    const bool written =
        write_use(material.base_colour_texture, "baseColorTexture", table, writer, pbr) &&
        write_use(material.metallic_roughness_texture, "metallicRoughnessTexture", table, writer, pbr) &&
        write_use(material.normal_texture, "normalTexture", table, writer, object) &&
        write_use(material.emissive_texture, "emissiveTexture", table, writer, object);
    if (!written) return std::nullopt;
    object["pbrMetallicRoughness"] = std::move(pbr);
    if (object.contains("normalTexture") && material.normal_scale != 1.0f) {
        object["normalTexture"]["scale"] = material.normal_scale;
    }
    write_emission(material, writer, object);
    if (material.alpha_cutoff) {
        object["alphaMode"] = "MASK";
        object["alphaCutoff"] = *material.alpha_cutoff;
    }
    if (material.double_sided) object["doubleSided"] = true;
    if (material.unlit) {
        object["extensions"]["KHR_materials_unlit"] = json::object();
        writer.use_extension("KHR_materials_unlit");
    }
    return object;
}

}  // namespace

Status write_materials(const Scene& scene, GltfWriter& writer) {
    for (const TextureImage& image : scene.images) {
        const auto pixels = std::as_bytes(image.pixels.pixels());
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(pixels.data());
        const std::vector<std::uint8_t> png =
            encode_png(image.pixels.size_px(), PngColour::rgba, 8, {bytes, pixels.size()});
        if (png.empty()) return Error{"the image cannot be encoded", image.name, "free some memory"};
        json object = {{"bufferView", writer.add_view(std::as_bytes(std::span{png}))}, {"mimeType", "image/png"}};
        if (!image.name.empty()) object["name"] = image.name;
        writer.add("images", std::move(object));
    }
    TextureTable table{writer};
    for (const Material& material : scene.materials) {
        std::optional<json> object = material_json(material, table, writer);
        if (!object) {
            return Error{"glTF cannot hold a texture transform with shear", material.name,
                         "use offset, rotation and scale only"};
        }
        writer.add("materials", std::move(*object));
    }
    return Done{};
}

}  // namespace lw::scene
