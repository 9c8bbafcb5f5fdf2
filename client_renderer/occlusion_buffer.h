#pragma once
/// A small depth image on the CPU that knows, for every pixel, a distance beyond which nothing can be seen.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/box_list.h"
#include "core/camera.h"

namespace lw {

/// A convex solid as half spaces: inside where dot(normal, position_world) <= offset for all six.
struct ConvexSolid {
    std::array<glm::dvec4, 6> planes_world{};  ///< xyz outward normal (unit), w offset in metres
};

/// Hidden means hidden for every sample position inside a pixel, and for every pixel that a box may touch: solids are
/// drawn only where they cover a whole pixel of the buffer, at the greatest distance of their front within it, and
/// boxes are tested with every pixel they may reach. So it never hides what could be seen, at any resolution of the
/// picture.
///
/// One value per pixel, and the farthest of each tile above it, kept up to date: tests may come between solids. One
/// thread at a time.
class OcclusionBuffer {
public:
    static constexpr int kLongestSide_px = 256;  ///< of the buffer; a picture of 1024 has 4 x 4 pixels per pixel of it
    static constexpr int kParts = 4;             ///< parts of a pixel on each axis whose coverage is known
    static constexpr int kTileX = 16;
    static constexpr int kTileY = 8;

    /// Clears it (nothing is hidden) and takes the view of `camera`.
    void begin(const Camera& camera);

    /// Draws a solid. Ignored when the eye is inside it.
    void add(const ConvexSolid& solid) { add(solid, 0, size_px_.y - 1, 0.0F); }
    /// The same, for one that lies inside `bounds_world`: faster, and nearer at its edges.
    void add(const ConvexSolid& solid, const scene::Bounds& bounds_world);

    /// What became of the candidates of a split().
    struct Split {
        std::uint64_t hidden = 0;
        std::uint64_t between_samples = 0;  ///< too thin to meet a sample of the picture
    };
    /// Appends those of the candidates (indices into `boxes`) that may be seen, in their order. A box that reaches
    /// before the near plane may be seen.
    Split split(const BoxList& boxes, std::span<const std::uint32_t> candidates,
                std::vector<std::uint32_t>& seen) const;

    /// True when a box (not empty, of single precision) is hidden by what was drawn so far.
    [[nodiscard]] bool hides(const glm::vec3& box_min_world, const glm::vec3& box_max_world) const;

    [[nodiscard]] glm::ivec2 size_px() const { return size_px_; }
    /// Reverse distances, 1 / metres, row by row, stride() apart: nothing beyond is seen. 0: nothing is hidden.
    [[nodiscard]] const float* pixels() const { return pixels_.data(); }
    /// Parts of pixels (bit kParts * row + column) that hide more than the whole pixel does: what lies beyond parts()
    /// there. Valid where a bit is set.
    [[nodiscard]] const std::int32_t* masks() const { return masks_.data(); }
    [[nodiscard]] const float* parts() const { return parts_.data(); }
    [[nodiscard]] int stride() const { return stride_; }
    /// Reverse distances within a tile.
    struct Tile {
        float farthest = 0.0F;  ///< beyond it the whole tile hides
        float nearest = 0.0F;   ///< before it nothing in the tile hides
    };
    [[nodiscard]] const Tile* tiles() const { return tiles_.data(); }
    [[nodiscard]] int tile_stride() const { return stride_ / kTileX; }

    /// A ray of the buffer: relative_at(x_px, y_px) = origin + x_px * per_px_x + y_px * per_px_y, at distance_m = 1.
    struct Rays {
        glm::dvec3 origin{0.0};
        glm::dvec3 per_px_x{0.0};
        glm::dvec3 per_px_y{0.0};
    };
    /// Eye space of the buffer, for the tests: rows of px_from_relative.
    struct View {
        std::array<float, 3> eye_world{};
        std::array<float, 3> x_px{};  ///< x_px * distance = dot(x_px, relative)
        std::array<float, 3> y_px{};
        std::array<float, 3> distance{};
        float near_m = 0.05F;
        std::array<float, 2> samples_per_px{1.0F, 1.0F};  ///< of the picture, on each axis
        std::array<float, 2> size_px{};                   ///< of the buffer
    };
    [[nodiscard]] const View& view() const { return view_; }

private:
    void add(const ConvexSolid& solid, int first_row, int last_row, float least_reverse);

    glm::ivec2 size_px_{0};
    int stride_ = 0;
    int rows_ = 0;
    glm::dvec3 eye_world_{0.0};
    Rays rays_;
    View view_;
    std::vector<float> pixels_;
    std::vector<float> parts_;
    std::vector<std::int32_t> masks_;
    std::vector<Tile> tiles_;
};

}  // namespace lw
