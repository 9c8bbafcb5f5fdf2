#include "bench/warp_server/half_covered_layer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace lw::bench {
namespace {

constexpr double kEyeHeight_m = 1.6;

Rgba8 texture(double u_m, double v_m, int variant) {
    const double wave = 0.5 + 0.25 * std::sin(9.0 * u_m) + 0.25 * std::sin(7.0 * v_m + variant);
    const auto level = [&](double scale) { return static_cast<std::uint8_t>(40.0 + 180.0 * scale * wave); };
    return {level(1.0), level(0.6 + 0.1 * (variant % 5)), level(0.4 + 0.1 * (variant % 3)), 255};
}

struct Canvas {
    const Camera& camera;
    CpuPixels& pixels;
    double focal_px;
    double horizon_px;

    void put(int x, int y, double distance, ObjectId id, Rgba8 colour) {
        const auto depth = static_cast<float>(camera.near_m / distance);
        if (depth <= pixels.depth.at(x, y)) return;
        pixels.depth.at(x, y) = depth;
        pixels.object_id.at(x, y) = id;
        pixels.colour.at(x, y) = colour;
    }
};

void draw_ground_and_sky(Canvas& canvas) {
    const glm::ivec2 size_px = canvas.camera.size_px;
    for (int y = 0; y < size_px.y; ++y) {
        const double below_px = y + 0.5 - canvas.horizon_px;
        for (int x = 0; x < size_px.x; ++x) {
            const auto blue = static_cast<std::uint8_t>(150 + 100 * y / size_px.y);
            canvas.pixels.colour.at(x, y) = {static_cast<std::uint8_t>(90 + 60 * x / size_px.x), 140, blue, 255};
            if (below_px <= 0.0) continue;
            const double distance = kEyeHeight_m * canvas.focal_px / below_px;
            canvas.put(x, y, distance, 0, texture((x - 0.5 * size_px.x) * distance / canvas.focal_px, distance, 0));
        }
    }
}

// A plate on the ground; the farther, the smaller in the picture.
void draw_mover(Canvas& canvas, ObjectId id, double x_m, double distance) {
    const double px_per_m = canvas.focal_px / distance;
    const double centre_x = 0.5 * canvas.camera.size_px.x + x_m * px_per_m;
    const double foot_y = canvas.horizon_px + kEyeHeight_m * px_per_m;
    const int left = std::max(0, static_cast<int>(centre_x - 0.2 * px_per_m));
    const int right = std::min(canvas.camera.size_px.x, static_cast<int>(centre_x + 0.2 * px_per_m));
    const int top = std::max(0, static_cast<int>(foot_y - 0.5 * px_per_m));
    const int bottom = std::min(canvas.camera.size_px.y, static_cast<int>(foot_y));
    for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) canvas.put(x, y, distance, id, texture(x / px_per_m, y / px_per_m, id));
    }
}

}  // namespace

Layer half_covered_layer(glm::ivec2 size_px, int movers) {
    Layer layer;
    layer.camera.size_px = size_px;
    layer.camera.fov = FovTangents::symmetric(std::numbers::pi / 2.0, static_cast<double>(size_px.x) / size_px.y);
    layer.camera.world_from_eye.position_m = {0.0, kEyeHeight_m, 0.0};
    CpuPixels pixels{ColourImage{size_px}, DepthImage{size_px}, ObjectIdImage{size_px}};
    Canvas canvas{layer.camera, pixels, 0.5 * size_px.y, 0.5 * size_px.y};
    draw_ground_and_sky(canvas);
    for (int i = 0; i < movers; ++i) {
        const int row = i / 40;
        const double distance = 3.0 + 1.5 * row;
        const double x_m = (i % 40 - 19.5) * 0.05 * distance;
        const auto id = static_cast<ObjectId>(i + 1);
        draw_mover(canvas, id, x_m, distance);
        layer.movers.push_back({id, glm::translate(glm::dmat4{1.0}, glm::dvec3{x_m, 0.0, -distance})});
    }
    layer.pixels = std::move(pixels);
    return layer;
}

Layer with_quarters(Layer layer) {
    CpuPixels& pixels = layer.cpu();
    pixels.alpha_is_share = true;
    pixels.quarters = ColourImage{2 * pixels.colour.size_px()};
    for (int y = 0; y < pixels.quarters.height(); ++y) {
        for (int x = 0; x < pixels.quarters.width(); ++x) pixels.quarters.at(x, y) = pixels.colour.at(x / 2, y / 2);
    }
    return layer;
}

Camera moved_head(const Camera& source) {
    Camera target = source;
    const glm::dquat turn = glm::angleAxis(0.02, glm::normalize(glm::dvec3{0.3, 1.0, 0.1}));
    target.world_from_eye = compose(source.world_from_eye, Pose{{0.014, 0.005, -0.012}, turn});
    return target;
}

std::vector<ObjectTransform> moved_objects(const Layer& layer) {
    std::vector<ObjectTransform> moved = layer.movers;
    for (ObjectTransform& object : moved) object.world_from_object[3].x += 0.03;
    return moved;
}

}  // namespace lw::bench
