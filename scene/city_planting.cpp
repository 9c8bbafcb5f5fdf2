#include "scene/city_planting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/city_ground.h"
#include "scene/city_materials.h"
#include "scene/city_street_furniture.h"
#include "scene/city_trees.h"
#include "scene/city_vehicles.h"

namespace lw::scene {

namespace {

constexpr double kHalfBlockX_m = 0.5 * kBlockSizeX_m;
constexpr double kHalfBlockZ_m = 0.5 * kBlockSizeZ_m;
constexpr double kWireSpan_m = kPitchZ_m / 3.0;
const glm::vec3 kLampLight{5.0f, 3.6f, 1.9f};

}  // namespace

/// Local frame of a row: `along` runs to the right as seen from its street, `inward` from the kerb towards the houses.
struct CityAssembly::Row {
    glm::dvec3 kerb_m;  ///< middle of the kerb, on the pavement
    double side;        ///< -1 west side of the block, +1 east side
    double turns;       ///< of what faces the street

    [[nodiscard]] glm::dvec3 at(double along, double inward) const {
        return kerb_m + glm::dvec3{-side * inward, 0.0, -side * along};
    }
};

CityAssembly::CityAssembly(std::uint64_t seed) : seed_{seed}, houses_(3) {
    add_city_materials(scene_);
    scene_.nodes.push_back({"city", kNone, {}, {1.0, 0.0, 0.0, 0.0}, glm::dvec3{1.0}, {}});
    for (BuildingVariant& variant : make_building_variants(seed)) {
        const bool shop = variant.mesh.name.find("shop") != std::string::npos;
        houses_[static_cast<std::size_t>(variant.lot)].push_back(add_mesh(std::move(variant.mesh)));
        is_shop_.resize(scene_.meshes.size(), false);
        is_shop_.back() = shop;
    }
    for (Mesh& tree : make_trees(seed)) trees_.push_back(add_mesh(std::move(tree)));
    for (Mesh& vehicle : make_vehicles()) vehicles_.push_back(add_mesh(std::move(vehicle)));
    block_ground_ = add_mesh(make_block_ground());
    park_ground_ = add_mesh(make_park_ground());
    lamp_post_ = add_mesh(make_lamp_post());
    guard_rail_ = add_mesh(make_guard_rail());
    iron_fence_ = add_mesh(make_iron_fence());
    utility_pole_ = add_mesh(make_utility_pole());
    wire_span_ = add_mesh(make_wire_span(kWireSpan_m));
    service_drop_ = add_mesh(make_service_drop());
    span_lamp_ = add_mesh(make_span_lamp(kRoadWidth_m + 2.0 * kPavementWidth_m + 2.0));
    bench_ = add_mesh(make_bench());
    litter_bin_ = add_mesh(make_litter_bin());
    bollard_ = add_mesh(make_bollard());
    post_box_ = add_mesh(make_post_box());
    street_sign_ = add_mesh(make_street_sign());
    planter_ = add_mesh(make_planter(seed));
    cafe_table_ = add_mesh(make_cafe_table());
    bicycle_ = add_mesh(make_bicycle());
    tree_pit_ = add_mesh(make_tree_pit());
    hedge_ = add_mesh(make_hedge(seed));
}

int CityAssembly::add_mesh(Mesh mesh) {
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene_.meshes.size()) - 1;
}

int CityAssembly::group(std::string name) {
    Node node;
    node.name = std::move(name);
    node.parent = root();
    scene_.nodes.push_back(std::move(node));
    return static_cast<int>(scene_.nodes.size()) - 1;
}

int CityAssembly::place(int mesh, int parent, std::string name, const glm::dvec3& position, double turns_about_y,
                        double scale) {
    const Direction2 half = direction_of_turns(0.5 * turns_about_y);
    Node node;
    node.name = std::move(name);
    node.parent = parent;
    node.translation = position;
    node.rotation = glm::dquat{half.cosine, 0.0, half.sine, 0.0};
    node.scale = glm::dvec3{scale};
    scene_.nodes.push_back(std::move(node));
    const int index = static_cast<int>(scene_.nodes.size()) - 1;
    scene_.instances.push_back({mesh, index, glm::dmat4{1.0}, 0});
    return index;
}

void CityAssembly::add_block(const Block& block) {
    Random random{seed_,
                  100000u + static_cast<std::uint64_t>(block.row) * 4096u + static_cast<std::uint64_t>(block.column)};
    const int node = group(fmt::format("block {}-{}", block.column, block.row));
    const bool park = block.houses == 0;
    place(park ? park_ground_ : block_ground_, node, park ? "park ground" : "ground", block.centre_m);
    const glm::dvec3 pavement = block.centre_m + glm::dvec3{0.0, kKerbHeight_m, 0.0};
    for (const double side : {-1.0, 1.0}) {
        const Row row{pavement + glm::dvec3{side * kHalfBlockX_m, 0.0, 0.0}, side, 0.25 * side};
        if (!park) add_houses(block, row, node, random);
        add_row_pavement(row, node, random);
        add_corner_rails(row, node);
        add_short_side(block, side, node, random);
    }
    if (park) {
        add_park(block, node, random);
    } else {
        add_court(block, node, random);
    }
}

void CityAssembly::add_houses(const Block& block, const Row& row, int group, Random& random) {
    int last = -1;
    for (int lot = 0; lot < kLotsPerRow; ++lot) {
        const double along = (lot - 0.5 * (kLotsPerRow - 1)) * kLotWidth_m;
        // The west row is filled first.
        const int number = row.side < 0.0 ? lot : kLotsPerRow + lot;
        if (number >= block.houses) {
            const int tree = trees_[static_cast<std::size_t>(kStreetTrees + random.below(3))];
            place(tree, group, "garden tree", row.at(along, kPavementWidth_m + 6.0), random.unit());
            continue;
        }
        const LotKind kind = lot == 0                 ? LotKind::left_end
                             : lot + 1 == kLotsPerRow ? LotKind::right_end
                                                      : LotKind::middle;
        const std::vector<int>& choices = houses_[static_cast<std::size_t>(kind)];
        int mesh = random.pick(choices);
        if (mesh == last) mesh = random.pick(choices);
        last = mesh;
        // Neighbours never stand in one line: their walls overlap by nothing and would fight for the same pixels.
        const double setback = random.between(0.02, 0.3) + (lot % 2 == 0 ? 0.0 : 0.35);
        place(mesh, group, fmt::format("house {}-{}.{}", block.column, block.row, number + 1),
              row.at(along, kPavementWidth_m + setback), row.turns);
        add_lot_front(row, along, is_shop_[static_cast<std::size_t>(mesh)], group, random);
    }
}

void CityAssembly::add_lot_front(const Row& row, double along, bool shop, int group, Random& random) {
    if (shop && random.chance(0.75)) {
        for (const double shift : {-1.6, 1.4}) {
            place(cafe_table_, group, "cafe table", row.at(along + shift, 1.75),
                  row.turns + random.between(-0.03, 0.03));
        }
        return;
    }
    const double shift = random.between(-4.5, 4.5);
    switch (random.below(6)) {
        case 0:
            place(bench_, group, "bench", row.at(along + shift, 2.7), row.turns);
            break;
        case 1:
            for (int i = 0; i < 3; ++i)
                place(bicycle_, group, "bicycle", row.at(along + shift + 0.75 * i, 1.15), row.turns + 0.25);
            break;
        case 2:
        case 3:
            place(planter_, group, "planter", row.at(along - 2.2, 2.75), random.unit());
            place(planter_, group, "planter", row.at(along + 2.3, 2.75), random.unit());
            break;
        default:
            break;
    }
}

void CityAssembly::add_lamp(int group, const glm::dvec3& foot, double turns) {
    place(lamp_post_, group, "lamp post", foot, turns);
    const Direction2 d = direction_of_turns(turns);
    const glm::dvec3 lantern = foot + glm::dvec3{kLampReach_m * d.sine, kLampHeight_m - 0.1, kLampReach_m * d.cosine};
    scene_.point_lights.push_back({lantern, kLampLight, 9.0f});
}

void CityAssembly::add_row_pavement(const Row& row, int group, Random& random) {
    const bool wires = row.side > 0.0;  // the poles stand west of each street
    for (const double along : {-19.5, -10.0, 0.0, 10.0, 19.5}) {
        const double shift = wires ? (along == 0.0 ? 4.2 : along) : along;
        if (random.chance(0.12)) continue;
        place(tree_pit_, group, "tree pit", row.at(shift, 1.0));
        place(trees_[static_cast<std::size_t>(random.below(kStreetTrees))], group, "street tree", row.at(shift, 1.0),
              random.unit(), random.between(0.86, 1.06));
    }
    for (const double along : wires ? std::array{-31.2, -14.5, 14.5, 31.2} : std::array{-25.9, -5.0, 14.7, 25.9}) {
        add_lamp(group, row.at(along, 0.75), row.turns);
    }
    if (wires) {
        for (const double along : {-kWireSpan_m, 0.0, kWireSpan_m}) {
            place(utility_pole_, group, "utility pole", row.at(along, 0.75), row.turns);
            place(wire_span_, group, "wires", row.at(along, 0.75), row.turns);
            place(service_drop_, group, "service drop", row.at(along, 0.75), row.turns);
        }
    } else {
        for (const double along : {-17.0, 16.0}) {
            const glm::dvec3 middle = row.at(along, -0.5 * kRoadWidth_m);
            place(span_lamp_, group, "span lamp", middle);
        }
    }
    for (double along = -21.5; along < 24.0; along += 6.5) {
        if (!random.chance(0.38)) continue;
        glm::dvec3 at = row.at(along + random.between(-0.4, 0.4), -1.12);
        at.y = 0.0;
        // Parked the way the lane drives: with the block on the right.
        place(random.pick(vehicles_), group, "parked car", at, row.side < 0.0 ? 0.5 : 0.0);
    }
    place(litter_bin_, group, "litter bin", row.at(-21.2, 0.7));
    if (random.chance(0.3)) place(post_box_, group, "post box", row.at(-25.5, 2.9), row.turns);
    place(street_sign_, group, "street sign", row.at(30.9, 1.7), row.turns);
    for (const double along : {-31.9, -30.6, 30.6, 31.9})
        place(bollard_, group, "bollard", row.at(along, 1.3 - 0.4 * (32.0 - std::abs(along))));
}

void CityAssembly::add_corner_rails(const Row& row, int group) {
    // Beside the zebras, along the kerb.
    for (const double along : {-24.3, -22.3, 22.3, 24.3}) {
        place(guard_rail_, group, "guard rail", row.at(along, 0.3), row.turns);
    }
}

void CityAssembly::add_short_side(const Block& block, double side, int group, Random& random) {
    // The street along x, north (-1) or south (+1) of the block.
    const glm::dvec3 kerb = block.centre_m + glm::dvec3{0.0, kKerbHeight_m, side * kHalfBlockZ_m};
    const double turns = side > 0.0 ? 0.0 : 0.5;
    const auto at = [&](double x, double inward) { return kerb + glm::dvec3{x, 0.0, -side * inward}; };
    for (const double x : {-10.0, 10.0}) add_lamp(group, at(x, 0.6), turns);
    for (const double x : {-4.5, 4.5}) {
        place(tree_pit_, group, "tree pit", at(x, 1.0));
        place(trees_[static_cast<std::size_t>(random.below(kStreetTrees))], group, "street tree", at(x, 1.0),
              random.unit(), random.between(0.86, 1.06));
    }
    place(bench_, group, "bench", at(0.0, 2.2), turns);
    if (random.chance(0.5)) {
        glm::dvec3 parked = at(random.between(-6.0, 6.0), -1.12);
        parked.y = 0.0;
        place(random.pick(vehicles_), group, "parked car", parked, side < 0.0 ? 0.25 : -0.25);
    }
}

void CityAssembly::add_court(const Block& block, int group, Random& random) {
    const glm::dvec3 ground = block.centre_m + glm::dvec3{0.0, kKerbHeight_m, 0.0};
    for (const double side : {-1.0, 1.0}) {
        for (int i = 0; i < 8; ++i) {
            place(iron_fence_, group, "iron fence",
                  ground + glm::dvec3{(i - 3.5) * kRailModule_m, 0.0, side * (kHalfBlockZ_m - kPavementWidth_m - 0.4)});
        }
    }
    for (int i = 0; i < 6; ++i) {
        const glm::dvec3 at{(i % 2 == 0 ? -1.0 : 1.0) * random.between(2.6, 4.4), 0.04,
                            -26.0 + 10.4 * i + random.between(-2.0, 2.0)};
        place(trees_[static_cast<std::size_t>(kStreetTrees + random.below(3))], group, "garden tree", ground + at,
              random.unit(), random.between(0.8, 1.0));
    }
}

void CityAssembly::add_park(const Block& block, int group, Random& random) {
    const glm::dvec3 ground = block.centre_m + glm::dvec3{0.0, kKerbHeight_m, 0.0};
    for (int i = 0; i < 26; ++i) {
        const double x = (random.chance(0.5) ? 1.0 : -1.0) * random.between(3.5, 16.5);
        const double z = (random.chance(0.5) ? 1.0 : -1.0) * random.between(7.5, 32.0);
        place(trees_[static_cast<std::size_t>(kStreetTrees + random.below(3))], group, "park tree",
              ground + glm::dvec3{x, 0.05, z}, random.unit(), random.between(0.85, 1.15));
    }
    for (const double side : {-1.0, 1.0}) {
        for (const double z : {-24.0, -16.0, 16.0, 24.0}) {
            place(bench_, group, "park bench", ground + glm::dvec3{side * 2.2, 0.05, z}, -0.25 * side);
        }
        for (int i = 0; i < 13; ++i) {
            for (const double end : {-1.0, 1.0}) {
                place(hedge_, group, "hedge", ground + glm::dvec3{side * 18.0, 0.05, end * (7.0 + 2.0 * i)}, 0.25);
            }
        }
        for (const double z : {-10.0, 10.0}) add_lamp(group, ground + glm::dvec3{side * 2.3, 0.05, z}, -0.25 * side);
    }
}

}  // namespace lw::scene
