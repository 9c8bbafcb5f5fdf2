#pragma once
/// Puts the city's meshes into place: houses on lots, furniture, trees and parked cars along the kerbs.

#include <map>
#include <string>
#include <vector>

#include "scene/city_building.h"
#include "scene/city_layout.h"
#include "scene/random.h"
#include "scene/scene.h"

namespace lw::scene {

/// The scene while it grows, with the meshes that repeat. One thread.
class CityAssembly {
public:
    /// Makes materials, textures and all repeated meshes.
    explicit CityAssembly(std::uint64_t seed);

    [[nodiscard]] Scene& scene() { return scene_; }
    [[nodiscard]] int root() const { return 0; }
    /// Meshes of cars.
    [[nodiscard]] const std::vector<int>& vehicles() const { return vehicles_; }

    int add_mesh(Mesh mesh);
    /// A node without a mesh below the root.
    int group(std::string name);
    /// An instance on a node of its own; returns the node.
    int place(int mesh, int parent, std::string name, const glm::dvec3& position, double turns_about_y = 0.0,
              double scale = 1.0);

    /// Ground, houses or park, and everything on the pavements of a block.
    void add_block(const Block& block);

private:
    /// A long side of a block: its street runs along z.
    struct Row;

    void add_houses(const Block& block, const Row& row, int group, Random& random);
    void add_lot_front(const Row& row, double along, bool shop, int group, Random& random);
    void add_row_pavement(const Row& row, int group, Random& random);
    void add_short_side(const Block& block, double side, int group, Random& random);
    void add_corner_rails(const Row& row, int group);
    void add_court(const Block& block, int group, Random& random);
    void add_park(const Block& block, int group, Random& random);
    void add_lamp(int group, const glm::dvec3& foot, double turns);

    std::uint64_t seed_;
    Scene scene_;
    std::vector<int> vehicles_;
    std::vector<int> trees_;
    std::vector<std::vector<int>> houses_;  ///< by LotKind
    std::vector<bool> is_shop_;             ///< by mesh
    int block_ground_ = 0;
    int park_ground_ = 0;
    int lamp_post_ = 0;
    int guard_rail_ = 0;
    int iron_fence_ = 0;
    int utility_pole_ = 0;
    int wire_span_ = 0;
    int service_drop_ = 0;
    int span_lamp_ = 0;
    int bench_ = 0;
    int litter_bin_ = 0;
    int bollard_ = 0;
    int post_box_ = 0;
    int street_sign_ = 0;
    int planter_ = 0;
    int cafe_table_ = 0;
    int bicycle_ = 0;
    int tree_pit_ = 0;
    int hedge_ = 0;
};

}  // namespace lw::scene
