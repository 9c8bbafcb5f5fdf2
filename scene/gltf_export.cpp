#include "core/image_io.h"
#include "scene/gltf.h"
#include "scene/gltf_writer.h"

namespace lw::scene {

Status save_glb(const Scene& scene, const std::filesystem::path& path) {
    GltfWriter writer;
    writer.root["asset"] = {{"version", "2.0"}, {"generator", "latewarp"}};
    const Status materials = write_materials(scene, writer);
    if (!materials.ok()) return materials;
    const std::vector<int> gltf_mesh = write_meshes(scene, writer);
    write_nodes(scene, gltf_mesh, writer);
    write_animations(scene, writer);
    const std::vector<std::byte> file = writer.finish();
    if (file.empty()) return Error{"the scene passes the 4 GB of a .glb", path.string(), "generate a smaller scene"};
    return write_file_atomically(path, file);
}

}  // namespace lw::scene
