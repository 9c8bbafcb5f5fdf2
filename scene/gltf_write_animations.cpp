#include <map>

#include "scene/gltf_writer.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;

const char* name_of(AnimatedProperty property) {
    switch (property) {
        case AnimatedProperty::translation:
            return "translation";
        case AnimatedProperty::rotation:
            return "rotation";
        case AnimatedProperty::scale:
            break;
    }
    return "scale";
}

const char* name_of(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::step:
            return "STEP";
        case Interpolation::linear:
            return "LINEAR";
        case Interpolation::cubic:
            break;
    }
    return "CUBICSPLINE";
}

/// glTF has no length of its own for an animation: it ends with its last key. A channel that stops earlier than its
/// loop gets a key at the end that holds its last value.
AnimationChannel padded_to_loop(const AnimationChannel& channel) {
    AnimationChannel result = channel;
    const auto end_s = static_cast<float>(channel.loop_s);
    if (channel.times_s.back() >= end_s) return result;
    result.times_s.push_back(end_s);
    if (channel.interpolation == Interpolation::cubic) {
        const std::size_t last = channel.values.size() - 3;
        const glm::vec4 value = channel.values[last + 1];
        result.values[last + 2] = glm::vec4{0.0f};  // no tangent out of the key that was the last
        result.values.insert(result.values.end(), {glm::vec4{0.0f}, value, glm::vec4{0.0f}});
    } else {
        result.values.push_back(channel.values.back());
    }
    return result;
}

json sampler_json(const AnimationChannel& channel, GltfWriter& writer) {
    const int times_view = writer.add_view(std::as_bytes(std::span{channel.times_s}));
    const int input = writer.add_accessor(times_view, 0, kFloat, channel.times_s.size(), "SCALAR");
    json& written = writer.root["accessors"].back();
    written["min"] = json::array({channel.times_s.front()});  // glTF demands both
    written["max"] = json::array({channel.times_s.back()});
    const int components = channel.property == AnimatedProperty::rotation ? 4 : 3;
    std::vector<float> floats;
    for (const glm::vec4& value : channel.values) {
        for (glm::length_t i = 0; i < components; ++i) floats.push_back(value[i]);
    }
    const int values_view = writer.add_view(std::as_bytes(std::span{floats}));
    const int output =
        writer.add_accessor(values_view, 0, kFloat, channel.values.size(), components == 4 ? "VEC4" : "VEC3");
    return {{"input", input}, {"output", output}, {"interpolation", name_of(channel.interpolation)}};
}

}  // namespace

void write_animations(const Scene& scene, GltfWriter& writer) {
    std::map<double, std::size_t> animation_of_length;
    std::vector<json> animations;
    // The first channel of each length makes the animation last that long.
    for (const AnimationChannel& channel : scene.channels) {
        const auto [entry, is_new] = animation_of_length.try_emplace(channel.loop_s, animations.size());
        if (is_new) animations.push_back({{"channels", json::array()}, {"samplers", json::array()}});
        json& animation = animations[entry->second];
        animation["channels"].push_back({{"sampler", animation["samplers"].size()},
                                         {"target", {{"node", channel.node}, {"path", name_of(channel.property)}}}});
        animation["samplers"].push_back(sampler_json(is_new ? padded_to_loop(channel) : channel, writer));
    }
    if (!animations.empty()) writer.root["animations"] = std::move(animations);
}

}  // namespace lw::scene
