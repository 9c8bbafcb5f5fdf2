#include "frame_link/frame_description.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/camera_check.h"
#include "core/image_io.h"

namespace lw {
namespace {

using nlohmann::json;

constexpr std::string_view kSchema = "latewarp.frame/1";
constexpr std::size_t kMaxLayers = 256;
constexpr int kMaxDepth = 32;            // of nested arrays; a frame needs 5
constexpr double kMaxNumber = 1e12;      // metres and seconds beyond this are not meant
constexpr double kUnitTolerance = 1e-3;  // three decimals, as people type quaternions
constexpr std::string_view kMend = "see docs/formats.md for the format";

/// The fields of one JSON object. The first problem met is kept in `error`, later ones are ignored, so that a reader
/// can read everything and look once.
class Fields {
public:
    Fields(const json& object, std::string where, std::optional<Error>& error)
        : object_{object}, where_{std::move(where)}, error_{error} {
        if (!object.is_object()) fail("not a JSON object");
    }

    [[nodiscard]] const std::string& where() const { return where_; }
    [[nodiscard]] bool has(const char* key) const { return object_.is_object() && object_.contains(key); }

    void fail(const std::string& what) {
        if (!error_) error_ = Error{what, where_, std::string{kMend}};
    }

    const json& at(const char* key) {
        static const json nothing;
        if (has(key)) return object_.at(key);
        fail(fmt::format("{} is missing", key));
        return nothing;
    }

    std::string text(const char* key) {
        const json& value = at(key);
        if (value.is_string()) return value.get<std::string>();
        fail(fmt::format("{} is not a text", key));
        return {};
    }

    double number(const char* key) { return finite(at(key), key); }
    double number_or(const char* key, double otherwise) { return has(key) ? number(key) : otherwise; }

    template <std::size_t N>
    std::array<double, N> numbers(const char* key) {
        std::array<double, N> values{};
        const json& list = at(key);
        if (!list.is_array() || list.size() != N) {
            fail(fmt::format("{} is not a list of {} numbers", key, N));
            return values;
        }
        for (std::size_t i = 0; i < N; ++i) values[i] = finite(list[i], key);
        return values;
    }

    /// A whole number in [low, high].
    std::int64_t integer(const char* key, std::int64_t low, std::int64_t high) {
        return whole(at(key), key, low, high);
    }

    std::int64_t whole(const json& value, const char* key, std::int64_t low, std::int64_t high) {
        const double number = value.is_number() ? value.get<double>() : std::nan("");
        // The comparison also refuses NaN. Both limits are below 2^53, where doubles are whole numbers exactly.
        if (!(number >= static_cast<double>(low) && number <= static_cast<double>(high)) ||
            std::floor(number) != number) {
            fail(fmt::format("{} is not a whole number from {} to {}", key, low, high));
            return low;
        }
        return static_cast<std::int64_t>(number);
    }

private:
    double finite(const json& value, const char* key) {
        const double number = value.is_number() ? value.get<double>() : std::nan("");
        if (std::abs(number) <= kMaxNumber) return number;
        fail(fmt::format("{} is not a usable number", key));
        return 0.0;
    }

    const json& object_;
    std::string where_;
    std::optional<Error>& error_;
};

ObjectTransform read_object(Fields fields) {
    ObjectTransform object;
    object.id = static_cast<ObjectId>(fields.integer("id", 1, 65535));
    const auto m = fields.numbers<16>("world_from_object");
    object.world_from_object = glm::make_mat4(m.data());
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        fields.fail("world_from_object is not column-major and affine (numbers 4, 8, 12, 16 must be 0, 0, 0, 1)");
    }
    return object;
}

std::vector<ObjectTransform> read_objects(const json& list, const std::string& where, std::optional<Error>& error) {
    std::vector<ObjectTransform> objects;
    if (!list.is_array() || list.size() > 65535) {
        if (!error) error = Error{"objects is not a list of at most 65535", where, std::string{kMend}};
        return objects;
    }
    for (std::size_t i = 0; i < list.size() && !error; ++i) {
        objects.push_back(read_object(Fields{list[i], fmt::format("{}: objects[{}]", where, i), error}));
    }
    std::sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    const auto twin =
        std::adjacent_find(objects.begin(), objects.end(), [](const auto& a, const auto& b) { return a.id == b.id; });
    if (twin != objects.end() && !error) {
        error = Error{fmt::format("object {} is there twice", twin->id), where, "keep one"};
    }
    return objects;
}

Pose read_pose(Fields fields, std::vector<std::string>& warnings) {
    const auto p = fields.numbers<3>("position_m");
    const auto q = fields.numbers<4>("orientation_xyzw");
    const auto pose = sanitised(Pose{{p[0], p[1], p[2]}, {q[3], q[0], q[1], q[2]}});
    if (!pose) {
        fields.fail("orientation_xyzw is no rotation (zero quaternion)");
        return {};
    }
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::abs(norm - 1.0) > kUnitTolerance) {
        warnings.push_back(fmt::format("{}: orientation_xyzw has length {:.4g}: normalised", fields.where(), norm));
    }
    return *pose;
}

Camera read_camera(Fields& fields, std::optional<Error>& error, std::vector<std::string>& warnings) {
    Camera camera;
    const json& size = fields.at("size_px");
    if (!size.is_array() || size.size() != 2) {
        fields.fail("size_px is not a list of 2 numbers");
    } else {
        for (int axis = 0; axis < 2; ++axis) {
            camera.size_px[axis] =
                static_cast<int>(fields.whole(size[static_cast<std::size_t>(axis)], "size_px", 1, kMaxImageSidePx));
        }
    }
    const auto fov = fields.numbers<4>("fov_tangents");
    camera.fov = {fov[0], fov[1], fov[2], fov[3]};
    camera.near_m = fields.number("near_m");
    camera.world_from_eye =
        read_pose(Fields{fields.at("world_from_eye"), fields.where() + ": world_from_eye", error}, warnings);
    if (!error) {
        if (const std::string_view problem = problem_of(camera); !problem.empty()) fields.fail(std::string{problem});
    }
    return camera;
}

DepthEncoding read_depth_encoding(Fields& fields) {
    const std::string encoding = fields.text("depth_encoding");
    if (encoding == "distance_m") return DepthEncoding::kDistanceM;
    if (encoding != "reverse_z") fields.fail("depth_encoding is neither reverse_z nor distance_m");
    return DepthEncoding::kReverseZ;
}

// "surface_share", or alpha says nothing.
bool read_alpha(Fields& fields) {
    if (!fields.has("alpha")) return false;
    const std::string alpha = fields.text("alpha");
    if (alpha != "surface_share" && alpha != "none") fields.fail("alpha is neither surface_share nor none");
    return alpha == "surface_share";
}

// "surface": there is an image of them.
bool read_quarters(Fields& fields) {
    if (!fields.has("quarters")) return false;
    const std::string quarters = fields.text("quarters");
    if (quarters != "surface" && quarters != "none") fields.fail("quarters is neither surface nor none");
    return quarters == "surface";
}

int read_quarter_samples(Fields& fields) {
    constexpr double kMost = 4096.0;
    const double samples = fields.number_or("quarter_samples", 1.0);
    if (samples >= 1.0 && samples <= kMost && samples == std::floor(samples)) return static_cast<int>(samples);
    fields.fail("quarter_samples is not a whole number from 1 to 4096");
    return 1;
}

LayerDescription read_layer(Fields fields, std::optional<Error>& error, std::vector<std::string>& warnings) {
    LayerDescription layer;
    layer.name = fields.text("name");
    if (!is_layer_name(layer.name)) fields.fail("name is not 1-64 letters, digits, '-' and '_'");
    layer.camera = read_camera(fields, error, warnings);
    layer.depth_encoding = read_depth_encoding(fields);
    layer.alpha_is_share = read_alpha(fields);
    layer.has_quarters = read_quarters(fields);
    layer.quarter_samples = read_quarter_samples(fields);
    layer.time_s = fields.number_or("time_s", 0.0);
    layer.pose_sampled_s = fields.number_or("pose_sampled_s", 0.0);
    if (std::abs(layer.pose_sampled_s) > 9e9) fields.fail("pose_sampled_s is beyond 9e9");
    if (fields.has("objects")) layer.movers = read_objects(fields.at("objects"), fields.where(), error);
    return layer;
}

Result<json> parse_json(std::string_view text, const std::string& where) {
    bool too_deep = false;
    // Returning false drops the nested value, which keeps the parser's own stack and ours shallow.
    const auto limit = [&too_deep](int depth, json::parse_event_t, json&) {
        if (depth > kMaxDepth) too_deep = true;
        return depth <= kMaxDepth;
    };
    json document = json::parse(text, limit, false);
    if (document.is_discarded()) return Error{"not valid JSON", where, std::string{kMend}};
    if (too_deep) return Error{"JSON nested too deeply", where, std::string{kMend}};
    return document;
}

void append_numbers(std::string& text, const double* numbers, std::size_t count) {
    text += '[';
    for (std::size_t i = 0; i < count; ++i) {
        fmt::format_to(std::back_inserter(text), "{}{}", i == 0 ? "" : ", ", numbers[i]);
    }
    text += ']';
}

void append_objects(std::string& text, const std::vector<ObjectTransform>& movers) {
    text += "      \"objects\": [";
    for (std::size_t i = 0; i < movers.size(); ++i) {
        fmt::format_to(std::back_inserter(text), "{}\n        {{\"id\": {}, \"world_from_object\": ", i == 0 ? "" : ",",
                       movers[i].id);
        append_numbers(text, &movers[i].world_from_object[0][0], 16);
        text += '}';
    }
    text += movers.empty() ? "]\n" : "\n      ]\n";
}

void append_layer(std::string& text, const Layer& layer) {
    const Camera& camera = layer.camera;
    const Pose& pose = camera.world_from_eye;
    const double orientation_xyzw[] = {pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w};
    const double fov[] = {camera.fov.left, camera.fov.right, camera.fov.down, camera.fov.up};
    fmt::format_to(std::back_inserter(text), "    {{\n      \"name\": \"{}\",\n      \"size_px\": [{}, {}],\n",
                   layer.name, camera.size_px.x, camera.size_px.y);
    text += "      \"fov_tangents\": ";
    append_numbers(text, fov, 4);
    fmt::format_to(std::back_inserter(text),
                   ",\n      \"near_m\": {},\n      \"world_from_eye\": {{\"position_m\": ", camera.near_m);
    append_numbers(text, &pose.position_m.x, 3);
    text += ", \"orientation_xyzw\": ";
    append_numbers(text, orientation_xyzw, 4);
    const std::string quarter_samples =
        layer.cpu().quarters.empty() ? std::string{}
                                     : fmt::format("      \"quarter_samples\": {},\n", layer.cpu().quarter_samples);
    fmt::format_to(
        std::back_inserter(text),
        "}},\n      \"depth_encoding\": \"reverse_z\",\n{}{}{}      \"time_s\": {},\n      \"pose_sampled_s\": {},\n",
        layer.cpu().alpha_is_share ? "      \"alpha\": \"surface_share\",\n" : "",
        layer.cpu().quarters.empty() ? "" : "      \"quarters\": \"surface\",\n", quarter_samples, layer.scene_time_s,
        seconds_of(layer.pose_sampled));
    append_objects(text, layer.movers);
    text += "    }";
}

}  // namespace

bool is_layer_name(std::string_view name) {
    const auto allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    };
    return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), allowed);
}

Result<FrameDescription> parse_frame_description(std::string_view text, const std::string& where) {
    auto document = parse_json(text, where);
    if (!document) return document.error();
    std::optional<Error> error;
    FrameDescription frame;
    Fields fields{*document, where, error};
    if (fields.text("schema") != kSchema) fields.fail(fmt::format("schema is not {}", kSchema));
    if (fields.has("index")) {
        frame.index = static_cast<std::uint64_t>(fields.integer("index", 0, std::int64_t{1} << 52));
    }
    const json& layers = fields.at("layers");
    if (!layers.is_array() || layers.empty() || layers.size() > kMaxLayers) {
        fields.fail(fmt::format("layers is not a list of 1 to {} layers", kMaxLayers));
    }
    std::set<std::string> names;
    for (std::size_t i = 0; !error && i < layers.size(); ++i) {
        const std::string layer_where = fmt::format("{}: layers[{}]", where, i);
        frame.layers.push_back(read_layer(Fields{layers[i], layer_where, error}, error, frame.warnings));
        if (!names.insert(frame.layers.back().name).second) fields.fail("two layers have the same name");
    }
    if (error) return std::move(*error);
    return frame;
}

std::string frame_description_of(const RenderedFrame& frame) {
    std::string text =
        fmt::format("{{\n  \"schema\": \"{}\",\n  \"index\": {},\n  \"layers\": [\n", kSchema, frame.index);
    for (std::size_t i = 0; i < frame.layers.size(); ++i) {
        if (i > 0) text += ",\n";
        append_layer(text, *frame.layers[i]);
    }
    text += "\n  ]\n}\n";
    return text;
}

Result<std::vector<ObjectTransform>> parse_objects(std::string_view text, const std::string& where) {
    auto document = parse_json(text, where);
    if (!document) return document.error();
    const bool wrapped = document->is_object() && document->contains("objects");
    std::optional<Error> error;
    auto objects = read_objects(wrapped ? document->at("objects") : *document, where, error);
    if (error) return std::move(*error);
    return objects;
}

}  // namespace lw
