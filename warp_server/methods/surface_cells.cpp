#include "warp_server/methods/surface_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "warp_server/methods/surface_classify.h"

namespace lw {
namespace {

struct LinkEnds {
    int link;
    std::size_t a;
    std::size_t b;
};

CornerGroups groups_of(int links) {
    constexpr std::array<LinkEnds, 6> kEnds{{{kLinkTop, 0, 1},
                                             {kLinkBottom, 2, 3},
                                             {kLinkLeft, 0, 2},
                                             {kLinkRight, 1, 3},
                                             {kLinkFalling, 0, 3},
                                             {kLinkRising, 1, 2}}};
    std::array<std::size_t, 4> root{0, 1, 2, 3};
    for (const LinkEnds& ends : kEnds) {
        if ((links & ends.link) == 0) continue;
        const std::size_t from = std::max(root[ends.a], root[ends.b]);
        const std::size_t to = std::min(root[ends.a], root[ends.b]);
        std::replace(root.begin(), root.end(), from, to);
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

// The smaller of the steps to linked neighbours; 0 without one.
float smaller_step(bool has_before, float before, bool has_after, float after) {
    if (has_before && has_after) return std::abs(before) < std::abs(after) ? before : after;
    if (has_before) return before;
    return has_after ? after : 0.0F;
}

float step_along_x(const SurfaceLinks& links, int x, int y) {
    const DepthImage& depth = links.pixels().depth;
    const bool before = x > 0 && links.to_right(x - 1, y);
    const bool after = x + 1 < depth.width() && links.to_right(x, y);
    const float own = depth.at(x, y);
    return smaller_step(before, before ? own - depth.at(x - 1, y) : 0.0F, after,
                        after ? depth.at(x + 1, y) - own : 0.0F);
}

float step_along_y(const SurfaceLinks& links, int x, int y) {
    const DepthImage& depth = links.pixels().depth;
    const bool before = y > 0 && links.down(x, y - 1);
    const bool after = y + 1 < depth.height() && links.down(x, y);
    const float own = depth.at(x, y);
    return smaller_step(before, before ? own - depth.at(x, y - 1) : 0.0F, after,
                        after ? depth.at(x, y + 1) - own : 0.0F);
}

bool holds(std::uint8_t corners, std::size_t corner) { return (corners >> corner & 1) != 0; }

// Mean of the steps a0-a1 and b0-b1 that the group holds; false when it holds neither pair.
bool mean_step(std::uint8_t corners, const std::array<float, 4>& depth, std::size_t a0, std::size_t a1, std::size_t b0,
               std::size_t b1, float& step) {
    const bool first = holds(corners, a0) && holds(corners, a1);
    const bool second = holds(corners, b0) && holds(corners, b1);
    if (!first && !second) return false;
    const float sum = (first ? depth[a1] - depth[a0] : 0.0F) + (second ? depth[b1] - depth[b0] : 0.0F);
    step = first && second ? 0.5F * sum : sum;
    return true;
}

// The plane nearest to all four corners.
CellSurface surface_through(const std::array<float, 4>& depth, ObjectId object_id) {
    const float gradient_x = 0.5F * ((depth[1] - depth[0]) + (depth[3] - depth[2]));
    const float gradient_y = 0.5F * ((depth[2] - depth[0]) + (depth[3] - depth[1]));
    const float sum =
        depth[0] + (depth[1] - gradient_x) + (depth[2] - gradient_y) + (depth[3] - gradient_x - gradient_y);
    return {object_id, 0.25F * sum, gradient_x, gradient_y};
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

bool cell_surface(const SurfaceLinks& links, int x, int y, std::uint8_t corners, CellSurface& surface) {
    const CpuPixels& pixels = links.pixels();
    const int x1 = std::min(x + 1, links.size_px().x - 1);
    const int y1 = std::min(y + 1, links.size_px().y - 1);
    const std::array<glm::ivec2, 4> at{glm::ivec2{x, y}, {x1, y}, {x, y1}, {x1, y1}};
    const glm::ivec2 first = at[static_cast<std::size_t>(std::countr_zero(corners))];
    surface.object_id = pixels.object_id.at(first.x, first.y);
    // What is linked is of one object and usable.
    const bool alone = std::has_single_bit(corners);
    if (alone && !is_usable_depth(pixels.depth.at(first.x, first.y))) return false;
    const std::array<float, 4> depth{pixels.depth.at(x, y), pixels.depth.at(x1, y), pixels.depth.at(x, y1),
                                     pixels.depth.at(x1, y1)};
    if (corners == kAllCorners) {
        surface = surface_through(depth, surface.object_id);
        return true;
    }
    const bool has_x = mean_step(corners, depth, 0, 1, 2, 3, surface.gradient_x);
    const bool has_y = mean_step(corners, depth, 0, 2, 1, 3, surface.gradient_y);
    float members = 0.0F;
    float pixel_step_x = 0.0F;
    float pixel_step_y = 0.0F;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (!holds(corners, corner)) continue;
        members += 1.0F;
        if (!has_x) pixel_step_x += step_along_x(links, at[corner].x, at[corner].y);
        if (!has_y) pixel_step_y += step_along_y(links, at[corner].x, at[corner].y);
    }
    if (!has_x) surface.gradient_x = pixel_step_x / members;
    if (!has_y) surface.gradient_y = pixel_step_y / members;
    float sum = 0.0F;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (!holds(corners, corner)) continue;
        const float right = (corner & 1U) != 0 ? surface.gradient_x : 0.0F;
        const float down = (corner & 2U) != 0 ? surface.gradient_y : 0.0F;
        sum += depth[corner] - right - down;
    }
    surface.depth = sum / members;
    return true;
}

}  // namespace lw
