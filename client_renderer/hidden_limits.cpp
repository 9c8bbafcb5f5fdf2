#include "client_renderer/hidden_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/check.h"

namespace lw {
namespace {

// Surfaces that shift by less against each other are one: half a pixel is not seen through.
constexpr float kOneSurfacePx = 0.5F;
// A hole of more pixels is left to the guard band and to newer frames: looking farther costs time for few pixels.
constexpr int kWidestPx = 48;
// Where a pixel looks for farther surfaces, in eight directions. Silhouettes are longer than they are jagged, so a few
// distances find them.
constexpr std::array kLookPx{1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 34, 48};
static_assert(kLookPx.back() == kWidestPx);
constexpr std::array<glm::ivec2, 8> kDirections{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
constexpr int kTilePx = 8;

class HiddenLimits {
public:
    HiddenLimits(const DepthImage& depth, float px_per_depth) : depth_{depth}, px_per_depth_{px_per_depth} {}

    DepthImage compute() {
        DepthImage limits{depth_.size_px(), 0.0F};
        find_edges();
        for (int y = 0; y < limits.height(); ++y) {
            for (int x = 0; x < limits.width(); ++x) {
                const Reach& reach = reach_.at(x / kTilePx, y / kTilePx);
                if (reach.pixels > 0 && is_needed({x, y}, reach)) limits.at(x, y) = limit_at({x, y});
            }
        }
        return limits;
    }

private:
    [[nodiscard]] float at(glm::ivec2 px) const {
        const float depth = depth_.at(px.x, px.y);
        return depth >= 0.0F && depth <= 1.0F ? depth : 0.0F;
    }
    [[nodiscard]] float clamped_at(glm::ivec2 px) const { return at(glm::clamp(px, glm::ivec2{0}, last_)); }
    [[nodiscard]] bool inside(glm::ivec2 px) const {
        return px.x >= 0 && px.y >= 0 && px.x <= last_.x && px.y <= last_.y;
    }

    // Pixels by which the surfaces at `px` and at its neighbour may come apart; 0 where they are one plane.
    [[nodiscard]] float gap_px(glm::ivec2 px, glm::ivec2 step) const {
        const float a = at(px);
        const float b = at(px + step);
        const float gap = px_per_depth_ * std::abs(a - b);
        if (gap < kOneSurfacePx) return 0.0F;
        const float bend = std::min(std::abs(b - 2.0F * a + clamped_at(px - step)),
                                    std::abs(clamped_at(px + step + step) - 2.0F * b + a));
        return bend < 0.5F * std::abs(a - b) ? 0.0F : gap;
    }

    // What the pixels of a tile have to look for.
    struct Reach {
        int pixels = 0;         // as far as the widest gap whose edge is that near; 0: no edge is near
        float farthest = 1.0F;  // depth of the farthest surface at an edge that near
    };
    // The edges in a tile.
    struct Edges {
        float widest_px = 0.0F;
        float farthest = 1.0F;
    };

    void find_edges() {
        reach_ = Image<Reach>{(depth_.size_px() + kTilePx - 1) / kTilePx};
        Image<Edges> edges{reach_.size_px()};
        for (int y = 0; y <= last_.y; ++y) {
            for (int x = 0; x <= last_.x; ++x) {
                Edges& tile = edges.at(x / kTilePx, y / kTilePx);
                for (const glm::ivec2& step : {glm::ivec2{1, 0}, glm::ivec2{0, 1}}) {
                    if (!inside(glm::ivec2{x, y} + step)) continue;
                    const float gap = gap_px({x, y}, step);
                    if (gap == 0.0F) continue;
                    tile.widest_px = std::max(tile.widest_px, gap);
                    tile.farthest = std::min({tile.farthest, at({x, y}), at(glm::ivec2{x, y} + step)});
                }
            }
        }
        for (int y = 0; y < edges.height(); ++y) {
            for (int x = 0; x < edges.width(); ++x) {
                if (edges.at(x, y).widest_px > 0.0F) spread({x, y}, edges.at(x, y));
            }
        }
    }

    void spread(glm::ivec2 tile, const Edges& edges) {
        const int reach_px = std::min(static_cast<int>(std::ceil(edges.widest_px)) + kRimPx, kWidestPx);
        const int tiles = (reach_px + kTilePx - 1) / kTilePx;
        const glm::ivec2 first = glm::max(tile - tiles, glm::ivec2{0});
        const glm::ivec2 end = glm::min(tile + tiles + 1, reach_.size_px());
        for (int y = first.y; y < end.y; ++y) {
            for (int x = first.x; x < end.x; ++x) {
                Reach& reach = reach_.at(x, y);
                reach.pixels = std::max(reach.pixels, reach_px);
                reach.farthest = std::min(reach.farthest, edges.farthest);
            }
        }
    }

    // Most pixels look no farther than the rim: what they may shift by against anything near them is less.
    [[nodiscard]] bool is_needed(glm::ivec2 px, const Reach& reach) const {
        const float here = at(px);
        const float most_px = px_per_depth_ * (here - reach.farthest) + 1.0F;
        const int farthest_px = std::min(reach.pixels, std::max(static_cast<int>(most_px), kRimPx));
        for (const int distance_px : kLookPx) {
            if (distance_px > farthest_px) break;
            for (const glm::ivec2& direction : kDirections) {
                const glm::ivec2 there = px + distance_px * direction;
                if (!inside(there)) continue;
                const float shift_px = px_per_depth_ * (here - at(there));
                const bool looked_behind =
                    shift_px > kOneSurfacePx && shift_px + 1.0F >= static_cast<float>(distance_px);
                const bool is_rim = distance_px <= kRimPx && shift_px < -kOneSurfacePx;
                if (looked_behind || is_rim) return true;
            }
        }
        return false;
    }

    // Between the nearest surface around the pixel and the next one behind it.
    [[nodiscard]] float limit_at(glm::ivec2 px) const {
        std::array<float, 25> around{};
        std::size_t count = 0;
        for (int dy = -kRimPx; dy <= kRimPx; ++dy) {
            for (int dx = -kRimPx; dx <= kRimPx; ++dx) around[count++] = clamped_at(px + glm::ivec2{dx, dy});
        }
        std::sort(around.begin(), around.end(), std::greater<>{});
        const float one_surface = kOneSurfacePx / px_per_depth_;
        for (std::size_t i = 0; i + 1 < around.size(); ++i) {
            if (around[i] - around[i + 1] > one_surface) return 0.5F * (around[i] + around[i + 1]);
        }
        // One surface all around: what lies as far behind it as it bends here is still part of it.
        const float bend = 0.5F * (around.front() - around.back());
        return std::max(around.back() - std::max(one_surface, bend), 0.0F);
    }

    const DepthImage& depth_;
    const float px_per_depth_;
    const glm::ivec2 last_ = depth_.size_px() - 1;
    Image<Reach> reach_;  // per tile
};

}  // namespace

DepthImage hidden_limits(const Camera& camera, const DepthImage& depth, double head_motion_m) {
    LW_CHECK(depth.size_px() == camera.size_px, "a depth image of another size than its camera's");
    LW_CHECK(head_motion_m >= 0.0, fmt::format("a head motion of {} m", head_motion_m));
    const double px_per_tan = std::max(camera.size_px.x / (camera.fov.right - camera.fov.left),
                                       camera.size_px.y / (camera.fov.up - camera.fov.down));
    const double px_per_depth = px_per_tan * head_motion_m / camera.near_m;
    // A head that does not move looks behind nothing.
    if (px_per_depth < 1e-6) return DepthImage{camera.size_px, 0.0F};
    return HiddenLimits{depth, static_cast<float>(px_per_depth)}.compute();
}

}  // namespace lw
