#pragma once
/// Where streets, blocks and lots lie. Blocks form a grid; every block is a rectangle of pavement with two rows of
/// houses back to back; street centre lines run between blocks. x = 0 is a street that runs north (-Z), the viewer's.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lw::scene {

inline constexpr double kRoadWidth_m = 10.0;     ///< two lanes and two parking strips, kerb to kerb
inline constexpr double kPavementWidth_m = 3.5;  ///< kerb to lot
inline constexpr double kKerbHeight_m = 0.13;
inline constexpr double kLane_m = 1.65;         ///< lane centre from the street's centre line; traffic keeps right
inline constexpr double kCornerRadius_m = 3.0;  ///< of kerbs
inline constexpr double kCourtDepth_m = 14.0;   ///< between the backs of the two rows
inline constexpr int kLotsPerRow = 5;
inline constexpr int kLotsPerBlock = 2 * kLotsPerRow;

inline constexpr double kBlockSizeX_m = 2.0 * 12.0 + kCourtDepth_m + 2.0 * kPavementWidth_m;
inline constexpr double kBlockSizeZ_m = kLotsPerRow * 12.0 + 2.0 * kPavementWidth_m;
inline constexpr double kPitchX_m = kBlockSizeX_m + kRoadWidth_m;
inline constexpr double kPitchZ_m = kBlockSizeZ_m + kRoadWidth_m;

/// A block of the grid; column and row from the south-west corner of the town.
struct Block {
    int column = 0;
    int row = 0;
    glm::dvec3 centre_m{0.0};  ///< on the road's level
    int houses = 0;            ///< 0..kLotsPerBlock; a block without any is a park
};

/// A rectangle of blocks that cars drive around.
struct BlockGroup {
    int column = 0;
    int row = 0;
    int columns = 1;
    int rows = 1;
};

struct CityLayout {
    int columns = 0;  ///< even: the start street has as many blocks on either side
    int rows = 0;
    std::vector<Block> blocks;       ///< row by row
    std::vector<BlockGroup> groups;  ///< a partition of the blocks, none across the start street

    /// Centre line of the street west of column `column`, and south of row `row`; 0..columns, 0..rows.
    [[nodiscard]] double street_x_m(int column) const { return (column - columns / 2) * kPitchX_m; }
    [[nodiscard]] double street_z_m(int row) const { return (1 - row) * kPitchZ_m; }
};

/// Pure; `buildings` >= 0.
[[nodiscard]] CityLayout make_city_layout(int buildings, std::uint64_t seed);

}  // namespace lw::scene
