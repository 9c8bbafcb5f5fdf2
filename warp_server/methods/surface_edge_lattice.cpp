#include "warp_server/methods/surface_edge_lattice.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>

#include "warp_server/methods/surface_lattice.h"

namespace lw {
namespace {

// Four 15-bit values side by side: a row of the quarters of two neighbouring pixels, or three nodes of a lattice.
using FourValues = std::uint64_t;
constexpr FourValues kLowBits = 0x7FFF7FFF7FFF7FFFU;

// Of each of the four, rounded down.
FourValues mean_of(FourValues a, FourValues b) { return (a + b) >> 1U & kLowBits; }

class EdgeLatticeWriter {
public:
    explicit EdgeLatticeWriter(const QuarterParts& parts)
        : parts_{&parts}, last_px_{parts.own().size_px() / kLatticeSteps - 1} {}

    // Of the surface that has `corners` of the cell at (x, y).
    void write(int x, int y, unsigned corners, std::uint16_t* values) const {
        const PixelPair upper = pixel_pair(x, y, corners & 3U);
        // Beyond the last row its lower quarters count again.
        const bool has_lower = y < last_px_.y;
        const PixelPair lower = has_lower ? pixel_pair(x, y + 1, corners >> 2U) : upper;
        for (int channel = 0; channel < 4; ++channel) {
            const FourValues row1 = row_of(upper, 1, channel);
            const FourValues row2 = has_lower ? row_of(lower, 0, channel) : row1;
            const FourValues row3 = has_lower ? row_of(lower, 1, channel) : row1;
            write_means(row_of(upper, 0, channel), row1, values);
            write_means(row1, row2, values + kEdgeNodes);
            write_means(row2, row3, values + 2 * kEdgeNodes);
            values += kEdgeChannel;
        }
    }

private:
    // The pixel at (x, y) and the one to its right.
    struct PixelPair {
        const std::uint16_t* own;  // first quarter, red
        FourValues own_mask;       // of the quarters in pixels that are the surface's
        const QuarterShares* left;
        const QuarterShares* right;
        bool repeats_last;  // there is none to the right
    };

    [[nodiscard]] PixelPair pixel_pair(int x, int y, unsigned own_bits) const {
        static constexpr std::array<FourValues, 4> kMasks{0, 0xFFFFFFFFU, 0xFFFFFFFF00000000U, ~FourValues{0}};
        const bool is_last = x == last_px_.x;
        return {parts_->own().row(kLatticeSteps * y, 0) + kLatticeSteps * x, kMasks[own_bits], &parts_->shares(x, y),
                &parts_->shares(is_last ? x : x + 1, y), is_last};
    }

    [[nodiscard]] FourValues row_of(const PixelPair& pair, int row, int channel) const {
        const auto at = static_cast<std::size_t>(row);
        const auto of_both = [&](const QuarterValues& left, const QuarterValues& right) {
            return FourValues{left[at]} | FourValues{right[at]} << 32U;
        };
        const auto index = static_cast<std::size_t>(channel);
        FourValues own = 0;
        if (channel == kEdgeShareChannel) {
            own = of_both(pair.left->own, pair.right->own);
        } else {
            const LinearImage& image = parts_->own();
            std::memcpy(&own, pair.own + row * image.row_stride() + channel * image.channel_stride(), sizeof(own));
        }
        const FourValues others = of_both(pair.left->others[index], pair.right->others[index]);
        const FourValues values = (own & pair.own_mask) | (others & ~pair.own_mask);
        if (!pair.repeats_last) return values;
        constexpr FourValues kTwice = 0x0001000100000000U;
        return (values & 0xFFFFFFFFU) | (values >> 16U & 0xFFFFU) * kTwice;
    }

    static void write_means(FourValues above, FourValues below, std::uint16_t* nodes) {
        const FourValues mean = mean_of(mean_of(above, above >> 16U), mean_of(below, below >> 16U));
        std::memcpy(nodes, &mean, kEdgeNodes * sizeof(std::uint16_t));
    }

    const QuarterParts* parts_;
    glm::ivec2 last_px_;
};

struct EdgeColumns {
    int first = 0;
    int end = 0;
};

// From the first edge cell of a tile's row to the last one.
EdgeColumns edge_columns(std::uint32_t cells) {
    constexpr std::uint32_t kFirstOfFour = 0x11111111U;
    const std::uint32_t any = (cells | cells >> 1U | cells >> 2U | cells >> 3U) & kFirstOfFour;
    const std::uint32_t whole = cells & cells >> 1U & cells >> 2U & cells >> 3U & kFirstOfFour;
    const std::uint32_t edges = any & ~whole;
    if (edges == 0) return {};
    return {std::countr_zero(edges) / 4, (31 - std::countl_zero(edges)) / 4 + 1};
}

// Numbers those in tiles after those by themselves; how many numbers there are.
std::size_t number_edges(PreparedSurface& prepared) {
    PatchList& edges = prepared.edges;
    auto next = static_cast<std::int32_t>(edges.size());
    edges.edge_number.resize(edges.size());
    for (std::int32_t i = 0; i < next; ++i) edges.edge_number[static_cast<std::size_t>(i)] = i;
    SurfaceTiles& tiles = prepared.tiles;
    tiles.edge_number.resize(tiles.cells.size());
    for (std::size_t row = 0; row < tiles.cells.size(); ++row) {
        const EdgeColumns columns = edge_columns(tiles.cells[row]);
        tiles.edge_number[row] = next - columns.first;
        next += columns.end - columns.first;
    }
    return static_cast<std::size_t>(next);
}

}  // namespace

void make_edge_lattices(const QuarterParts& parts, PreparedSurface& prepared) {
    prepared.edge_lattices.resize(kEdgeValues * number_edges(prepared));
    const EdgeLatticeWriter writer{parts};
    const auto values_of = [&](std::int32_t number) {
        return prepared.edge_lattices.data() + kEdgeValues * static_cast<std::ptrdiff_t>(number);
    };
    const PatchList& edges = prepared.edges;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        writer.write(static_cast<int>(edges.x[i]), static_cast<int>(edges.y[i]), edges.corners[i],
                     values_of(edges.edge_number[i]));
    }
    const SurfaceTiles& tiles = prepared.tiles;
    for (std::size_t row = 0; row < tiles.cells.size(); ++row) {
        const EdgeColumns columns = edge_columns(tiles.cells[row]);
        const std::size_t tile = row / kTileSize;
        const int x = static_cast<int>(tiles.surfaces.x[tile]);
        const int y = static_cast<int>(tiles.surfaces.y[tile]) + static_cast<int>(row % kTileSize);
        for (int column = columns.first; column < columns.end; ++column) {
            const auto corners = static_cast<std::uint8_t>(tiles.cells[row] >> (4 * column) & kAllCorners);
            if (corners == 0 || corners == kAllCorners) continue;
            writer.write(x + column, y, corners, values_of(tiles.edge_number[row] + column));
        }
    }
}

}  // namespace lw
