#include "scene/gltf_animation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "scene/gltf_accessors.h"

namespace lw::scene {
namespace {

std::optional<AnimatedProperty> property_of(const std::string& path) {
    if (path == "translation") return AnimatedProperty::translation;
    if (path == "rotation") return AnimatedProperty::rotation;
    if (path == "scale") return AnimatedProperty::scale;
    return std::nullopt;
}

Interpolation interpolation_of(const std::string& name, const std::string& place) {
    if (name == "STEP") return Interpolation::step;
    if (name == "LINEAR" || name.empty()) return Interpolation::linear;
    if (name == "CUBICSPLINE") return Interpolation::cubic;
    refuse("unknown interpolation", place + ".interpolation");
}

std::vector<float> read_times(GltfSource& source, int accessor, const std::string& place) {
    std::vector<float> times_s = read_floats(source, accessor, 1);
    if (times_s.empty()) refuse("no keys", place + ".input");
    for (std::size_t i = 0; i < times_s.size(); ++i) {
        if (!std::isfinite(times_s[i]) || times_s[i] < 0.0f) {
            refuse(fmt::format("key {} is at no time", i), place + ".input");
        }
        if (i > 0 && times_s[i] < times_s[i - 1]) refuse(fmt::format("key {} goes back in time", i), place + ".input");
    }
    return times_s;
}

std::vector<glm::vec4> read_values(GltfSource& source, int accessor, int components, const std::string& place) {
    const std::vector<float> floats = read_floats(source, accessor, components);
    std::vector<glm::vec4> values(floats.size() / static_cast<std::size_t>(components), glm::vec4{0.0f});
    for (std::size_t i = 0; i < floats.size(); ++i) {
        if (!std::isfinite(floats[i])) refuse("a value is not a finite number", place + ".output");
        const auto component = static_cast<glm::length_t>(i % static_cast<std::size_t>(components));
        values[i / static_cast<std::size_t>(components)][component] = floats[i];
    }
    return values;
}

/// Of keys at the same time the last one counts; exporters write such pairs for jumps.
bool drop_repeated_keys(AnimationChannel& channel) {
    const std::size_t stride = channel.interpolation == Interpolation::cubic ? 3 : 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < channel.times_s.size(); ++i) {
        if (i + 1 < channel.times_s.size() && channel.times_s[i] == channel.times_s[i + 1]) continue;
        channel.times_s[kept] = channel.times_s[i];
        for (std::size_t k = 0; k < stride; ++k) channel.values[kept * stride + k] = channel.values[i * stride + k];
        ++kept;
    }
    const bool dropped = kept != channel.times_s.size();
    channel.times_s.resize(kept);
    channel.values.resize(kept * stride);
    return dropped;
}

AnimationChannel read_channel(GltfSource& source, const tinygltf::AnimationSampler& sampler, AnimatedProperty property,
                              const std::string& place) {
    AnimationChannel channel;
    channel.property = property;
    channel.interpolation = interpolation_of(sampler.interpolation, place);
    const std::size_t keys = accessor_count(source, sampler.input);
    const std::size_t values_per_key = channel.interpolation == Interpolation::cubic ? 3 : 1;
    if (accessor_count(source, sampler.output) != keys * values_per_key) {
        refuse(fmt::format("{} values for {} keys", accessor_count(source, sampler.output), keys), place + ".output");
    }
    source.budget.charge(keys, sizeof(float) + values_per_key * sizeof(glm::vec4), place);
    channel.times_s = read_times(source, sampler.input, place);
    channel.values = read_values(source, sampler.output, property == AnimatedProperty::rotation ? 4 : 3, place);
    if (drop_repeated_keys(channel)) warn_once(source, "of animation keys at the same time the last one is used");
    return channel;
}

double length_of(const std::vector<AnimationChannel>& channels) {
    double length_s = 0.0;
    for (const AnimationChannel& channel : channels) {
        length_s = std::max(length_s, static_cast<double>(channel.times_s.back()));
    }
    return length_s > 0.0 ? length_s : 1.0;
}

/// Node and property of the channels that a scene has.
using AnimatedPlaces = std::set<std::pair<int, AnimatedProperty>>;

void import_animation(GltfSource& source, std::size_t index, const std::vector<int>& scene_node, AnimatedPlaces& taken,
                      Scene& scene) {
    const tinygltf::Animation& animation = source.model.animations[index];
    std::vector<AnimationChannel> channels;
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
        const tinygltf::AnimationChannel& from = animation.channels[i];
        const std::string place = fmt::format("animations[{}].channels[{}]", index, i);
        const auto sampler = static_cast<std::size_t>(from.sampler);
        if (sampler >= animation.samplers.size()) refuse("index out of range", place + ".sampler");
        const std::optional<AnimatedProperty> property = property_of(from.target_path);
        if (!property) {
            warn_once(source, "animations of other things than nodes' placements are ignored");
            continue;
        }
        const int node = from.target_node < 0 ? kNone : scene_node[static_cast<std::size_t>(from.target_node)];
        if (node == kNone) continue;
        channels.push_back(read_channel(source, animation.samplers[sampler], *property,
                                        fmt::format("animations[{}].samplers[{}]", index, sampler)));
        channels.back().node = node;
    }
    const double length_s = length_of(channels);
    for (AnimationChannel& channel : channels) {
        channel.loop_s = length_s;
        // Files hold animations to choose from (walk, run); we play the first that moves a node.
        if (!taken.emplace(channel.node, channel.property).second) {
            warn_once(source, "of several animations of a node the first one plays");
            continue;
        }
        scene.channels.push_back(std::move(channel));
    }
}

}  // namespace

void import_animations(GltfSource& source, const std::vector<int>& scene_node, Scene& scene) {
    AnimatedPlaces taken;
    for (std::size_t i = 0; i < source.model.animations.size(); ++i) {
        import_animation(source, i, scene_node, taken, scene);
    }
}

}  // namespace lw::scene
