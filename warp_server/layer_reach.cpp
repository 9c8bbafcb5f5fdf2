#include "warp_server/layer_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/reprojection.h"
#include "warp_server/methods/homography_resample.h"

namespace lw {
namespace {

// Methods lay pixels down with a footprint of their own: so much more around what is computed.
constexpr double kRimPx = 2.0;
// Of the corner's w when its distance is near_m: what is nearer to the eye's plane is cut off, as GL would.
constexpr double kLeastW = 1e-6;

// The box around points, grown until it holds them.
struct Box {
    glm::dvec2 min{std::numeric_limits<double>::infinity()};
    glm::dvec2 max{-std::numeric_limits<double>::infinity()};
    bool unbounded = false;

    void include(const glm::dvec4& h) {
        const glm::dvec2 px{h.x / h.w, h.y / h.w};
        min = glm::min(min, px);
        max = glm::max(max, px);
    }
};

PixelRect whole(const Camera& target) { return {{0, 0}, target.size_px}; }

// The eight corners of the layer's picture: bits of the index are right, bottom, nearest.
std::array<glm::dvec4, 8> corners_of(const Layer& layer, const Camera& target) {
    const glm::dmat4& m = static_target_px_from_source_px(layer.camera, target).matrix;
    const glm::dvec2 size_px{layer.camera.size_px};
    std::array<glm::dvec4, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double depth = (i & 4U) != 0 ? layer.content.nearest_depth : 0.0;
        const glm::dvec4 h =
            m * glm::dvec4{(i & 1U) != 0 ? size_px.x : 0.0, (i & 2U) != 0 ? size_px.y : 0.0, 1.0, depth};
        corners[i] = h;
    }
    return corners;
}

}  // namespace

PixelRect reach_of(const Layer& layer, const Camera& target) {
    if (!layer.content.static_only) return whole(target);
    const std::array<glm::dvec4, 8> corners = corners_of(layer, target);
    Box box;
    bool any = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i].w >= kLeastW) {
            box.include(corners[i]);
            any = true;
        }
        for (const std::size_t bit : {1U, 2U, 4U}) {
            const std::size_t j = i ^ bit;
            if (j < i || (corners[i].w >= kLeastW) == (corners[j].w >= kLeastW)) continue;
            const double t = (kLeastW - corners[i].w) / (corners[j].w - corners[i].w);
            glm::dvec4 cut = glm::mix(corners[i], corners[j], t);
            cut.w = kLeastW;
            box.include(cut);
            any = true;
        }
    }
    if (!any) return {};
    const glm::dvec2 size_px{target.size_px};
    const glm::dvec2 first = glm::clamp(box.min - kRimPx, glm::dvec2{0.0}, size_px);
    const glm::dvec2 end = glm::clamp(box.max + kRimPx, glm::dvec2{0.0}, size_px);
    return {glm::ivec2{glm::floor(first)}, glm::ivec2{glm::ceil(end)}};
}

float nearest_target_depth(const Layer& layer, const Camera& target) {
    if (!layer.content.static_only) return 1.0F;
    const double moved_m = glm::distance(layer.camera.world_from_eye.position_m, target.world_from_eye.position_m);
    const FovTangents& fov = target.fov;
    const double across = std::max(std::abs(fov.left), std::abs(fov.right));
    const double up = std::max(std::abs(fov.down), std::abs(fov.up));
    const double ray_m = layer.content.nearest_ray_m - moved_m;
    const double distance_m = ray_m / std::sqrt(1.0 + across * across + up * up);
    return distance_m <= target.near_m ? 1.0F : static_cast<float>(target.near_m / distance_m);
}

// Along a row each side of the view is a condition a + b * x >= 0.
std::pair<int, int> ViewCover::Picture::columns(int y, int width) const {
    const glm::vec3 at_left = source_from_target * glm::vec3{0.5F, static_cast<float>(y) + 0.5F, 1.0F};
    const glm::vec3 step = source_from_target[0];
    float first = 0.0F;
    float end = static_cast<float>(width);
    const auto demand = [&](float at_zero, float per_column) {
        if (per_column == 0.0F) {
            if (at_zero < 0.0F) end = -1.0F;
        } else if (per_column > 0.0F) {
            first = std::max(first, std::ceil(-at_zero / per_column));
        } else {
            end = std::min(end, std::floor(at_zero / -per_column) + 1.0F);
        }
    };
    demand(at_left.x, step.x);
    demand(at_left.y, step.y);
    demand(size_px.x * at_left.z - at_left.x, size_px.x * step.z - step.x);
    demand(size_px.y * at_left.z - at_left.y, size_px.y * step.z - step.y);
    demand(at_left.z, step.z);
    if (!(first < end)) return {0, 0};
    return {static_cast<int>(first), static_cast<int>(end)};
}

void ViewCover::add(const Camera& picture, const Camera& target) {
    pictures_.push_back({background_source_from_target(picture, target), picture.size_px});
}

std::pair<int, int> ViewCover::columns(int y, int width) const {
    std::pair<int, int> all{0, 0};
    for (const Picture& picture : pictures_) {
        const std::pair<int, int> one = picture.columns(y, width);
        const bool meet = one.first <= all.second && all.first <= one.second;
        if (meet && all.first < all.second && one.first < one.second) {
            all = {std::min(all.first, one.first), std::max(all.second, one.second)};
        } else if (one.second - one.first > all.second - all.first) {
            all = one;
        }
    }
    return all;
}

bool ViewCover::covers(int x, int y) const {
    const glm::vec3 pixel{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, 1.0F};
    return std::ranges::any_of(pictures_, [&](const Picture& picture) {
        const glm::vec3 h = picture.source_from_target * pixel;
        return h.z > 0.0F && h.x >= 0.0F && h.y >= 0.0F && h.x < picture.size_px.x * h.z &&
               h.y < picture.size_px.y * h.z;
    });
}

MissingPixels missing_in(const DisplayFrame& frame, const PixelRect& rect, float nearest_depth, const ViewCover& view) {
    MissingPixels missing{{rect.end_px, rect.first_px}, 0};
    for (int y = rect.first_px.y; y < rect.end_px.y; ++y) {
        const std::span<const Coverage> coverage = frame.coverage.row(y);
        const std::span<const float> depth = frame.depth.row(y);
        int first = rect.end_px.x;
        int last = -1;
        for (int x = rect.first_px.x; x < rect.end_px.x; ++x) {
            const auto i = static_cast<std::size_t>(x);
            if (coverage[i] == Coverage::reached && (depth[i] >= nearest_depth || view.covers(x, y))) continue;
            first = std::min(first, x);
            last = x;
            ++missing.count;
        }
        if (last < 0) continue;
        missing.rect.first_px = glm::min(missing.rect.first_px, glm::ivec2{first, y});
        missing.rect.end_px = glm::max(missing.rect.end_px, glm::ivec2{last + 1, y + 1});
    }
    return missing;
}

Camera part_of(const Camera& camera, const PixelRect& rect) {
    const FovTangents& fov = camera.fov;
    const double tan_per_px_x = (fov.right - fov.left) / camera.size_px.x;
    const double tan_per_px_y = (fov.up - fov.down) / camera.size_px.y;
    Camera part = camera;
    part.size_px = rect.size_px();
    part.fov = {fov.left + tan_per_px_x * rect.first_px.x, fov.left + tan_per_px_x * rect.end_px.x,
                fov.up - tan_per_px_y * rect.end_px.y, fov.up - tan_per_px_y * rect.first_px.y};
    return part;
}

}  // namespace lw
