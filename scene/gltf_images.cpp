#include "scene/gltf_images.h"

#include <optional>

#include "core/image_io.h"
#include "scene/encoded_image.h"
#include "scene/gltf_accessors.h"

namespace lw::scene {
namespace {

/// The image as it is stored. Bytes of a data URI or file stay charged until the caller releases them.
GltfBytes encoded_bytes(GltfSource& source, const nlohmann::json& image, const std::string& place) {
    GltfBytes bytes;
    if (image.contains("bufferView")) {
        bytes.view = view_bytes(source, image["bufferView"].get<int>());
    } else if (image.contains("uri")) {
        bytes.owned =
            read_uri(image["uri"].get_ref<const std::string&>(), source.folder, source.budget, place + ".uri");
        bytes.view = bytes.owned;
    } else {
        refuse("the image has neither a uri nor a buffer view", place);
    }
    return bytes;
}

std::optional<ColourImage> decode(GltfSource& source, std::span<const std::uint8_t> bytes, const std::string& place) {
    const std::optional<EncodedImage> claim = peek_image(bytes);
    if (!claim) return std::nullopt;
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(claim->size_px.x) * static_cast<std::uint64_t>(claim->size_px.y);
    source.budget.charge(pixels, sizeof(Rgba8), place);
    const TemporaryCharge work{source.budget, pixels, static_cast<std::uint64_t>(claim->decode_bytes_per_px), place};
    auto decoded = decode_image(bytes, place);
    if (!decoded.ok()) return std::nullopt;
    return std::move(*decoded);
}

}  // namespace

ImportedImages import_images(GltfSource& source, const std::set<int>& wanted, std::vector<TextureImage>& images) {
    ImportedImages result{source.images.size()};
    for (const int index : wanted) {
        const nlohmann::json& image = source.images[static_cast<std::size_t>(index)];
        const std::string place = fmt::format("images[{}]", index);
        const std::uint64_t before_bytes = source.budget.charged_bytes();
        const GltfBytes bytes = encoded_bytes(source, image, place);
        const std::uint64_t encoded_size = source.budget.charged_bytes() - before_bytes;
        std::optional<ColourImage> pixels = decode(source, bytes.view, place);
        source.budget.release(encoded_size);
        if (!pixels) {
            warn_once(source, "images that are not PNG or JPEG, or are damaged, are left out");
            continue;
        }
        result.set(index, static_cast<int>(images.size()));
        images.push_back({image.value("name", std::string{}), std::move(*pixels)});
    }
    return result;
}

}  // namespace lw::scene
