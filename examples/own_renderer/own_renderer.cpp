// A slow renderer of one's own (here a ray caster on the CPU, some spheres over a checker floor) shown at full rate.
// It draws 10 pictures a second; Latewarp moves each of their pixels to where it belongs at each of 90 refreshes.
//   own_renderer OUTPUT_FOLDER
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/image_io.h"
#include "core/metrics.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/frame_warper.h"

namespace {

struct Sphere {
    glm::dvec3 centre_m;
    double radius_m;
    glm::dvec3 colour;
};
constexpr lw::ObjectId kMoverId = 1;
constexpr double kMoverRadius_m = 0.35;

glm::dmat4 mover_placement(double time_s) { return lw::matrix_of({{1.2 * std::sin(time_s), 0.6, -3.0}, {1, 0, 0, 0}}); }

lw::Pose head_at(double time_s) {
    const double yaw_rad = 0.15 * std::sin(2.0 * time_s);
    const glm::dquat down = glm::angleAxis(-0.4, glm::dvec3{1, 0, 0});
    return {{0.1 * std::sin(3.0 * time_s), 1.5, 0.0}, glm::angleAxis(yaw_rad, glm::dvec3{0, 1, 0}) * down};
}

std::optional<double> hit(const Sphere& sphere, const glm::dvec3& eye, const glm::dvec3& ray) {
    const glm::dvec3 offset = eye - sphere.centre_m;
    const double a = glm::dot(ray, ray), b = glm::dot(offset, ray);
    const double root = b * b - a * (glm::dot(offset, offset) - sphere.radius_m * sphere.radius_m);
    if (root < 0.0 || -b - std::sqrt(root) < 0.0) return std::nullopt;
    return (-b - std::sqrt(root)) / a;
}

// Fills one pixel: what the warp needs of a renderer is the colour, the distance along the view axis, and the object.
void cast(const glm::dvec3& eye, const glm::dvec3& ray, double near_m, double time_s, lw::Rgba8& colour, float& depth,
          lw::ObjectId& id) {
    const glm::dvec3 mover = mover_placement(time_s)[3];
    const Sphere spheres[] = {{mover, kMoverRadius_m, {240, 120, 40}},
                              {{-1.5, 0.8, -5.0}, 0.8, {70, 130, 220}},
                              {{1.8, 0.5, -4.5}, 0.5, {90, 200, 110}}};
    glm::dvec3 rgb{150, 190, 235};  // sky: depth 0, a direction
    double nearest = 1e9;
    if (ray.y < 0.0) {
        nearest = -eye.y / ray.y;
        const glm::dvec3 floor = eye + ray * nearest;
        const bool dark = (static_cast<int>(std::floor(floor.x)) + static_cast<int>(std::floor(floor.z))) % 2 != 0;
        rgb = dark ? glm::dvec3{90, 85, 80} : glm::dvec3{200, 195, 185};
    }
    id = 0;
    for (const Sphere& sphere : spheres) {
        const std::optional<double> distance = hit(sphere, eye, ray);
        if (!distance || *distance >= nearest) continue;
        nearest = *distance;
        const glm::dvec3 normal = (eye + ray * nearest - sphere.centre_m) / sphere.radius_m;
        rgb = sphere.colour * (0.4 + 0.6 * std::max(0.0, glm::dot(normal, glm::dvec3{0.48, 0.8, 0.36})));
        id = &sphere == &spheres[0] ? kMoverId : lw::ObjectId{0};
    }
    colour = {static_cast<std::uint8_t>(rgb.r), static_cast<std::uint8_t>(rgb.g), static_cast<std::uint8_t>(rgb.b),
              255};
    depth = nearest < 1e9 ? static_cast<float>(near_m / nearest) : 0.0F;  // `ray` has length 1 along the view axis
}

std::shared_ptr<lw::Layer> render(lw::Camera camera, double time_s) {
    auto layer = std::make_shared<lw::Layer>();
    layer->camera = camera;
    layer->pose_sampled = lw::at_seconds(time_s);
    layer->scene_time_s = time_s;
    layer->movers = {{kMoverId, mover_placement(time_s)}};
    lw::CpuPixels pixels{lw::ColourImage{camera.size_px}, lw::DepthImage{camera.size_px},
                         lw::ObjectIdImage{camera.size_px}};
    const glm::dmat4 eye_from_px = lw::source_eye_from_source_px(camera).matrix;
    for (int y = 0; y < camera.size_px.y; ++y) {
        for (int x = 0; x < camera.size_px.x; ++x) {
            const glm::dvec3 ray_eye{eye_from_px * glm::dvec4{x + 0.5, y + 0.5, 1.0, 0.0}};
            cast(camera.world_from_eye.position_m, camera.world_from_eye.orientation * ray_eye, camera.near_m, time_s,
                 pixels.colour.at(x, y), pixels.depth.at(x, y), pixels.object_id.at(x, y));
        }
    }
    layer->pixels = std::move(pixels);
    return layer;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: own_renderer OUTPUT_FOLDER\n"), 2;
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    auto warper = lw::FrameWarper::create("surface", "nearest-background");
    if (!warper) return std::fprintf(stderr, "%s\n", warper.error().message().c_str()), 1;

    lw::Camera camera;
    camera.size_px = {256, 256};
    lw::RenderedFrame frame;
    double warped_db = 0.0, stale_db = 0.0;
    int count = 0;
    for (int refresh = 18; refresh < 108; ++refresh) {
        const double photon_s = refresh / 90.0;
        if (refresh % 9 == 0) {  // the picture whose drawing began 100 ms ago is ready
            const double sampled_s = photon_s - 0.1;
            camera.world_from_eye = head_at(sampled_s);
            const std::shared_ptr<lw::Layer> layer = render(camera, sampled_s);
            warper->prepare(*layer);
            frame.index += 1;
            frame.layers = {layer};
        }
        camera.world_from_eye = head_at(photon_s);
        const lw::ObjectTransform movers[] = {{kMoverId, mover_placement(photon_s)}};
        const lw::DisplayFrame& shown = warper->warp(frame, {camera, movers});

        const std::shared_ptr<lw::Layer> truth = render(camera, photon_s);
        warped_db += lw::psnr_db(shown.colour, truth->cpu().colour).value_or(99.0);
        stale_db += lw::psnr_db(frame.layers[0]->cpu().colour, truth->cpu().colour).value_or(99.0);
        ++count;
        if (refresh % 15 != 0) continue;
        const std::string name = "refresh" + std::to_string(refresh) + ".png";
        if (const auto status = lw::write_png(folder / name, shown.colour); !status) {
            return std::fprintf(stderr, "%s\n", status.error().message().c_str()), 1;
        }
    }
    std::printf("against a renderer without delay: shown as it comes %.1f dB, warped %.1f dB\n", stale_db / count,
                warped_db / count);
    return warped_db / count > stale_db / count + 3.0 ? 0 : 1;
}
