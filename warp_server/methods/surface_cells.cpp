#include "warp_server/methods/surface_cells.h"

#include <algorithm>
#include <cmath>

namespace lw {
namespace {

CornerGroups groups_of(int links) {
    constexpr std::array<std::array<int, 3>, 6> kEnds{{{kLinkTop, 0, 1},
                                                       {kLinkBottom, 2, 3},
                                                       {kLinkLeft, 0, 2},
                                                       {kLinkRight, 1, 3},
                                                       {kLinkFalling, 0, 3},
                                                       {kLinkRising, 1, 2}}};
    std::array<std::size_t, 4> root{0, 1, 2, 3};
    for (const auto& [link, a, b] : kEnds) {
        if ((links & link) == 0) continue;
        const std::size_t from = root[static_cast<std::size_t>(b)];
        const std::size_t to = root[static_cast<std::size_t>(a)];
        std::replace(root.begin(), root.end(), std::max(from, to), std::min(from, to));
    }
    CornerGroups groups;
    for (std::size_t first = 0; first < 4; ++first) {
        int corners = 0;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (root[corner] == first) corners |= 1 << corner;
        }
        if (corners == 0) continue;
        groups.corners[static_cast<std::size_t>(groups.count++)] = static_cast<std::uint8_t>(corners);
    }
    return groups;
}

// The smaller step to a linked neighbour along x (or y); 0 without one.
struct LinkedSteps {
    const CpuPixels* pixels;
    const PreparedSurface* prepared;

    [[nodiscard]] bool has_link(int x, int y, CellLink link) const {
        return x >= 0 && y >= 0 && (prepared->cell_links.at(x, y) & link) != 0;
    }
    [[nodiscard]] float depth(int x, int y) const {
        return pixels->depth.at(std::min(x, prepared->size_px.x - 1), std::min(y, prepared->size_px.y - 1));
    }
    [[nodiscard]] static float smaller(bool has_before, float before, bool has_after, float after) {
        if (has_before && has_after) return std::abs(before) < std::abs(after) ? before : after;
        if (has_before) return before;
        return has_after ? after : 0.0F;
    }
    [[nodiscard]] float along_x(int x, int y) const {
        const bool before = has_link(x - 1, y, kLinkTop);
        const bool after = x + 1 < prepared->size_px.x && has_link(x, y, kLinkTop);
        const float own = depth(x, y);
        return smaller(before, before ? own - depth(x - 1, y) : 0.0F, after, after ? depth(x + 1, y) - own : 0.0F);
    }
    [[nodiscard]] float along_y(int x, int y) const {
        const bool before = has_link(x, y - 1, kLinkLeft);
        const bool after = y + 1 < prepared->size_px.y && has_link(x, y, kLinkLeft);
        const float own = depth(x, y);
        return smaller(before, before ? own - depth(x, y - 1) : 0.0F, after, after ? depth(x, y + 1) - own : 0.0F);
    }
};

// Mean of the steps between the pairs of corners that the group holds; false when it holds neither pair.
bool mean_step(std::uint8_t corners, const std::array<float, 4>& depth, std::size_t a0, std::size_t a1, std::size_t b0,
               std::size_t b1, float& step) {
    const auto holds = [corners](std::size_t p, std::size_t q) {
        return (corners >> p & 1) != 0 && (corners >> q & 1) != 0;
    };
    const bool first = holds(a0, a1);
    const bool second = holds(b0, b1);
    if (!first && !second) return false;
    const float sum = (first ? depth[a1] - depth[a0] : 0.0F) + (second ? depth[b1] - depth[b0] : 0.0F);
    step = first && second ? 0.5F * sum : sum;
    return true;
}

}  // namespace

const CornerGroups& corner_groups(std::uint8_t links) {
    static const std::array<CornerGroups, 64> table = [] {
        std::array<CornerGroups, 64> all;
        for (std::size_t bits = 0; bits < all.size(); ++bits) all[bits] = groups_of(static_cast<int>(bits));
        return all;
    }();
    return table[links & 63U];
}

bool cell_surface(const CpuPixels& pixels, const PreparedSurface& prepared, int x, int y, std::uint8_t corners,
                  CellSurface& surface) {
    const LinkedSteps steps{&pixels, &prepared};
    const int x1 = std::min(x + 1, prepared.size_px.x - 1);
    const int y1 = std::min(y + 1, prepared.size_px.y - 1);
    const std::array<glm::ivec2, 4> at{glm::ivec2{x, y}, {x1, y}, {x, y1}, {x1, y1}};
    std::array<float, 4> depth{};
    int members = 0;
    glm::vec2 pixel_gradient{0.0F};
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if ((corners >> corner & 1) == 0) continue;
        depth[corner] = pixels.depth.at(at[corner].x, at[corner].y);
        if (!is_usable_depth(depth[corner])) return false;
        surface.object_id = pixels.object_id.at(at[corner].x, at[corner].y);
        pixel_gradient +=
            glm::vec2{steps.along_x(at[corner].x, at[corner].y), steps.along_y(at[corner].x, at[corner].y)};
        ++members;
    }
    SourcePlane& plane = surface.plane;
    plane.gradient_x = pixel_gradient.x / static_cast<float>(members);
    plane.gradient_y = pixel_gradient.y / static_cast<float>(members);
    mean_step(corners, depth, 0, 1, 2, 3, plane.gradient_x);
    mean_step(corners, depth, 0, 2, 1, 3, plane.gradient_y);
    float sum = 0.0F;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if ((corners >> corner & 1) == 0) continue;
        const float to_centre_x = (corner & 1U) != 0 ? -0.5F : 0.5F;
        const float to_centre_y = (corner & 2U) != 0 ? -0.5F : 0.5F;
        sum += depth[corner] + to_centre_x * plane.gradient_x + to_centre_y * plane.gradient_y;
    }
    plane.depth = sum / static_cast<float>(members);
    plane.origin_x_px = static_cast<float>(x) + 1.0F;  // corner 0 is the pixel centre (x + 0.5, y + 0.5)
    plane.origin_y_px = static_cast<float>(y) + 1.0F;
    surface.corners = corners;
    return true;
}

}  // namespace lw
