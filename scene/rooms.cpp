#include "scene/rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/city_materials.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"
#include "scene/rooms_furniture.h"
#include "scene/rooms_layout.h"
#include "scene/rooms_shell.h"

namespace lw::scene {

namespace {

/// The scene while it grows. One thread.
class Furnisher {
public:
    Furnisher(const RoomsLayout& layout, std::uint64_t seed) : layout_{layout}, seed_{seed} {
        scene_.name = "rooms";
        add_city_materials(scene_);
        root_ = add_node("rooms", kNone, {});
        for (Mesh& mesh : make_furniture(seed)) scene_.meshes.push_back(std::move(mesh));
    }

    Scene run(int movers) {
        add_outside();
        for (int room = 1; room < static_cast<int>(layout_.rooms.size()); ++room) add_room(room);
        add_portals();
        add_trolleys(movers);
        add_lights();
        return std::move(scene_);
    }

private:
    int add_node(std::string name, int parent, const glm::dvec3& translation, double turns = 0.0,
                 const glm::dvec3& scale = glm::dvec3{1.0}) {
        const Direction2 half = direction_of_turns(0.5 * turns);
        Node node;
        node.name = std::move(name);
        node.parent = parent;
        node.translation = translation;
        node.rotation = glm::dquat{half.cosine, 0.0, half.sine, 0.0};
        node.scale = scale;
        scene_.nodes.push_back(std::move(node));
        return static_cast<int>(scene_.nodes.size()) - 1;
    }
    void place_mesh(int mesh, int parent, std::string name, const glm::dvec3& at, double turns = 0.0) {
        const int node = add_node(std::move(name), parent, at, turns);
        scene_.instances.push_back({mesh, node, glm::dmat4{1.0}, 0});
    }
    void place(Furniture what, int parent, const glm::dvec3& at, double turns = 0.0) {
        const int mesh = static_cast<int>(what);
        place_mesh(mesh, parent, scene_.meshes[static_cast<std::size_t>(mesh)].name, at, turns);
    }
    int add_mesh(Mesh mesh) {
        scene_.meshes.push_back(std::move(mesh));
        return static_cast<int>(scene_.meshes.size()) - 1;
    }

    void add_outside() {
        place_mesh(add_mesh(make_facade(layout_)), root_, "facade", {});
        MeshBuilder ground{"ground"};
        ground.use_material(kGrass, texture_size_m(kGrass));
        constexpr double kReach_m = 120.0;
        constexpr int kTiles = 24;
        const glm::dvec3 centre = 0.5 * (layout_.min_m + layout_.max_m);
        for (int i = 0; i < kTiles; ++i) {
            for (int j = 0; j < kTiles; ++j) {
                const double x0 = centre.x - kReach_m + i * (2.0 * kReach_m / kTiles);
                const double z0 = centre.z - kReach_m + j * (2.0 * kReach_m / kTiles);
                const double step = 2.0 * kReach_m / kTiles;
                const double y = layout_.min_m.y;
                ground.polygon({{x0, y, z0}, {x0, y, z0 + step}, {x0 + step, y, z0 + step}, {x0 + step, y, z0}});
            }
        }
        place_mesh(add_mesh(ground.take()), root_, "ground", {});
    }

    void add_room(int room) {
        const RoomSpace& space = layout_.rooms[static_cast<std::size_t>(room)];
        const int cell = add_node(fmt::format("cell {}", room), root_, {});
        const glm::dvec3 half = 0.5 * (space.max_m - space.min_m);
        (void)add_node("extent", cell, space.min_m + half, 0.0, half);
        // In the building's own space: neighbours then share the very same corners, and nothing shines through.
        place_mesh(add_mesh(make_room_shell(layout_, room)), cell, "walls", {});
        Random random{seed_, 1000U + static_cast<std::uint64_t>(room)};
        const int furniture = add_node("furniture", cell, space.min_m);
        furniture_.push_back(furniture);
        if (space.use == RoomUse::corridor) {
            furnish_corridor(furniture, space, random);
        } else if (space.use == RoomUse::lobby) {
            furnish_lobby(furniture, space);
        } else {
            furnish_room(furniture, space, random);
        }
    }

    /// Rooms are furnished as if their door were at z = 0 (towards -Z); others are turned by half a turn.
    struct RoomFrame {
        bool turned;
        [[nodiscard]] glm::dvec3 at(double x, double y, double z) const {
            return turned ? glm::dvec3{kRoomWidth_m - x, y, kRoomDepth_m - z} : glm::dvec3{x, y, z};
        }
        [[nodiscard]] double turns(double t) const { return turned ? t + 0.5 : t; }
    };

    void furnish_room(int cell, const RoomSpace& space, Random& random) {
        const RoomFrame frame{space.door_towards_plus_z};
        const auto put = [&](Furniture what, double x, double y, double z, double turns) {
            place(what, cell, frame.at(x, y, z), frame.turns(turns));
        };
        // A radiator at the far wall, lamps at the ceiling, pictures on the walls beside.
        put(Furniture::radiator, 2.2, 0.0, kRoomDepth_m, 0.5);
        for (const double z : {1.8, 4.2}) put(Furniture::ceiling_lamp, 2.5, kRoomHeight_m, z, 0.0);
        put(Furniture::waste_bin, 4.6, 0.0, 0.4, 0.0);
        put(Furniture::picture, 0.0, 1.6, 2.6, 0.25);
        put(Furniture::picture, kRoomWidth_m, 1.6, 2.6, -0.25);
        if (random.chance(0.6)) put(Furniture::plant, 4.4, 0.0, 5.4, random.unit());
        switch (space.use) {
            case RoomUse::meeting:
                put(Furniture::meeting_table, 2.5, 0.0, 3.1, 0.0);
                for (int i = 0; i < 8; ++i) {
                    const double x = 1.5 + (i % 4) * 0.65;
                    put(Furniture::chair, x, 0.0, i < 4 ? 2.2 : 4.0, i < 4 ? 0.0 : 0.5);
                }
                put(Furniture::bookcase, 1.2, 0.0, 5.98, 0.5);
                break;
            case RoomUse::lounge:
                put(Furniture::sofa, 0.05, 0.0, 3.6, 0.25);
                put(Furniture::sofa, 4.95, 0.0, 3.6, -0.25);
                put(Furniture::low_table, 2.5, 0.0, 3.6, 0.0);
                put(Furniture::floor_lamp, 0.5, 0.0, 5.5, 0.0);
                put(Furniture::plant, 4.5, 0.0, 1.2, random.unit());
                put(Furniture::bookcase, 2.5, 0.0, 5.98, 0.5);
                break;
            case RoomUse::archive:
                for (int i = 0; i < 4; ++i) {
                    const double z = 1.9 + i * 0.95;
                    for (const double x : {1.3, 2.4, 3.5}) put(Furniture::bookcase, x, 0.0, z, 0.0);
                }
                for (int i = 0; i < 3; ++i) put(Furniture::filing_cabinet, 0.02, 0.0, 2.0 + i * 0.5, 0.25);
                break;
            default:
                for (const double z : {2.4, 4.4}) {
                    put(Furniture::desk, 1.6, 0.0, z, 0.0);
                    put(Furniture::office_chair, 1.6, 0.0, z + 1.05, 0.5 + random.between(-0.08, 0.08));
                    put(Furniture::desk, 3.5, 0.0, z, 0.0);
                    put(Furniture::office_chair, 3.5, 0.0, z + 1.05, 0.5 + random.between(-0.08, 0.08));
                }
                put(Furniture::bookcase, 4.98, 0.0, 1.9, -0.25);
                put(Furniture::bookcase, 0.02, 0.0, 1.9, 0.25);
                put(Furniture::filing_cabinet, 4.98, 0.0, 4.0, -0.25);
                break;
        }
    }

    void furnish_corridor(int cell, const RoomSpace& space, Random& random) {
        const double length = space.max_m.x - space.min_m.x;
        for (double x = 1.9; x < length; x += kRoomPitch_m) {
            place(Furniture::ceiling_lamp, cell, {x, kRoomHeight_m, 0.5 * kCorridor_m});
            if (random.chance(0.3)) place(Furniture::plant, cell, {x + 2.7, 0.0, 0.35}, random.unit());
        }
    }

    void furnish_lobby(int cell, const RoomSpace& space) {
        const double depth = space.max_m.z - space.min_m.z;
        for (double z = 11.0; z + 3.0 < depth; z += 6.4) {
            place(Furniture::sofa, cell, {0.05, 0.0, z}, 0.25);
            place(Furniture::low_table, cell, {1.6, 0.0, z});
            place(Furniture::plant, cell, {0.6, 0.0, z + 1.7}, 0.1);
            place(Furniture::floor_lamp, cell, {0.6, 0.0, z - 1.6});
        }
        for (double z = 1.5; z < depth; z += 4.0) place(Furniture::ceiling_lamp, cell, {3.6, kRoomHeight_m, z});
    }

    void add_portals() {
        for (const Opening3& opening : layout_.openings) {
            const int axis = opening.axis;
            const glm::dvec3 centre = 0.5 * (opening.min_m + opening.max_m);
            const glm::dvec3 half = 0.5 * (opening.max_m - opening.min_m);
            // The unit square's x and y go along the next two axes.
            Node node;
            node.name = fmt::format("portal {}-{}", opening.rooms[0], opening.rooms[1]);
            node.parent = root_;
            glm::dmat4 world_from_square{0.0};
            world_from_square[0][(axis + 1) % 3] = half[(axis + 1) % 3];
            world_from_square[1][(axis + 2) % 3] = half[(axis + 2) % 3];
            world_from_square[2][axis] = 1.0;
            world_from_square[3] = glm::dvec4{centre, 1.0};
            node.matrix = world_from_square;
            scene_.nodes.push_back(std::move(node));
            if (opening.axis == 1) {
                const int both = add_node(fmt::format("cell {}+{}", opening.rooms[0], opening.rooms[1]), root_, {});
                place(Furniture::stairs, both, {opening.min_m.x, opening.min_m.y - kRoomHeight_m, opening.min_m.z});
            } else if (opening.has_leaf) {
                add_leaf(opening);
            }
        }
    }

    /// The leaf stands in the room, not in the corridor, at a right angle to the wall.
    void add_leaf(const Opening3& opening) {
        const auto use_of = [&](int room) { return layout_.rooms[static_cast<std::size_t>(room)].use; };
        for (const std::size_t side : {1U, 0U}) {
            const int room = opening.rooms[side];
            const RoomUse use = use_of(room);
            if (use == RoomUse::outside || use == RoomUse::corridor || use == RoomUse::lobby) continue;
            const glm::dvec3& origin = layout_.rooms[static_cast<std::size_t>(room)].min_m;
            const int axis = opening.axis;
            glm::dvec3 hinge = opening.min_m - origin;
            hinge[axis] = side == 1 ? opening.max_m[axis] - origin[axis] : opening.min_m[axis] - origin[axis];
            // The leaf points along +Z, turned into the room.
            const double turns = axis == 2 ? (side == 1 ? 0.0 : 0.5) : (side == 1 ? 0.25 : -0.25);
            if (axis == 2) hinge.x -= side == 1 ? 0.09 : 0.05;
            if (axis == 0) hinge.z -= side == 1 ? 0.05 : 0.09;
            place(Furniture::door_leaf, furniture_[static_cast<std::size_t>(room) - 1], hinge, turns);
            return;
        }
    }

    void add_trolleys(int count) {
        std::vector<const RoomSpace*> corridors;
        for (const RoomSpace& room : layout_.rooms) {
            if (room.use == RoomUse::corridor) corridors.push_back(&room);
        }
        const int group = add_node("trolleys", root_, {});
        for (int i = 0; i < count; ++i) {
            const RoomSpace& corridor = *corridors[static_cast<std::size_t>(i) % corridors.size()];
            const auto lane = static_cast<double>(static_cast<std::size_t>(i) / corridors.size());
            const float y = static_cast<float>(corridor.min_m.y);
            const float z = static_cast<float>(corridor.min_m.z + 1.6 - 0.7 * std::fmod(lane, 2.0));
            const float from = static_cast<float>(corridor.min_m.x + 1.0);
            const float to = static_cast<float>(corridor.max_m.x - 1.0);
            const int node = add_node(fmt::format("trolley {}", i + 1), group, {from, y, z}, 0.25);
            scene_.instances.push_back({static_cast<int>(Furniture::trolley), node, glm::dmat4{1.0}, 0});
            AnimationChannel channel;
            channel.node = node;
            const double seconds = std::max(2.0, 2.0 * double{to - from} / 0.9);
            channel.loop_s = seconds;
            channel.times_s = {0.0F, static_cast<float>(0.5 * seconds), static_cast<float>(seconds)};
            const bool forth = i % 2 == 0;
            const glm::vec4 a{forth ? from : to, y, z, 0.0F};
            const glm::vec4 b{forth ? to : from, y, z, 0.0F};
            channel.values = {a, b, a};
            scene_.channels.push_back(std::move(channel));
        }
    }

    void add_lights() {
        for (const RoomSpace& room : layout_.rooms) {
            if (room.use != RoomUse::corridor || room.min_m.y > 1.0) continue;
            for (double x = 1.9; x < room.max_m.x && scene_.point_lights.size() < 24; x += 2.0 * kRoomPitch_m) {
                const glm::dvec3 at = room.min_m + glm::dvec3{x, kRoomHeight_m - 0.7, 0.5 * kCorridor_m};
                scene_.point_lights.push_back({at, {2.4F, 2.1F, 1.6F}, 7.0F});
            }
        }
    }

    const RoomsLayout& layout_;
    std::uint64_t seed_;
    Scene scene_;
    int root_ = 0;
    std::vector<int> furniture_;  ///< nodes of the rooms 1.., at their minima
};

}  // namespace

Scene make_rooms(const RoomsParameters& parameters) {
    const RoomsLayout layout = make_rooms_layout(parameters.rooms, parameters.seed);
    Scene scene = Furnisher{layout, parameters.seed}.run(parameters.movers);
    // In the middle corridor of the ground floor, looking along it and a little into the rooms on the right.
    const Direction2 half = direction_of_turns(0.5 * -80.0 / 360.0);
    const double z = kBlockPitch_m * (kBlocks / 2) + kRoomDepth_m + kWall_m + 0.5 * kCorridor_m;
    scene.start_pose = Pose{{1.2, 1.65, z}, {half.cosine, 0.0, half.sine, 0.0}};
    scene.sun.direction_to_sun_world = {0.42, 0.62, 0.5};
    scene.finish();
    return scene;
}

}  // namespace lw::scene
