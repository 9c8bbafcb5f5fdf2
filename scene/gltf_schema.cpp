#include "scene/gltf_schema.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace lw::scene {
namespace {

using nlohmann::json;

enum class Kind : std::uint8_t {
    text,
    uri,  // a text of any length
    boolean,
    number,
    integer,  // 0 .. 2^31 - 1
    index,    // into a root array
    numbers,
    indices,
    object,
    objects,
    index_map,    // attribute name -> accessor
    integer_map,  // attribute name -> number
};

struct Field {
    const char* name = "";
    Kind kind = Kind::text;
    bool required = false;
    const char* target = nullptr;   // index, indices, index_map: the root array
    std::size_t length = 0;         // numbers: exact length, 0 any
    const Field* fields = nullptr;  // object, objects: ends with an empty name
};

constexpr bool kRequired = true;
constexpr bool kOptional = false;
constexpr Field kEnd{};
constexpr std::size_t kMaxTextBytes = 65536;

constexpr Field text(const char* name, bool required = kOptional) { return {name, Kind::text, required}; }
constexpr Field uri(const char* name) { return {name, Kind::uri}; }
constexpr Field boolean(const char* name) { return {name, Kind::boolean}; }
constexpr Field number(const char* name) { return {name, Kind::number}; }
constexpr Field integer(const char* name, bool required = kOptional) { return {name, Kind::integer, required}; }
constexpr Field index(const char* name, const char* target, bool required = kOptional) {
    return {name, Kind::index, required, target};
}
constexpr Field numbers(const char* name, std::size_t length) {
    return {name, Kind::numbers, kOptional, nullptr, length};
}
constexpr Field object(const char* name, const Field* fields, bool required = kOptional) {
    return {name, Kind::object, required, nullptr, 0, fields};
}
constexpr Field objects(const char* name, const Field* fields, bool required = kOptional) {
    return {name, Kind::objects, required, nullptr, 0, fields};
}

constexpr Field kAsset[] = {text("version", kRequired), kEnd};

constexpr Field kSparseIndices[] = {index("bufferView", "bufferViews", kRequired), integer("byteOffset"),
                                    integer("componentType", kRequired), kEnd};
constexpr Field kSparseValues[] = {index("bufferView", "bufferViews", kRequired), integer("byteOffset"), kEnd};
constexpr Field kSparse[] = {integer("count", kRequired), object("indices", kSparseIndices, kRequired),
                             object("values", kSparseValues, kRequired), kEnd};
constexpr Field kAccessor[] = {index("bufferView", "bufferViews"),  integer("byteOffset"),
                               integer("componentType", kRequired), boolean("normalized"),
                               integer("count", kRequired),         text("type", kRequired),
                               object("sparse", kSparse),           kEnd};

constexpr Field kMeshopt[] = {index("buffer", "buffers", kRequired),
                              integer("byteOffset"),
                              integer("byteLength", kRequired),
                              integer("byteStride", kRequired),
                              integer("count", kRequired),
                              text("mode", kRequired),
                              text("filter"),
                              kEnd};
constexpr Field kViewExtensions[] = {object("EXT_meshopt_compression", kMeshopt), kEnd};
constexpr Field kBufferView[] = {index("buffer", "buffers", kRequired), integer("byteOffset"),
                                 integer("byteLength", kRequired),      integer("byteStride"),
                                 object("extensions", kViewExtensions), kEnd};
constexpr Field kBuffer[] = {uri("uri"), integer("byteLength", kRequired), kEnd};
constexpr Field kImage[] = {text("name"), uri("uri"), text("mimeType"), index("bufferView", "bufferViews"), kEnd};
constexpr Field kSampler[] = {integer("magFilter"), integer("minFilter"), integer("wrapS"), integer("wrapT"), kEnd};
constexpr Field kTexture[] = {index("sampler", "samplers"), index("source", "images"), kEnd};

constexpr Field kTransform[] = {numbers("offset", 2), number("rotation"), numbers("scale", 2), integer("texCoord"),
                                kEnd};
constexpr Field kInfoExtensions[] = {object("KHR_texture_transform", kTransform), kEnd};
constexpr Field kTextureInfo[] = {index("index", "textures", kRequired), integer("texCoord"), number("scale"),
                                  object("extensions", kInfoExtensions), kEnd};
constexpr Field kMetallicRoughness[] = {
    numbers("baseColorFactor", 4), object("baseColorTexture", kTextureInfo),         number("metallicFactor"),
    number("roughnessFactor"),     object("metallicRoughnessTexture", kTextureInfo), kEnd};
constexpr Field kNothing[] = {kEnd};
constexpr Field kEmissiveStrength[] = {number("emissiveStrength"), kEnd};
constexpr Field kMaterialExtensions[] = {object("KHR_materials_unlit", kNothing),
                                         object("KHR_materials_emissive_strength", kEmissiveStrength), kEnd};
constexpr Field kMaterial[] = {text("name"),
                               object("pbrMetallicRoughness", kMetallicRoughness),
                               object("normalTexture", kTextureInfo),
                               object("emissiveTexture", kTextureInfo),
                               numbers("emissiveFactor", 3),
                               text("alphaMode"),
                               number("alphaCutoff"),
                               boolean("doubleSided"),
                               object("extensions", kMaterialExtensions),
                               kEnd};

constexpr Field kDraco[] = {
    index("bufferView", "bufferViews", kRequired), {"attributes", Kind::integer_map, kRequired}, kEnd};
constexpr Field kPrimitiveExtensions[] = {object("KHR_draco_mesh_compression", kDraco), kEnd};
constexpr Field kPrimitive[] = {{"attributes", Kind::index_map, kRequired, "accessors"},
                                index("indices", "accessors"),
                                index("material", "materials"),
                                integer("mode"),
                                object("extensions", kPrimitiveExtensions),
                                kEnd};
constexpr Field kMesh[] = {text("name"), objects("primitives", kPrimitive, kRequired), kEnd};

constexpr Field kNodeLight[] = {index("light", "lights", kRequired), kEnd};
constexpr Field kNodeInstancing[] = {{"attributes", Kind::index_map, kRequired, "accessors"}, kEnd};
constexpr Field kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight),
                                     object("EXT_mesh_gpu_instancing", kNodeInstancing), kEnd};
constexpr Field kNode[] = {text("name"),
                           {"children", Kind::indices, kOptional, "nodes"},
                           index("mesh", "meshes"),
                           index("camera", "cameras"),
                           numbers("matrix", 16),
                           numbers("translation", 3),
                           numbers("rotation", 4),
                           numbers("scale", 3),
                           object("extensions", kNodeExtensions),
                           kEnd};
constexpr Field kScene[] = {text("name"), {"nodes", Kind::indices, kOptional, "nodes"}, kEnd};

constexpr Field kTarget[] = {index("node", "nodes"), text("path", kRequired), kEnd};
constexpr Field kChannel[] = {integer("sampler", kRequired), object("target", kTarget, kRequired), kEnd};
constexpr Field kAnimationSampler[] = {index("input", "accessors", kRequired), index("output", "accessors", kRequired),
                                       text("interpolation"), kEnd};
constexpr Field kAnimation[] = {text("name"), objects("channels", kChannel, kRequired),
                                objects("samplers", kAnimationSampler, kRequired), kEnd};

constexpr Field kLight[] = {text("type", kRequired), numbers("color", 3),      number("intensity"),
                            number("range"),         object("spot", kNothing), kEnd};
constexpr Field kLights[] = {objects("lights", kLight, kRequired), kEnd};
constexpr Field kRootExtensions[] = {object("KHR_lights_punctual", kLights), kEnd};

constexpr Field kRoot[] = {object("asset", kAsset, kRequired),
                           objects("accessors", kAccessor),
                           objects("bufferViews", kBufferView),
                           objects("buffers", kBuffer),
                           objects("images", kImage),
                           objects("samplers", kSampler),
                           objects("textures", kTexture),
                           objects("materials", kMaterial),
                           objects("meshes", kMesh),
                           objects("nodes", kNode),
                           objects("scenes", kScene),
                           index("scene", "scenes"),
                           objects("animations", kAnimation),
                           object("extensions", kRootExtensions),
                           kEnd};

/// Where the check is, as a chain on the stack; only a refusal makes a string of it.
struct Place {
    const Place* parent = nullptr;
    const char* name = nullptr;  // of a property; null for an element
    std::size_t element = 0;

    [[nodiscard]] std::string path() const {
        const std::string before = parent != nullptr ? parent->path() : std::string{};
        if (name == nullptr) return fmt::format("{}[{}]", before, element);
        return before.empty() ? std::string{name} : before + "." + name;
    }
};

class Checker {
public:
    explicit Checker(const json& root) : root_{root} {}

    [[nodiscard]] json check_object(json& value, const Field* fields, const Place* place) const {
        if (!value.is_object()) refuse("expected an object", path_of(place));
        json result = json::object();
        for (const Field* field = fields; *field->name != '\0'; ++field) {
            const Place inner{place, field->name};
            const auto found = value.find(field->name);
            if (found != value.end()) {
                result[field->name] = check(*found, *field, inner);
            } else if (field->required) {
                refuse("a required property is missing", inner.path());
            }
        }
        return result;
    }

private:
    [[nodiscard]] static std::string path_of(const Place* place) { return place != nullptr ? place->path() : ""; }

    [[nodiscard]] json check(json& value, const Field& field, const Place& place) const {
        switch (field.kind) {
            case Kind::text:
                return check_text(value, kMaxTextBytes, place);
            case Kind::uri:
                return check_text(value, std::numeric_limits<std::size_t>::max(), place);
            case Kind::boolean:
                if (!value.is_boolean()) refuse("expected true or false", place.path());
                return value;
            case Kind::number:
                return check_number(value, place);
            case Kind::integer:
                return check_integer(value, place);
            case Kind::index:
                return check_index(value, field, place);
            case Kind::numbers:
            case Kind::indices:
            case Kind::objects:
                return check_array(value, field, place);
            case Kind::object:
                return check_object(value, field.fields, &place);
            case Kind::index_map:
            case Kind::integer_map:
                return check_map(value, field, place);
        }
        return {};
    }

    /// Moves the text: an embedded buffer is most of its file.
    [[nodiscard]] static json check_text(json& value, std::size_t max_bytes, const Place& place) {
        if (!value.is_string()) refuse("expected a text", place.path());
        if (value.get_ref<const std::string&>().size() > max_bytes) refuse("the text is too long", place.path());
        return std::move(value);
    }

    [[nodiscard]] static json check_number(const json& value, const Place& place) {
        if (!value.is_number()) refuse("expected a number", place.path());
        const double number = value.get<double>();
        // Everything ends up as float; what float cannot hold would become infinite there.
        if (!(std::abs(number) <= 3e38)) refuse("the number is too large", place.path());
        return number;
    }

    [[nodiscard]] static json check_integer(const json& value, const Place& place) {
        if (!value.is_number()) refuse("expected an integer", place.path());
        const double number = value.get<double>();
        if (number != std::floor(number)) refuse("expected an integer", place.path());
        if (number < 0.0 || number > 2147483647.0) refuse("the integer is out of range", place.path());
        return static_cast<std::int64_t>(number);
    }

    [[nodiscard]] json check_index(const json& value, const Field& field, const Place& place) const {
        json result = check_integer(value, place);
        const std::size_t count = array_size(field.target);
        if (result.get<std::size_t>() >= count) {
            refuse(fmt::format("index {} is out of range, there are {} {}", result.get<std::size_t>(), count,
                               field.target),
                   place.path());
        }
        return result;
    }

    [[nodiscard]] json check_array(json& value, const Field& field, const Place& place) const {
        if (!value.is_array()) refuse("expected an array", place.path());
        if (field.kind == Kind::numbers && value.size() != field.length) {
            refuse(fmt::format("expected {} numbers, found {}", field.length, value.size()), place.path());
        }
        json result = json::array();
        for (std::size_t i = 0; i < value.size(); ++i) {
            const Place element{&place, nullptr, i};
            if (field.kind == Kind::numbers) {
                result.push_back(check_number(value[i], element));
            } else if (field.kind == Kind::indices) {
                result.push_back(check_index(value[i], field, element));
            } else {
                result.push_back(check_object(value[i], field.fields, &element));
            }
        }
        return result;
    }

    [[nodiscard]] json check_map(const json& value, const Field& field, const Place& place) const {
        if (!value.is_object()) refuse("expected an object", place.path());
        json result = json::object();
        for (const auto& [name, number] : value.items()) {
            const Place element{&place, name.c_str()};
            result[name] =
                field.kind == Kind::index_map ? check_index(number, field, element) : check_integer(number, element);
        }
        return result;
    }

    [[nodiscard]] std::size_t array_size(const std::string& name) const {
        static const json::json_pointer kLightsPath{"/extensions/KHR_lights_punctual/lights"};
        if (name == "lights") return root_.contains(kLightsPath) ? root_.at(kLightsPath).size() : 0;
        const auto found = root_.find(name);
        return found != root_.end() && found->is_array() ? found->size() : 0;
    }

    const json& root_;
};

}  // namespace

json checked_gltf(json root) { return Checker{root}.check_object(root, kRoot, nullptr); }

}  // namespace lw::scene
