#include "scene/rooms_layout.h"

#include <algorithm>

#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr int kMostRoomsPerRow = 20;
constexpr double kDoorWidth_m = 0.95;
constexpr double kDoorHeight_m = 2.1;
constexpr double kSill_m = 0.9;
constexpr double kLintel_m = 2.3;

class Planner {
public:
    Planner(int rooms, std::uint64_t seed) : random_{seed, 77} {
        const int per_storey = 2 * kBlocks * kMostRoomsPerRow;
        layout_.storeys = (rooms + per_storey - 1) / per_storey;
        const int rows = 2 * kBlocks * layout_.storeys;
        layout_.rooms_per_row = std::max(1, (rooms + rows - 1) / rows);
        layout_.rooms.emplace_back();  // the outside
        depth_ = kBlocks * kBlockPitch_m - kWall_m;
        length_ = layout_.rooms_per_row * kRoomPitch_m - kWall_m;
        layout_.min_m = {-kLobby_m - 2.0 * kWall_m, -kSlab_m, -kWall_m};
        layout_.max_m = {length_ + kWall_m, layout_.storeys * kStorey_m, depth_ + kWall_m};
    }

    RoomsLayout run() {
        for (int storey = 0; storey < layout_.storeys; ++storey) add_storey(storey);
        return std::move(layout_);
    }

private:
    int add_room(RoomUse use, const glm::dvec3& min, const glm::dvec3& size, bool door_towards_plus_z = false) {
        layout_.rooms.push_back({use, min, min + size, door_towards_plus_z});
        return static_cast<int>(layout_.rooms.size()) - 1;
    }

    void add_storey(int storey) {
        floor_ = storey * kStorey_m;
        const int lobby =
            add_room(RoomUse::lobby, {-kLobby_m - kWall_m, floor_, 0.0}, {kLobby_m, kRoomHeight_m, depth_});
        // Windows along the lobby's outer side.
        for (double z = 2.0; z + 2.4 < depth_; z += 4.2) open_x(0, lobby, -kLobby_m - 2.0 * kWall_m, z, 2.4, false);
        std::vector<int> row_behind;
        for (int block = 0; block < kBlocks; ++block) {
            const double z = block * kBlockPitch_m;
            const std::vector<int> near = add_row(z, true);
            const double corridor_z = z + kRoomDepth_m + kWall_m;
            const int corridor =
                add_room(RoomUse::corridor, {0.0, floor_, corridor_z}, {length_, kRoomHeight_m, kCorridor_m});
            open_x(lobby, corridor, -kWall_m, corridor_z + 0.2, kCorridor_m - 0.4, true);
            open_x(corridor, 0, length_, corridor_z + 0.5, kCorridor_m - 1.0, false);
            const std::vector<int> far = add_row(corridor_z + kCorridor_m + kWall_m, false);
            for (std::size_t i = 0; i < near.size(); ++i) {
                open_to_corridor(near[i], corridor, corridor_z - kWall_m, i, true);
                open_to_corridor(far[i], corridor, corridor_z + kCorridor_m, i, false);
                if (block == 0) add_windows(0, near[i], -kWall_m, i);
                if (block == kBlocks - 1) add_windows(far[i], 0, depth_, i);
                if (!row_behind.empty() && random_.chance(0.12)) {
                    open_z(row_behind[i], near[i], z - kWall_m, room_x(i) + 3.4, kDoorWidth_m, true);
                }
            }
            for (const std::vector<int>* row : {&near, &far}) {
                const RoomSpace& last = layout_.rooms[static_cast<std::size_t>(row->back())];
                open_x(row->back(), 0, length_, last.min_m.z + 1.6, 2.4, false);
            }
            row_behind = far;
        }
        if (storey > 0) {
            // The stairwell: a hole in the slab between two lobbies.
            const glm::dvec3 min{-kLobby_m + 0.6, floor_ - kSlab_m, 4.0};
            layout_.openings.push_back({{lobby_below_, lobby}, 1, min, min + glm::dvec3{1.6, kSlab_m, 4.6}, false});
        }
        lobby_below_ = lobby;
    }

    static double room_x(std::size_t i) { return static_cast<double>(i) * kRoomPitch_m; }

    std::vector<int> add_row(double z, bool door_towards_plus_z) {
        static constexpr std::array kUses{RoomUse::office,  RoomUse::office, RoomUse::office,
                                          RoomUse::meeting, RoomUse::lounge, RoomUse::archive};
        std::vector<int> row;
        for (int i = 0; i < layout_.rooms_per_row; ++i) {
            const glm::dvec3 min{i * kRoomPitch_m, floor_, z};
            row.push_back(
                add_room(random_.pick(kUses), min, {kRoomWidth_m, kRoomHeight_m, kRoomDepth_m}, door_towards_plus_z));
            if (i > 0 && random_.chance(0.3)) {
                const double at = z + (door_towards_plus_z ? 4.6 : 0.5);
                open_x(row[row.size() - 2], row.back(), min.x - kWall_m, at, kDoorWidth_m, true);
            }
        }
        return row;
    }

    void open_to_corridor(int room, int corridor, double z, std::size_t i, bool room_is_lower) {
        const int lower = room_is_lower ? room : corridor;
        const int upper = room_is_lower ? corridor : room;
        open_z(lower, upper, z, room_x(i) + 0.4, kDoorWidth_m, true);
        if (random_.chance(0.35)) open_z(lower, upper, z, room_x(i) + 2.2, 1.8, false);
    }

    void add_windows(int lower, int upper, double z, std::size_t i) {
        open_z(lower, upper, z, room_x(i) + 0.6, 1.6, false);
        open_z(lower, upper, z, room_x(i) + 2.8, 1.6, false);
    }

    /// Through a wall that begins at x.
    void open_x(int lower, int upper, double x, double z, double width, bool door) {
        const double low = floor_ + (door ? 0.0 : kSill_m);
        const double high = floor_ + (door ? kDoorHeight_m : kLintel_m);
        layout_.openings.push_back({{lower, upper}, 0, {x, low, z}, {x + kWall_m, high, z + width}, door});
    }
    void open_z(int lower, int upper, double z, double x, double width, bool door) {
        const double low = floor_ + (door ? 0.0 : kSill_m);
        const double high = floor_ + (door ? kDoorHeight_m : kLintel_m);
        layout_.openings.push_back({{lower, upper}, 2, {x, low, z}, {x + width, high, z + kWall_m}, door});
    }

    RoomsLayout layout_;
    Random random_;
    double depth_ = 0.0;
    double length_ = 0.0;
    double floor_ = 0.0;
    int lobby_below_ = 0;
};

}  // namespace

RoomsLayout make_rooms_layout(int rooms, std::uint64_t seed) { return Planner{rooms, seed}.run(); }

}  // namespace lw::scene
