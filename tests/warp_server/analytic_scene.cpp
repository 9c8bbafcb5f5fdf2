#include "tests/warp_server/analytic_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "core/colour.h"

namespace lw::test {
namespace {

constexpr double kFarthest_m = 1e6;

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction;  // scaled so that the ray parameter is the distance along -z of the eye
};

// Solids with their placements at one time, ready to be intersected.
struct PlacedScene {
    const std::vector<Solid>* solids;
    std::vector<glm::dmat4> world_from_object;
    std::vector<glm::dmat4> object_from_world;

    PlacedScene(const std::vector<Solid>& all, double time_s) : solids{&all} {
        for (const Solid& solid : all) {
            world_from_object.push_back(solid.world_from_object(time_s));
            object_from_world.push_back(glm::inverse(world_from_object.back()));
        }
    }
};

bool keep_nearer(double distance_m, double nearest_allowed_m, Hit& hit) {
    if (!(distance_m > nearest_allowed_m) || distance_m >= hit.distance_m) return false;
    hit.distance_m = distance_m;
    return true;
}

void meet_ground(const Ray& ray, double near_m, int index, Hit& hit) {
    if (ray.origin.y <= 0.0 || ray.direction.y >= 0.0) return;
    if (!keep_nearer(-ray.origin.y / ray.direction.y, near_m, hit)) return;
    hit.solid = index;
    hit.face = 0;
    hit.normal_object = {0.0, 1.0, 0.0};
    hit.position_object = ray.origin + hit.distance_m * ray.direction;
}

void meet_box(const Ray& ray, const glm::dvec3& half, double near_m, int index, Hit& hit) {
    double enter = -std::numeric_limits<double>::infinity();
    double leave = std::numeric_limits<double>::infinity();
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double slope = ray.direction[axis];
        if (slope == 0.0) {
            if (std::abs(ray.origin[axis]) > half[axis]) return;
            continue;
        }
        const double side = slope > 0.0 ? -half[axis] : half[axis];
        const double axis_enter = (side - ray.origin[axis]) / slope;
        const double axis_leave = (-side - ray.origin[axis]) / slope;
        if (axis_enter > enter) {
            enter = axis_enter;
            face = 2 * axis + (slope > 0.0 ? 0 : 1);
        }
        leave = std::min(leave, axis_leave);
    }
    if (enter > leave || !keep_nearer(enter, near_m, hit)) return;
    hit.solid = index;
    hit.face = face;
    hit.normal_object = {};
    hit.normal_object[face / 2] = face % 2 == 0 ? -1.0 : 1.0;
    hit.position_object = ray.origin + hit.distance_m * ray.direction;
}

// Smaller root of a quadratic, or nothing.
std::optional<double> first_root(double a, double half_b, double c) {
    const double discriminant = half_b * half_b - a * c;
    if (a == 0.0 || discriminant < 0.0) return std::nullopt;
    return (-half_b - std::sqrt(discriminant)) / a;
}

void meet_round(const Ray& ray, const Solid& solid, double near_m, int index, Hit& hit) {
    const bool is_sphere = solid.shape == Shape::sphere;
    const glm::dvec3 axes = is_sphere ? glm::dvec3{1.0} : glm::dvec3{1.0, 0.0, 1.0};
    const glm::dvec3 origin = ray.origin * axes;
    const glm::dvec3 direction = ray.direction * axes;
    const double radius = solid.half_size_m.x;
    const auto root = first_root(glm::dot(direction, direction), glm::dot(origin, direction),
                                 glm::dot(origin, origin) - radius * radius);
    if (!root) return;
    const glm::dvec3 position = ray.origin + *root * ray.direction;
    if (!is_sphere && std::abs(position.y) > solid.half_size_m.y) return;
    if (!keep_nearer(*root, near_m, hit)) return;
    hit.solid = index;
    hit.face = 0;
    hit.position_object = position;
    hit.normal_object = position * axes / radius;
}

Hit trace(const PlacedScene& scene, const Ray& ray_world, double near_m) {
    Hit hit;
    hit.distance_m = kFarthest_m;
    for (std::size_t i = 0; i < scene.solids->size(); ++i) {
        const Solid& solid = (*scene.solids)[i];
        const Ray ray{glm::dvec3{scene.object_from_world[i] * glm::dvec4{ray_world.origin, 1.0}},
                      glm::dvec3{scene.object_from_world[i] * glm::dvec4{ray_world.direction, 0.0}}};
        const int index = static_cast<int>(i);
        switch (solid.shape) {
            case Shape::ground:
                meet_ground(ray, near_m, index, hit);
                break;
            case Shape::box:
                meet_box(ray, solid.half_size_m, near_m, index, hit);
                break;
            case Shape::sphere:
            case Shape::cylinder:
                meet_round(ray, solid, near_m, index, hit);
                break;
        }
    }
    return hit;
}

// Place on the surface by which the patterns are drawn.
glm::dvec2 surface_place_m(const Solid& solid, const Hit& hit) {
    const glm::dvec3& p = hit.position_object;
    switch (solid.shape) {
        case Shape::ground:
            return {p.x, p.z};
        case Shape::box:
            if (hit.face / 2 == 0) return {p.z, p.y};
            return hit.face / 2 == 1 ? glm::dvec2{p.x, p.z} : glm::dvec2{p.x, p.y};
        case Shape::sphere:
            return glm::dvec2{std::atan2(p.x, p.z), std::asin(p.y / solid.half_size_m.x)} * solid.half_size_m.x;
        case Shape::cylinder:
            return {std::atan2(p.x, p.z) * solid.half_size_m.x, p.y};
    }
    return {};
}

double fraction(double value) { return value - std::floor(value); }

// How much of the second colour a place shows, 0..1.
double pattern_share(const Solid& solid, const glm::dvec2& place_m) {
    const glm::dvec2 cell = place_m / solid.period_m;
    constexpr double turn = 2.0 * std::numbers::pi;
    switch (solid.pattern) {
        case Pattern::plain:
            return 0.0;
        case Pattern::waves:
            return 0.5 + 0.2 * std::sin(turn * cell.x) + 0.2 * std::sin(turn * cell.y) +
                   0.1 * std::sin(turn * (0.37 * cell.x + 0.41 * cell.y));
        case Pattern::checker:
            return (fraction(cell.x) < 0.5) == (fraction(cell.y) < 0.5) ? 0.0 : 1.0;
        case Pattern::windows: {
            const glm::dvec2 in_cell{fraction(cell.x), fraction(cell.y)};
            const bool opening = in_cell.x > 0.25 && in_cell.x < 0.75 && in_cell.y > 0.2 && in_cell.y < 0.8;
            const bool bar = std::abs(in_cell.x - 0.5) < 0.03 || std::abs(in_cell.y - 0.5) < 0.03;
            return opening && !bar ? 1.0 : 0.15 * (0.5 + 0.5 * std::sin(turn * 4.0 * cell.x));
        }
    }
    return 0.0;
}

glm::dvec3 sky_colour(const glm::dvec3& direction_world) {
    const glm::dvec3 d = glm::normalize(direction_world);
    const double height = std::clamp(0.5 + d.y, 0.0, 1.0);
    const double cloud = 0.5 + 0.5 * std::sin(9.0 * d.x) * std::sin(7.0 * d.y + 3.0 * d.x);
    return glm::mix(glm::dvec3{0.75, 0.8, 0.85}, glm::dvec3{0.15, 0.3, 0.7}, height) + 0.1 * cloud;
}

glm::dvec3 colour_of(const std::vector<Solid>& solids, const Hit& hit, const Ray& ray_world) {
    if (hit.solid < 0) return sky_colour(ray_world.direction);
    const Solid& solid = solids[static_cast<std::size_t>(hit.solid)];
    const glm::dvec3 base =
        glm::mix(solid.colour, solid.second_colour, pattern_share(solid, surface_place_m(solid, hit)));
    const double light = 0.65 + 0.35 * glm::dot(hit.normal_object, glm::normalize(glm::dvec3{0.4, 0.8, 0.45}));
    return base * light;
}

// Rays of one camera.
struct RayCaster {
    explicit RayCaster(const Camera& camera)
        : origin{camera.world_from_eye.position_m},
          world_from_eye{matrix_of(camera.world_from_eye)},
          eye_from_px{source_eye_from_source_px(camera).matrix} {}

    [[nodiscard]] Ray through(double x_px, double y_px) const {
        const glm::dvec4 direction_eye = eye_from_px * glm::dvec4{x_px, y_px, 1.0, 0.0};
        return {origin, glm::dvec3{world_from_eye * glm::dvec4{glm::dvec3{direction_eye}, 0.0}}};
    }

    glm::dvec3 origin;
    glm::dmat4 world_from_eye;
    glm::dmat4 eye_from_px;
};

struct Sample {
    Hit hit;
    glm::dvec3 colour;
    double depth = 0.0;
    double share = 1.0;  // of the pixel
};

// The NxN samples of one pixel, in reading order.
void cast_pixel(const PlacedScene& scene, const RayCaster& caster, double near_m, int x, int y, int samples,
                std::vector<Sample>& out) {
    out.clear();
    for (int row = 0; row < samples; ++row) {
        for (int column = 0; column < samples; ++column) {
            const Ray ray = caster.through(x + (column + 0.5) / samples, y + (row + 0.5) / samples);
            Sample sample;
            sample.hit = trace(scene, ray, near_m);
            sample.colour = colour_of(*scene.solids, sample.hit, ray);
            sample.depth = sample.hit.solid < 0 ? 0.0 : near_m / sample.hit.distance_m;
            out.push_back(sample);
        }
    }
}

Rgba8 stored(const glm::dvec3& linear) { return srgb8_of(glm::vec3{linear}); }

// Colour and depth averaged over the samples that lie on the median sample's surface.
Sample resolved_per_surface(std::vector<Sample>& samples) {
    std::stable_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.depth < b.depth; });
    Sample result = samples[samples.size() / 2];
    glm::dvec3 colour{0.0};
    double depth = 0.0;
    int count = 0;
    for (const Sample& sample : samples) {
        if (!sample.hit.same_surface(result.hit)) continue;
        colour += sample.colour;
        depth += sample.depth;
        ++count;
    }
    result.colour = colour / static_cast<double>(count);
    result.depth = depth / count;
    result.share = static_cast<double>(count) / static_cast<double>(samples.size());
    return result;
}

template <class Visit>
void for_each_pixel(glm::ivec2 size_px, Visit visit) {
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) visit(x, y);
    }
}

void add_house_row(std::vector<Solid>& solids, double x_m, double turn_rad) {
    for (int i = 0; i < 5; ++i) {
        Solid house;
        house.half_size_m = {1.8, 2.2 + 0.6 * (i % 3), 1.6};
        house.position_m = {x_m, house.half_size_m.y, -4.5 - 4.2 * i};
        house.turn_rad = turn_rad;
        house.pattern = Pattern::windows;
        house.period_m = 1.1;
        house.colour = {0.55 - 0.05 * i, 0.35 + 0.05 * (i % 3), 0.25 + 0.08 * (i % 2)};
        house.second_colour = {0.04, 0.06, 0.1};
        solids.push_back(house);
    }
}

void add_thin_things(std::vector<Solid>& solids) {
    const auto thin_box = [&](const glm::dvec3& half, const glm::dvec3& position, const glm::dvec3& colour) {
        Solid solid;
        solid.half_size_m = half;
        solid.position_m = position;
        solid.pattern = Pattern::plain;
        solid.colour = colour;
        solids.push_back(solid);
    };
    for (int i = 0; i < 7; ++i) {  // lamp posts, 3 to 11 m away: 4 to 1 px wide at 256 px per metre at 1 m
        Solid post;
        post.shape = Shape::cylinder;
        post.half_size_m = {0.022, 1.5, 0.022};
        post.position_m = {i % 2 == 0 ? -1.5 : 1.6, 1.5, -3.0 - 1.3 * i};
        post.pattern = Pattern::plain;
        post.colour = {0.08, 0.08, 0.09};
        solids.push_back(post);
    }
    for (int i = 0; i < 12; ++i) {  // railing
        thin_box({0.008, 0.45, 0.008}, {-1.3 + 0.12 * i, 0.45, -3.6}, {0.7, 0.7, 0.65});
    }
    thin_box({0.75, 0.012, 0.012}, {-0.64, 0.92, -3.6}, {0.7, 0.7, 0.65});
    for (int i = 0; i < 3; ++i) {  // wires across the street, 1 px high and less
        thin_box({3.0, 0.009, 0.009}, {0.0, 2.9 + 0.25 * i, -4.5 - 0.8 * i}, {0.05, 0.05, 0.05});
    }
}

}  // namespace

glm::dmat4 Solid::world_from_object(double time_s) const {
    const glm::dmat4 placed = glm::translate(glm::dmat4{1.0}, position_m + time_s * velocity_m_s);
    return glm::rotate(placed, turn_rad + time_s * spin_rad_s, glm::dvec3{0.0, 1.0, 0.0});
}

AnalyticScene AnalyticScene::street() {
    AnalyticScene scene;
    Solid ground;
    ground.shape = Shape::ground;
    ground.pattern = Pattern::waves;
    ground.period_m = 0.6;
    ground.colour = {0.3, 0.29, 0.27};
    ground.second_colour = {0.12, 0.13, 0.12};
    scene.solids.push_back(ground);
    add_house_row(scene.solids, -4.4, 0.06);
    add_house_row(scene.solids, 4.4, -0.05);
    add_thin_things(scene.solids);

    Solid end_house;
    end_house.half_size_m = {5.0, 2.5, 1.0};
    end_house.position_m = {0.0, 2.5, -26.0};
    end_house.pattern = Pattern::windows;
    end_house.period_m = 1.6;
    scene.solids.push_back(end_house);

    Solid ball;
    ball.shape = Shape::sphere;
    ball.half_size_m = glm::dvec3{0.45};
    ball.position_m = {0.9, 0.45, -3.2};
    ball.period_m = 0.3;
    ball.colour = {0.7, 0.15, 0.1};
    ball.second_colour = {0.8, 0.7, 0.2};
    scene.solids.push_back(ball);

    Solid sliding;
    sliding.half_size_m = {0.5, 0.35, 0.3};
    sliding.position_m = {-0.7, 0.36, -4.6};
    sliding.velocity_m_s = {2.0, 0.0, 0.0};
    sliding.id = 1;
    sliding.period_m = 0.25;
    sliding.colour = {0.1, 0.3, 0.7};
    sliding.second_colour = {0.6, 0.7, 0.8};
    scene.solids.push_back(sliding);

    Solid spinning;
    spinning.half_size_m = {0.35, 0.35, 0.35};
    spinning.position_m = {0.35, 1.75, -3.4};
    spinning.spin_rad_s = 2.0 * std::numbers::pi;
    spinning.turn_rad = 0.5;
    spinning.id = 2;
    spinning.period_m = 0.25;
    spinning.colour = {0.15, 0.55, 0.2};
    spinning.second_colour = {0.75, 0.8, 0.3};
    scene.solids.push_back(spinning);
    return scene;
}

AnalyticScene AnalyticScene::wall(double distance_m, double slant_rad) {
    AnalyticScene scene;
    Solid wall;
    wall.half_size_m = {50.0, 50.0, 0.5};
    wall.turn_rad = slant_rad;
    wall.position_m =
        glm::dvec3{0.0, 1.6, -distance_m} - 0.5 * glm::dvec3{std::sin(slant_rad), 0.0, std::cos(slant_rad)};
    wall.pattern = Pattern::waves;
    wall.period_m = 0.4;
    scene.solids.push_back(wall);
    return scene;
}

Layer AnalyticScene::draw(const Camera& camera, double time_s, int samples) const {
    Layer layer;
    layer.camera = camera;
    layer.scene_time_s = time_s;
    layer.movers = movers(time_s);
    CpuPixels pixels{ColourImage{camera.size_px}, DepthImage{camera.size_px}, ObjectIdImage{camera.size_px},
                     samples > 1};
    const PlacedScene scene{solids, time_s};
    const RayCaster caster{camera};
    std::vector<Sample> pixel_samples;
    for_each_pixel(camera.size_px, [&](int x, int y) {
        cast_pixel(scene, caster, camera.near_m, x, y, samples, pixel_samples);
        const Sample sample = resolved_per_surface(pixel_samples);
        pixels.colour.at(x, y) = stored(sample.colour);
        pixels.colour.at(x, y).a = static_cast<std::uint8_t>(std::lround(255.0 * sample.share));
        pixels.depth.at(x, y) = static_cast<float>(sample.depth);
        pixels.object_id.at(x, y) =
            sample.hit.solid < 0 ? ObjectId{0} : solids[static_cast<std::size_t>(sample.hit.solid)].id;
    });
    layer.pixels = std::move(pixels);
    return layer;
}

ColourImage AnalyticScene::truth(const Camera& camera, double time_s, int samples) const {
    ColourImage image{camera.size_px};
    const PlacedScene scene{solids, time_s};
    const RayCaster caster{camera};
    std::vector<Sample> pixel_samples;
    for_each_pixel(camera.size_px, [&](int x, int y) {
        cast_pixel(scene, caster, camera.near_m, x, y, samples, pixel_samples);
        glm::dvec3 sum{0.0};
        for (const Sample& sample : pixel_samples) sum += sample.colour;
        image.at(x, y) = stored(sum / static_cast<double>(pixel_samples.size()));
    });
    return image;
}

DepthImage AnalyticScene::truth_depth(const Camera& camera, double time_s) const {
    DepthImage image{camera.size_px};
    const PlacedScene scene{solids, time_s};
    const RayCaster caster{camera};
    for_each_pixel(camera.size_px, [&](int x, int y) {
        const Hit hit = trace(scene, caster.through(x + 0.5, y + 0.5), camera.near_m);
        image.at(x, y) = hit.solid < 0 ? 0.0F : static_cast<float>(camera.near_m / hit.distance_m);
    });
    return image;
}

Image<int> AnalyticScene::solid_at(const Camera& camera, double time_s) const {
    Image<int> image{camera.size_px};
    const PlacedScene scene{solids, time_s};
    const RayCaster caster{camera};
    for_each_pixel(camera.size_px, [&](int x, int y) {
        image.at(x, y) = trace(scene, caster.through(x + 0.5, y + 0.5), camera.near_m).solid;
    });
    return image;
}

Image<std::uint8_t> AnalyticScene::seen_by_source(const Camera& target, double target_time_s, const Camera& source,
                                                  double source_time_s) const {
    Image<std::uint8_t> seen{target.size_px, 0};
    const PlacedScene at_target{solids, target_time_s};
    const PlacedScene at_source{solids, source_time_s};
    const RayCaster target_caster{target};
    const RayCaster source_caster{source};
    const glm::dmat4 source_eye_from_world = inverse_matrix_of(source.world_from_eye);
    const glm::dmat4 px_from_eye =
        target_px_from_target_clip(source).matrix * target_clip_from_target_eye(source).matrix;
    for_each_pixel(target.size_px, [&](int x, int y) {
        const Ray ray = target_caster.through(x + 0.5, y + 0.5);
        const Hit hit = trace(at_target, ray, target.near_m);
        glm::dvec4 place_world{ray.direction, 0.0};  // sky: a direction
        if (hit.solid >= 0) {
            place_world =
                at_source.world_from_object[static_cast<std::size_t>(hit.solid)] * glm::dvec4{hit.position_object, 1.0};
        }
        const glm::dvec4 place_h = px_from_eye * (source_eye_from_world * place_world);
        if (place_h.w <= 0.0) return;
        const glm::dvec2 place_px = glm::dvec2{place_h} / place_h.w;
        const bool inside =
            place_px.x >= 0.0 && place_px.y >= 0.0 && place_px.x < source.size_px.x && place_px.y < source.size_px.y;
        if (!inside) return;
        const Hit back = trace(at_source, source_caster.through(place_px.x, place_px.y), source.near_m);
        seen.at(x, y) = back.same_surface(hit) ? 1 : 0;
    });
    return seen;
}

std::vector<ObjectTransform> AnalyticScene::movers(double time_s) const {
    std::vector<ObjectTransform> result;
    for (const Solid& solid : solids) {
        if (solid.id != 0) result.push_back({solid.id, solid.world_from_object(time_s)});
    }
    std::sort(result.begin(), result.end(),
              [](const ObjectTransform& a, const ObjectTransform& b) { return a.id < b.id; });
    return result;
}

Camera street_camera(glm::ivec2 size_px) {
    Camera camera;
    camera.world_from_eye.position_m = {0.0, 1.6, 0.0};
    camera.fov = FovTangents::symmetric(std::numbers::pi / 2.0, static_cast<double>(size_px.x) / size_px.y);
    camera.size_px = size_px;
    return camera;
}

Camera moved(const Camera& camera, const glm::dvec3& offset_eye_m, double yaw_deg, double pitch_deg, double roll_deg) {
    constexpr double rad_per_deg = std::numbers::pi / 180.0;
    const glm::dquat turn = glm::angleAxis(yaw_deg * rad_per_deg, glm::dvec3{0.0, 1.0, 0.0}) *
                            glm::angleAxis(pitch_deg * rad_per_deg, glm::dvec3{1.0, 0.0, 0.0}) *
                            glm::angleAxis(roll_deg * rad_per_deg, glm::dvec3{0.0, 0.0, 1.0});
    Camera result = camera;
    result.world_from_eye = compose(camera.world_from_eye, Pose{offset_eye_m, turn});
    return result;
}

}  // namespace lw::test
