#pragma once
/// Plan of the built-in office building: which rooms there are and where the openings between them lie.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lw::scene {

inline constexpr double kRoomWidth_m = 5.0;  ///< along the corridor (x)
inline constexpr double kRoomDepth_m = 6.0;  ///< away from it (z)
inline constexpr double kRoomHeight_m = 2.9;
inline constexpr double kWall_m = 0.2;      ///< thickness of walls
inline constexpr double kSlab_m = 0.3;      ///< thickness of floors
inline constexpr double kCorridor_m = 2.4;  ///< width of corridors
inline constexpr double kLobby_m = 5.0;     ///< width of the lobby that joins the corridors of a storey
inline constexpr double kStorey_m = kRoomHeight_m + kSlab_m;
inline constexpr int kBlocks = 3;  ///< corridors per storey, with a row of rooms on either side
inline constexpr double kRoomPitch_m = kRoomWidth_m + kWall_m;
inline constexpr double kBlockPitch_m = 2.0 * kRoomDepth_m + kCorridor_m + 3.0 * kWall_m;

enum class RoomUse : std::uint8_t { outside, office, meeting, lounge, archive, corridor, lobby };

/// The clear space of a room; walls and slabs lie between the spaces.
struct RoomSpace {
    RoomUse use = RoomUse::outside;
    glm::dvec3 min_m{0.0};
    glm::dvec3 max_m{0.0};
    bool door_towards_plus_z = false;  ///< of rooms: where their corridor lies
};

/// An opening in the wall (axis x or z) or slab (axis y) between two rooms: a rectangle across the axis.
struct Opening3 {
    std::array<int, 2> rooms{};  ///< on the lower and on the upper side along the axis; 0: outside
    int axis = 0;
    glm::dvec3 min_m{0.0};  ///< both surfaces of the wall
    glm::dvec3 max_m{0.0};
    bool has_leaf = false;  ///< a door stands open in it
};

struct RoomsLayout {
    std::vector<RoomSpace> rooms;  ///< 0 is the outside
    std::vector<Opening3> openings;
    glm::dvec3 min_m{0.0};  ///< outer surfaces of the building
    glm::dvec3 max_m{0.0};
    int storeys = 1;
    int rooms_per_row = 1;
};

/// Pure; at least `rooms` furnished rooms.
[[nodiscard]] RoomsLayout make_rooms_layout(int rooms, std::uint64_t seed);

}  // namespace lw::scene
