#include "scene/gltf_source.h"

#include <algorithm>
#include <set>

#include "core/image_io.h"
#include "scene/gltf_schema.h"

namespace lw::scene {
namespace {

using nlohmann::json;

// tinygltf loads nothing by itself: buffers and images are ours, and these callbacks make sure of it.
bool no_file_exists(const std::string&, void*) { return false; }
std::string same_path(const std::string& path, void*) { return path; }
bool read_nothing(std::vector<unsigned char>*, std::string* error, const std::string&, void*) {
    *error = "no file is read here";
    return false;
}
bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }
bool keep_encoded(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

json take(json& root, const char* name) {
    const auto found = root.find(name);
    if (found == root.end()) return json::array();
    json result = std::move(*found);
    root.erase(found);
    return result;
}

/// The typed model's objects are large (a material has over 2 KB), and "{}," in the JSON suffices to ask for one.
void charge_model(const json& root, MemoryBudget& budget) {
    const auto charge = [&](const char* name, std::uint64_t size) {
        const auto found = root.find(name);
        // Growing vectors hold old and new elements for a moment; extensions add a few map nodes.
        if (found != root.end()) budget.charge(found->size(), 3 * size + 256, name);
    };
    charge("accessors", sizeof(tinygltf::Accessor));
    charge("bufferViews", sizeof(tinygltf::BufferView));
    charge("materials", sizeof(tinygltf::Material));
    charge("meshes", sizeof(tinygltf::Mesh));
    charge("nodes", sizeof(tinygltf::Node));
    charge("samplers", sizeof(tinygltf::Sampler));
    charge("scenes", sizeof(tinygltf::Scene));
    charge("textures", sizeof(tinygltf::Texture));
    charge("animations", sizeof(tinygltf::Animation));
    if (!root.contains("meshes")) return;
    for (const json& mesh : root["meshes"]) {
        budget.charge(mesh["primitives"].size(), 3 * sizeof(tinygltf::Primitive) + 256, "meshes");
    }
}

void charge_animations(const json& root, MemoryBudget& budget) {
    if (!root.contains("animations")) return;
    for (const json& animation : root["animations"]) {
        budget.charge(animation["channels"].size(), 3 * sizeof(tinygltf::AnimationChannel), "animations");
        budget.charge(animation["samplers"].size(), 3 * sizeof(tinygltf::AnimationSampler), "animations");
    }
}

/// tinygltf refuses a primitive whose index accessor has no buffer view: Draco's, whose indices are in the compressed
/// data, and sparse or all-zero ones. Any view pleases it; which accessors have none is remembered.
void patch_index_accessors(json& root, std::set<int>& accessors_without_view) {
    if (!root.contains("meshes")) return;
    for (const json& mesh : root["meshes"]) {
        for (const json& primitive : mesh["primitives"]) {
            if (!primitive.contains("indices")) continue;
            const int index = primitive["indices"].get<int>();
            json& accessor = root["accessors"][static_cast<std::size_t>(index)];
            if (accessor.contains("bufferView")) continue;
            accessor["bufferView"] = 0;
            accessors_without_view.insert(index);
        }
    }
    if (accessors_without_view.empty()) return;
    json& views = root["bufferViews"];
    if (views.empty()) views.push_back({{"buffer", 0}, {"byteLength", 1}});
}

/// tinygltf refuses accessors of unknown types even where nothing uses them. As matrices, which nothing here reads,
/// they are refused when they are used.
void patch_accessor_types(json& root) {
    static const std::set<std::string> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    if (!root.contains("accessors")) return;
    for (json& accessor : root["accessors"]) {
        if (kTypes.count(accessor["type"].get_ref<const std::string&>()) == 0) accessor["type"] = "MAT2";
    }
}

std::uint64_t uri_bytes_of(const json& objects) {
    std::uint64_t bytes = 0;
    for (const json& object : objects) {
        if (object.contains("uri")) bytes += object["uri"].get_ref<const std::string&>().size();
    }
    return bytes;
}

json checked_root(GltfSource& source, const JsonCost& cost) {
    // The checked copy has a structure of its own; the texts move into it.
    const TemporaryCharge copy{source.budget, 1, cost.structure_bytes, ""};
    return checked_gltf(std::move(source.document.root));
}

/// tinygltf's complaints are lines; we show one.
std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, 200);
}

void parse_model(const json& root, GltfSource& source) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_encoded, nullptr);
    reader.SetFsCallbacks({no_file_exists, same_path, read_nothing, write_nothing, nullptr});
    const std::string text = root.dump();
    std::string error;
    std::string warning;
    const bool parsed = reader.LoadASCIIFromString(&source.model, &error, &warning, text.c_str(),
                                                   static_cast<unsigned int>(text.size()), "");
    if (!parsed) refuse(error.empty() ? "the model cannot be read" : one_line(error), "");
}

}  // namespace

void open_gltf(const std::filesystem::path& path, GltfSource& source) {
    source.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path{"."};
    auto bytes = read_file(path, MemoryBudget::kLimitBytes);
    if (!bytes.ok()) refuse(bytes.error().what, "", bytes.error().mend);
    source.document = parse_gltf_document(std::move(*bytes), source.budget);
    check_gltf_features(source.document.root, source.warnings);
    const JsonCost cost = source.document.json;
    json root = checked_root(source, cost);
    std::uint64_t uri_bytes = 0;
    {
        const json buffers = take(root, "buffers");
        uri_bytes = uri_bytes_of(buffers);
        source.buffers = read_buffers(buffers, source.document.has_binary_chunk, source.document.binary_chunk,
                                      source.folder, source.budget);
    }
    source.images = take(root, "images");
    const std::uint64_t image_uri_bytes = uri_bytes_of(source.images);
    charge_model(root, source.budget);
    charge_animations(root, source.budget);
    patch_index_accessors(root, source.accessors_without_view);
    patch_accessor_types(root);
    {
        // The text for tinygltf and its own tree, each at most as large as ours without what was taken out.
        const TemporaryCharge copies{source.budget, 2, cost.bytes() - uri_bytes - image_uri_bytes, ""};
        parse_model(root, source);
    }
    source.budget.release(cost.bytes());
    source.budget.charge(image_uri_bytes, "images");
}

void warn_once(GltfSource& source, const std::string& warning) {
    if (std::find(source.warnings.begin(), source.warnings.end(), warning) == source.warnings.end()) {
        source.warnings.push_back(warning);
    }
}

}  // namespace lw::scene
