#include "scene/built_in.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "scene/chairs.h"
#include "scene/city.h"
#include "scene/gltf.h"
#include "scene/rooms.h"

namespace lw::scene {

namespace {

struct WholeNumber {
    std::string_view key;
    double low;
    double high;
    double standard;
};

constexpr std::array<WholeNumber, 3> kCityKeys{{
    {"buildings", 1.0, kMaxCityBuildings, 120.0},
    {"seed", 0.0, 4294967295.0, 1.0},
    {"movers", 0.0, 65535.0, 32.0},
}};

constexpr std::array<WholeNumber, 3> kRoomsKeys{{
    {"rooms", 4.0, kMaxRooms, 240.0},
    {"seed", 0.0, 4294967295.0, 1.0},
    {"movers", 0.0, kMaxTrolleys, 8.0},
}};

constexpr std::array<WholeNumber, 4> kChairsKeys{{
    {"chairs", 0.0, kMaxChairs, 500.0},
    {"scooters", 0.0, kMaxChairs, 500.0},
    {"movers", 0.0, 2.0 * kMaxChairs, 0.0},
    {"seed", 0.0, 4294967295.0, 1.0},
}};

/// Checks that every key is known and every value a whole number in its range.
Status validated(std::string_view scene, const Parameters& parameters, std::span<const WholeNumber> known) {
    for (const auto& [key, value] : parameters) {
        const WholeNumber* match = nullptr;
        std::string names;
        for (const WholeNumber& parameter : known) {
            if (parameter.key == key) match = &parameter;
            names += fmt::format("{}{}", names.empty() ? "" : ", ", parameter.key);
        }
        if (match == nullptr) {
            return Error{fmt::format("the scene {} has no parameter '{}'", scene, key), fmt::format("--param {}", key),
                         fmt::format("use one of {}", names)};
        }
        if (!(value >= match->low && value <= match->high) || value != std::floor(value)) {
            return Error{fmt::format("{} is not a possible value", value), fmt::format("--param {}", key),
                         fmt::format("give a whole number from {:.0f} to {:.0f}", match->low, match->high)};
        }
    }
    return Done{};
}

double value_of(const Parameters& parameters, const WholeNumber& key) {
    const auto found = parameters.find(key.key);
    return found == parameters.end() ? key.standard : found->second;
}

Result<Scene> make_city_of(const Parameters& parameters) {
    const Status valid = validated("city", parameters, kCityKeys);
    if (!valid.ok()) return valid.error();
    CityParameters city;
    city.buildings = static_cast<int>(value_of(parameters, kCityKeys[0]));
    city.seed = static_cast<std::uint64_t>(value_of(parameters, kCityKeys[1]));
    if (parameters.contains("movers")) city.movers = static_cast<int>(value_of(parameters, kCityKeys[2]));
    return make_city(city);
}

Result<Scene> make_rooms_of(const Parameters& parameters) {
    const Status valid = validated("rooms", parameters, kRoomsKeys);
    if (!valid.ok()) return valid.error();
    return make_rooms({static_cast<int>(value_of(parameters, kRoomsKeys[0])),
                       static_cast<int>(value_of(parameters, kRoomsKeys[2])),
                       static_cast<std::uint64_t>(value_of(parameters, kRoomsKeys[1]))});
}

Result<Scene> make_chairs_of(const Parameters& parameters) {
    const Status valid = validated("chairs", parameters, kChairsKeys);
    if (!valid.ok()) return valid.error();
    ChairsParameters chairs;
    chairs.chairs = static_cast<int>(value_of(parameters, kChairsKeys[0]));
    chairs.scooters = static_cast<int>(value_of(parameters, kChairsKeys[1]));
    chairs.movers = static_cast<int>(value_of(parameters, kChairsKeys[2]));
    chairs.seed = static_cast<std::uint64_t>(value_of(parameters, kChairsKeys[3]));
    return make_chairs(chairs);
}

std::string names_of_built_in_scenes() {
    std::string names;
    for (const BuiltInScene& scene : built_in_scenes())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", scene.name);
    return names;
}

}  // namespace

std::vector<BuiltInScene> built_in_scenes() {
    return {{"city", "a town of instanced houses with trees, railings, wires and cars", "buildings, seed, movers"},
            {"rooms", "an office building of furnished rooms, with doors and windows", "rooms, seed, movers"},
            {"chairs", "curved chairs and scooters strewn over a floor, every one a full mesh",
             "chairs, scooters, movers, seed"}};
}

Result<Scene> make_built_in(std::string_view name, const Parameters& parameters) {
    if (name == "city") return make_city_of(parameters);
    if (name == "rooms") return make_rooms_of(parameters);
    if (name == "chairs") return make_chairs_of(parameters);
    return Error{"no built-in scene has this name", std::string{name},
                 fmt::format("use one of {}", names_of_built_in_scenes())};
}

Result<Scene> load_scene(const std::string& name_or_path, const Parameters& parameters) {
    for (const BuiltInScene& scene : built_in_scenes()) {
        if (scene.name == name_or_path) return make_built_in(name_or_path, parameters);
    }
    const std::filesystem::path path{name_or_path};
    const std::string extension = path.extension().string();
    if (extension != ".gltf" && extension != ".glb") {
        return Error{"neither a built-in scene nor a glTF file", name_or_path.empty() ? "''" : name_or_path,
                     fmt::format("use one of {}, or a path that ends in .gltf or .glb", names_of_built_in_scenes())};
    }
    if (!parameters.empty()) {
        return Error{"a glTF file takes no parameters", fmt::format("--param {}", parameters.begin()->first),
                     "leave it out, or name a built-in scene"};
    }
    return load_gltf(path);
}

}  // namespace lw::scene
