#pragma once
/// A card in front of a wall, both facing the camera, seen by cameras that look along -Z: every pixel known by hand.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "core/surface_match.h"

namespace lw::test {

struct CardScene {
    double wall_m = 10.0;
    double card_m = 2.0;
    double card_left_m = -0.5;  ///< world x at time of drawing
    double card_right_m = 0.5;
    ObjectId card_id = 0;
};

/// A picture of it, with what a SampledView refers to.
struct CardPicture {
    Camera camera;
    DepthImage depth;
    ObjectIdImage object_id;
    std::vector<ObjectTransform> movers;

    [[nodiscard]] SampledView view() const { return {camera, depth, object_id, movers}; }
    /// Whether pixel (x, y) shows the card.
    [[nodiscard]] bool is_card(int x, int y) const { return depth.at(x, y) > static_cast<float>(0.3 * camera.near_m); }
};

inline Camera card_camera(double x_m, int side_px = 64) {
    Camera camera;
    camera.size_px = {side_px, side_px};
    camera.near_m = 1.0;
    camera.world_from_eye.position_m = {x_m, 0.0, 0.0};
    return camera;
}

inline CardPicture draw_cards(const CardScene& scene, const Camera& camera) {
    CardPicture picture{camera, DepthImage{camera.size_px}, ObjectIdImage{camera.size_px}, {}};
    if (scene.card_id != 0) {
        const glm::dvec3 centre_world{0.5 * (scene.card_left_m + scene.card_right_m), 0.0, -scene.card_m};
        picture.movers.push_back({scene.card_id, glm::translate(glm::dmat4{1.0}, centre_world)});
    }
    for (int y = 0; y < camera.size_px.y; ++y) {
        for (int x = 0; x < camera.size_px.x; ++x) {
            const double ray_x = camera.fov.left + (x + 0.5) / camera.size_px.x * (camera.fov.right - camera.fov.left);
            const double card_x_m = camera.world_from_eye.position_m.x + ray_x * scene.card_m;
            const bool is_card = card_x_m > scene.card_left_m && card_x_m < scene.card_right_m;
            picture.depth.at(x, y) = static_cast<float>(camera.near_m / (is_card ? scene.card_m : scene.wall_m));
            picture.object_id.at(x, y) = is_card ? scene.card_id : ObjectId{0};
        }
    }
    return picture;
}

}  // namespace lw::test
