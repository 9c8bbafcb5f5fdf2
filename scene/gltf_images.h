#pragma once
/// The images of a glTF file, from buffer views, data URIs and files beside it.

#include <set>
#include <vector>

#include "scene/gltf_source.h"
#include "scene/scene.h"

namespace lw::scene {

/// Where the file's images went.
class ImportedImages {
public:
    explicit ImportedImages(std::size_t image_count) : scene_image_(image_count, kNone) {}

    /// Index into Scene::images; kNone for kNone, for images nobody asked for and for those that cannot be decoded.
    [[nodiscard]] int scene_image(int gltf_image) const {
        return gltf_image < 0 ? kNone : scene_image_[static_cast<std::size_t>(gltf_image)];
    }
    void set(int gltf_image, int scene_image) { scene_image_[static_cast<std::size_t>(gltf_image)] = scene_image; }

private:
    std::vector<int> scene_image_;
};

/// Decodes the images of `wanted` in ascending order and appends them to `images`. PNG and JPEG; others, and damaged
/// ones, are left out with one warning. Refuses images that lie outside of their buffer, are too large for the budget,
/// or name a file outside of the model's folder.
[[nodiscard]] ImportedImages import_images(GltfSource& source, const std::set<int>& wanted,
                                           std::vector<TextureImage>& images);

}  // namespace lw::scene
