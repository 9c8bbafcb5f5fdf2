#pragma once
/// What `surface` works out about a layer once, before it is published: the pieces of plane that it is made of.

#include <cstdint>
#include <memory>
#include <vector>

#include "core/image.h"
#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/methods/id_counts.h"
#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/surface_bounds.h"
#include "warp_server/methods/surface_lattice.h"

namespace lw {

/// A cell is the unit square between the centres of four neighbouring pixels; its corners are numbered 0 (x, y),
/// 1 (x + 1, y), 2 (x, y + 1), 3 (x + 1, y + 1). Beyond the last column and row the last pixels count again.
///
/// A patch is a rectangle of cells on one plane of one object. Its origin is the centre of its first cell's corner 0,
/// at the pixel (x, y); places in it are relative to that. One value per patch in each vector.
struct PatchList {
    std::vector<float> x;  ///< whole numbers: column of the origin's pixel
    std::vector<float> y;
    std::vector<float> depth;       ///< of the plane at the origin
    std::vector<float> gradient_x;  ///< depth per pixel
    std::vector<float> gradient_y;
    std::vector<float> left;  ///< the rectangle, relative to the origin, with what it overlaps its neighbours
    std::vector<float> right;
    std::vector<float> top;
    std::vector<float> bottom;
    std::vector<ObjectId> object_id;
    std::vector<std::uint8_t> corners;  ///< of an edge cell: bits 1 << corner of the pixels on this surface; else 15
    std::vector<std::int32_t> edge_number;  ///< of edge cells, where they have lattices: which is theirs

    [[nodiscard]] std::size_t size() const { return x.size(); }
    void clear();
    void reserve(std::size_t count);
};
inline constexpr std::uint8_t kAllCorners = 15;

/// Squares of this many cells in which surfaces meet.
inline constexpr int kTileSize = 8;

/// What lies in those squares, one entry per surface that has a plane there: a patch that holds all of its cells, and
/// which they are.
struct SurfaceTiles {
    PatchList surfaces;                ///< origins at the tiles' first cells; `corners` says nothing
    std::vector<std::uint32_t> cells;  ///< kTileSize rows each; of the cell in column c, 4 c bits up, its corners
    /// kTileSize each, where edge cells have lattices: the number of the one in column c is c more.
    std::vector<std::int32_t> edge_number;
    /// Where the edge cells of the tile end, relative to the origin: they overlap other tiles' less than whole cells.
    std::vector<float> edge_left;
    std::vector<float> edge_right;
    std::vector<float> edge_top;
    std::vector<float> edge_bottom;
};

/// Where pieces that lie together in the source end in each list. What is drawn region by region finds the source, and
/// the target it lands on, in the processor's cache.
struct SurfaceRegion {
    std::size_t blocks = 0;
    std::size_t patches = 0;
    std::size_t tiles = 0;
    std::size_t edges = 0;
};

struct PreparedSurface final : PreparedLayer {
    glm::ivec2 size_px{0};
    PatchList blocks;    ///< large patches; they and the small ones cover their target pixels wholly
    PatchList patches;   ///< small ones: where surfaces are curved, and around edges
    SurfaceTiles tiles;  ///< edges between planes, and what lies around them
    PatchList edges;  ///< single cells in which surfaces meet, one entry per surface: cover by their corners' weights
    std::vector<SurfaceRegion> regions;        ///< in the order of the lists: each begins where the one before ends
    std::vector<RegionBounds> bounds;          ///< of each
    std::vector<float> region_costs;           ///< of each: estimated, of drawing it (surface_costs.h)
    ColourLattice lattice;                     ///< colours between pixels, or empty
    std::vector<std::uint16_t> edge_lattices;  ///< by edge cells' numbers (surface_edge_lattice.h), or empty
    LinearImage linear;                        ///< with the pixels' shares as alpha, where they are known
    std::vector<IdCount> id_counts;            ///< by ascending id
};

/// What will draw the surfaces.
enum class SurfaceUse {
    cpu_kernels,  ///< wants `linear`
    gl,           ///< has textures
};

/// Any thread. `pixels` may hold bad depths: they are on no surface.
/// @param unseen_step  depths of what stands still that lie no farther apart are one surface (unseen_depth_step); >= 0
/// @param threads      from two on, a thread of its own converts the colours meanwhile; the result is the same
[[nodiscard]] std::shared_ptr<const PreparedSurface> classify_surfaces(const CpuPixels& pixels,
                                                                       SurfaceUse use = SurfaceUse::cpu_kernels,
                                                                       float unseen_step = 0.0F, int threads = 1);

/// Depths `before, a, b, after` along a line: do a and b lie on one surface? Their difference must be small, or
/// continue the slope on one side: depth is affine in the pixel coordinates on every plane, at any slant. Negative
/// depths are on no surface; background (0) is its own.
/// @param unseen_step  a difference that is small at any depth (unseen_depth_step)
[[nodiscard]] bool on_one_surface(float before, float a, float b, float after, float unseen_step = 0.0F);

}  // namespace lw
