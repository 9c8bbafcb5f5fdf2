#include "scene/city.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/city_building.h"
#include "scene/city_ground.h"
#include "scene/city_layout.h"
#include "scene/city_materials.h"
#include "scene/city_planting.h"
#include "scene/city_traffic.h"
#include "scene/city_vehicles.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr int kUsualMovers = 32;
constexpr std::size_t kLitLamps = 24;  ///< lamps nearest to the start give light

void add_crossings(CityAssembly& city, const CityLayout& layout) {
    const int mesh = city.add_mesh(make_crossing());
    for (int row = 0; row <= layout.rows; ++row) {
        for (int column = 0; column <= layout.columns; ++column) {
            const glm::dvec3 at{layout.street_x_m(column), 0.0, layout.street_z_m(row)};
            city.place(mesh, city.root(), fmt::format("crossing {}-{}", column, row), at);
        }
    }
}

/// Cars shared out over the loops, nearest to the start first, in turn.
Status add_traffic(CityAssembly& city, const CityLayout& layout, const CityParameters& parameters) {
    std::vector<TrafficLoop> loops;
    for (const BlockGroup& group : layout.groups) loops.emplace_back(layout, group);
    std::stable_sort(loops.begin(), loops.end(), [](const TrafficLoop& a, const TrafficLoop& b) {
        return glm::dot(a.centre_m(), a.centre_m()) < glm::dot(b.centre_m(), b.centre_m());
    });
    int capacity = 0;
    for (const TrafficLoop& loop : loops) capacity += loop.capacity();
    const int movers = parameters.movers.value_or(std::min(kUsualMovers, capacity));
    if (movers > capacity) {
        return Error{fmt::format("{} movers are too many", movers), "--param movers",
                     fmt::format("at most {} cars fit {} buildings", capacity, parameters.buildings)};
    }
    std::vector<int> cars(loops.size(), 0);
    for (int left = movers; left > 0;) {
        for (std::size_t i = 0; i < loops.size() && left > 0; ++i) {
            if (cars[i] == loops[i].capacity()) continue;
            ++cars[i];
            --left;
        }
    }
    Random random{parameters.seed, 20};
    const int group = city.group("traffic");
    int number = 0;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const double first = random.unit();
        for (int k = 0; k < cars[i]; ++k) {
            // Up to a quarter of the gap of irregularity keeps the capacity's safe gap.
            const double share = (k + 0.25 * random.unit()) / cars[i] + first;
            const double phase = (share - std::floor(share)) * loops[i].round_s();
            const CarState start = loops[i].at(phase);
            const int node = city.place(random.pick(city.vehicles()), group, fmt::format("car {}", ++number),
                                        start.position_m, start.heading_turns);
            loops[i].animate(node, phase, city.scene().channels);
        }
    }
    return Done{};
}

void add_church(CityAssembly& city, const CityLayout& layout) {
    // At the end of the start street, beyond the last crossing.
    const double z = layout.street_z_m(layout.rows) - 26.0;
    city.place(city.add_mesh(make_church()), city.root(), "church", {0.0, 0.0, z});
}

void add_country(CityAssembly& city, const CityLayout& layout, std::uint64_t seed) {
    const double half_x = 0.5 * (layout.columns + 1) * kPitchX_m;
    const double half_z = 0.5 * (layout.rows + 1) * kPitchZ_m;
    const glm::dvec3 centre{0.0, 0.0, 0.5 * (layout.street_z_m(0) + layout.street_z_m(layout.rows))};
    city.place(city.add_mesh(make_country(std::max({half_x, half_z, 150.0}), seed)), city.root(), "country", centre);
}

/// Keeps the lights nearest to the start.
void keep_near_lights(Scene& scene) {
    const glm::dvec3 start = scene.start_pose->position_m;
    std::stable_sort(scene.point_lights.begin(), scene.point_lights.end(),
                     [&](const PointLight& a, const PointLight& b) {
                         const glm::dvec3 da = a.position_world - start;
                         const glm::dvec3 db = b.position_world - start;
                         return glm::dot(da, da) < glm::dot(db, db);
                     });
    if (scene.point_lights.size() > kLitLamps) scene.point_lights.resize(kLitLamps);
}

}  // namespace

Result<Scene> make_city(const CityParameters& parameters) {
    const CityLayout layout = make_city_layout(parameters.buildings, parameters.seed);
    CityAssembly city{parameters.seed};
    city.scene().name = "city";
    add_country(city, layout, parameters.seed);
    add_crossings(city, layout);
    add_church(city, layout);
    for (const Block& block : layout.blocks) city.add_block(block);
    const Status traffic = add_traffic(city, layout, parameters);
    if (!traffic.ok()) return traffic.error();

    Scene scene = std::move(city.scene());
    // On the pavement south of a crossing, looking north along the start street and a little across it.
    const Direction2 half = direction_of_turns(0.5 * 8.0 / 360.0);
    scene.start_pose = Pose{{7.0, kKerbHeight_m + 1.65, 17.3}, {half.cosine, 0.0, half.sine, 0.0}};
    scene.sun.direction_to_sun_world = {0.42, 0.62, 0.5};
    keep_near_lights(scene);
    scene.finish();
    return scene;
}

}  // namespace lw::scene
