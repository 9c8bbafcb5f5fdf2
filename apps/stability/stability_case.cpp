#include "apps/stability/stability_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/stability/case_random.h"

namespace lw::stability {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kFarthest_m = 1e7;  // 10,000 km

struct Limits {
    double least_fov_deg;
    double largest_fov_deg;
    double nearest_depth;  // 0.1 is ten near planes away
    double object_scale;
    double farthest_off_axis_deg;
    double largest_turn_deg;
    double travel;  // of the head, in parts of the distance of what it looks at
    double slant;   // change of depth over a region, in parts of its depth
};
constexpr Limits kPromised{20.0, 150.0, 0.1, 1e3, 75.0, 90.0, 0.6, 0.6};
constexpr Limits kBeyond{1.0, 170.0, 1.0, 1e4, 85.0, 180.0, 3.0, 0.9};

class CaseMaker {
public:
    CaseMaker(std::uint64_t seed, CaseRange range)
        : random_{seed * 2 + (range == CaseRange::beyond ? 1 : 0)},
          range_{range},
          limits_{range == CaseRange::promised ? kPromised : kBeyond} {
        made_.seed = seed;
        made_.range = range;
    }

    StabilityCase make() {
        made_.source = source_camera();
        cut_regions();
        place_movers();
        made_.target = target_camera();
        return std::move(made_);
    }

private:
    // A view, and the part of it that is the picture: pixel coordinates get as large as in a picture of 4096 x 4096, at
    // the cost of a strip.
    struct View {
        double left, right, down, up;
        int width, height;
        int x = 0, y = 0;  // of the part
        glm::ivec2 part{0};
    };

    [[nodiscard]] static FovTangents fov_of(const View& view) {
        const double per_column = (view.right - view.left) / view.width;
        const double per_row = (view.up - view.down) / view.height;
        return {view.left + per_column * view.x, view.left + per_column * (view.x + view.part.x),
                view.up - per_row * (view.y + view.part.y), view.up - per_row * view.y};
    }

    View whole_view(int width, int height) {
        const double fov_deg = random_.chance(0.1) ? limits_.largest_fov_deg
                                                   : random_.uniform(limits_.least_fov_deg, limits_.largest_fov_deg);
        // Both sides of the axis, in shares between even and one to four.
        const double share_x = random_.chance(0.5) ? 0.5 : random_.uniform(0.2, 0.8);
        const double share_y = random_.chance(0.5) ? 0.5 : random_.uniform(0.2, 0.8);
        View view{};
        view.left = -std::tan(std::min(fov_deg * share_x, limits_.farthest_off_axis_deg) * kRad);
        view.right = std::tan(std::min(fov_deg * (1.0 - share_x), limits_.farthest_off_axis_deg) * kRad);
        view.up = std::tan(std::min(fov_deg * share_y, limits_.farthest_off_axis_deg) * kRad);
        view.down = -std::tan(std::min(fov_deg * (1.0 - share_y), limits_.farthest_off_axis_deg) * kRad);
        view.width = width;
        view.height = height;
        view.part = {width, height};
        return view;
    }

    View random_view() {
        if (range_ == CaseRange::beyond && random_.chance(0.2))
            return whole_view(random_.whole(1, 5), random_.whole(1, 7));
        if (random_.chance(0.5)) return whole_view(random_.whole(16, 56), random_.whole(16, 56));
        const int side = random_.whole(512, 4096);
        View view = whole_view(side, side);
        const int thickness = random_.whole(8, 16);
        const int length = static_cast<int>(random_.log_uniform(64.0, side));
        view.part = random_.chance(0.5) ? glm::ivec2{length, thickness} : glm::ivec2{thickness, length};
        view.x = random_.whole(0, side - view.part.x);
        view.y = random_.whole(0, side - view.part.y);
        return view;
    }

    Camera source_camera() {
        source_view_ = random_view();
        Camera camera;
        camera.fov = fov_of(source_view_);
        camera.size_px = source_view_.part;
        camera.near_m = random_.log_uniform(1e-3, 1.0);
        if (random_.chance(0.8))
            camera.world_from_eye.position_m = random_.direction() * random_.log_uniform(1e-3, kFarthest_m);
        camera.world_from_eye.orientation = random_orientation();
        return camera;
    }

    glm::dquat random_orientation() {
        if (random_.chance(0.1)) return {1.0, 0.0, 0.0, 0.0};
        if (random_.chance(0.1)) {  // straight up or down, where yaw and roll are one
            return glm::angleAxis((random_.chance(0.5) ? 0.5 : -0.5) * std::numbers::pi, glm::dvec3{1.0, 0.0, 0.0});
        }
        return random_.rotation();
    }

    void cut_regions() {
        const glm::ivec2 size_px = made_.source.size_px;
        const int columns = size_px.x <= 16 ? size_px.x : std::max(random_.whole(12, 40), size_px.x / 6);
        const int rows = size_px.y <= 16 ? size_px.y : std::max(random_.whole(12, 40), size_px.y / 6);
        // The farthest depth that 10,000 km are.
        const double least_depth = made_.source.near_m / kFarthest_m;
        const bool mixed = random_.chance(0.5);
        const double common = random_.log_uniform(least_depth, limits_.nearest_depth / (1.0 + limits_.slant));
        // Within the promised range no surface is thinner than 4 px: whether thinner ones are joined to their
        // neighbours is a method's choice.
        const int thinnest = range_ == CaseRange::promised ? 4 : 1;
        const auto end_of = [&](int begin, int step, int size) {
            return size - begin - step < thinnest ? size : begin + step;
        };
        for (int y = 0; y < size_px.y; y = end_of(y, rows, size_px.y)) {
            for (int x = 0; x < size_px.x; x = end_of(x, columns, size_px.x)) {
                CaseRegion region{x, y, end_of(x, columns, size_px.x), end_of(y, rows, size_px.y), 0, {}};
                if (made_.regions.size() + 1 < 65535 && random_.chance(0.5)) {
                    region.id = static_cast<ObjectId>(made_.regions.size() + 1);
                }
                const double depth =
                    mixed ? random_.log_uniform(least_depth, limits_.nearest_depth / (1.0 + limits_.slant))
                          : common * random_.uniform(0.6, 1.0);
                region.plane = random_.chance(0.08) ? DepthPlane{} : plane_at(region, depth);
                made_.regions.push_back(region);
            }
        }
    }

    // Whole multiples of one step, so that every pixel's depth is a float without rounding.
    DepthPlane plane_at(const CaseRegion& region, double depth) {
        const double step = std::ldexp(1.0, std::ilogb(depth) - 20);
        const auto slope = [&](int pixels) {
            const double change = random_.chance(0.2) ? 0.0 : random_.uniform(-limits_.slant, limits_.slant) * 0.5;
            return std::round(change * depth / pixels / step) * step;
        };
        const double slope_x = slope(region.x1 - region.x0);
        const double slope_y = slope(region.y1 - region.y0);
        const double middle_x = region.x0 + (region.x1 - region.x0) / 2 + 0.5;
        const double middle_y = region.y0 + (region.y1 - region.y0) / 2 + 0.5;
        const double middle = std::round(depth / step) * step;
        return {Exact{middle} - Exact{slope_x} * middle_x - Exact{slope_y} * middle_y, slope_x, slope_y};
    }

    // World position of the middle of a region.
    [[nodiscard]] glm::dvec3 middle_of(const CaseRegion& region, double& distance_m) const {
        const double x = 0.5 * (region.x0 + region.x1);
        const double y = 0.5 * (region.y0 + region.y1);
        const double depth = std::max(static_cast<double>(region.plane.at(x, y)), made_.source.near_m / kFarthest_m);
        distance_m = made_.source.near_m / depth;
        const glm::dvec4 ray = source_eye_from_source_px(made_.source).matrix * glm::dvec4{x, y, 1.0, depth};
        const Pose& pose = made_.source.world_from_eye;
        return pose.position_m + pose.orientation * (glm::dvec3{ray} * distance_m);
    }

    void place_movers() {
        for (const CaseRegion& region : made_.regions) {
            if (region.id == 0) continue;
            double distance_m = 0.0;
            const glm::dvec3 middle_world = middle_of(region, distance_m);
            const glm::dmat4 at_source = random_placement(middle_world, distance_m);
            made_.at_source.push_back({region.id, at_source});
            if (random_.chance(0.1)) continue;  // stays where it is: no transform at photon time
            made_.at_target.push_back({region.id, moved(at_source, middle_world, distance_m)});
        }
    }

    // Where the object's origin is does not matter to its surface, so it may be anywhere.
    glm::dmat4 random_placement(const glm::dvec3& middle_world, double distance_m) {
        const glm::dmat3 turn = glm::mat3_cast(random_.rotation());
        const double common = random_.log_uniform(1.0 / limits_.object_scale, limits_.object_scale);
        glm::dmat3 linear{0.0};
        for (int axis = 0; axis < 3; ++axis) {
            const double scale =
                random_.chance(0.7) ? common : random_.log_uniform(1.0 / limits_.object_scale, limits_.object_scale);
            linear[axis] = turn[axis] * (random_.chance(0.1) ? -scale : scale);  // mirrored now and then
        }
        if (random_.chance(0.3)) linear[0] += linear[1] * random_.uniform(-1.0, 1.0);  // sheared
        glm::dmat4 placement{linear};
        const double offset_m =
            random_.chance(0.2) ? random_.log_uniform(1e-3, kFarthest_m) : distance_m * random_.log_uniform(1e-3, 10.0);
        placement[3] = glm::dvec4{middle_world + random_.direction() * offset_m, 1.0};
        return placement;
    }

    // Turned, scaled and shifted about its surface; beyond the promised range it may also jump anywhere.
    glm::dmat4 moved(const glm::dmat4& at_source, const glm::dvec3& middle_world, double distance_m) {
        if (range_ == CaseRange::beyond && random_.chance(0.1)) {
            return random_placement(made_.source.world_from_eye.position_m, distance_m);
        }
        const double turn_rad = random_.log_uniform(1e-9, 30.0 * kRad);
        const double scale = random_.chance(0.5) ? 1.0 : random_.uniform(0.7, 1.4);
        const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(turn_rad, random_.direction())) * scale;
        const glm::dvec3 shift = random_.direction() * distance_m * random_.log_uniform(1e-6, 0.3);
        glm::dmat4 placement{turn * glm::dmat3{at_source}};
        placement[3] = glm::dvec4{middle_world + turn * (glm::dvec3{at_source[3]} - middle_world) + shift, 1.0};
        return placement;
    }

    Camera target_camera() {
        const CaseRegion& focus =
            made_.regions[static_cast<std::size_t>(random_.whole(0, static_cast<int>(made_.regions.size()) - 1))];
        double distance_m = 0.0;
        (void)middle_of(focus, distance_m);
        Camera camera;
        camera.near_m = random_.chance(0.7) ? made_.source.near_m : random_.log_uniform(1e-3, made_.source.near_m);
        const Pose& from = made_.source.world_from_eye;
        const double turn_rad = random_.chance(0.1) ? 0.0 : random_.log_uniform(1e-9, limits_.largest_turn_deg * kRad);
        camera.world_from_eye.orientation =
            glm::normalize(glm::angleAxis(turn_rad, random_.direction()) * from.orientation);
        if (random_.chance(0.2)) camera.world_from_eye.orientation = -camera.world_from_eye.orientation;
        camera.world_from_eye.position_m = from.position_m;
        if (random_.chance(0.8)) {
            const double travel_m = distance_m * random_.log_uniform(1e-6, limits_.travel);
            camera.world_from_eye.position_m += random_.direction() * travel_m;
        }
        frame_target(camera, focus);
        return camera;
    }

    // The same view as the source in half of the cases, else another one. Of a large view the part that shows the
    // middle of the focus.
    void frame_target(Camera& camera, const CaseRegion& focus) {
        View view = random_.chance(0.5) ? source_view_ : random_view();
        if (view.part != glm::ivec2{view.width, view.height}) {
            Camera whole = camera;
            whole.fov = {view.left, view.right, view.down, view.up};
            whole.size_px = {view.width, view.height};
            const std::optional<MoverMotion> motion = made_.motion_of(focus.id);
            const ExactReprojection reprojection{made_.source, whole, motion ? &*motion : nullptr};
            const Exact x = 0.5L * (focus.x0 + focus.x1);
            const Exact y = 0.5L * (focus.y0 + focus.y1);
            const auto place = reprojection.place(x, y, focus.plane.at(x, y));
            const auto start = [&](Exact centre, int part, int side) {
                const Exact wanted = std::clamp(centre, Exact{0}, Exact(side)) - 0.5L * part;
                return std::clamp(static_cast<int>(wanted), 0, side - part);
            };
            if (place) {
                view.x = start(place->position_px.x, view.part.x, view.width);
                view.y = start(place->position_px.y, view.part.y, view.height);
            }
        }
        camera.fov = fov_of(view);
        camera.size_px = view.part;
    }

    CaseRandom random_;
    CaseRange range_;
    Limits limits_;
    View source_view_{};
    StabilityCase made_;
};

}  // namespace

std::optional<MoverMotion> StabilityCase::motion_of(ObjectId id) const {
    if (id == 0) return std::nullopt;
    const auto of_id = [id](const ObjectTransform& object) { return object.id == id; };
    const auto source_entry = std::find_if(at_source.begin(), at_source.end(), of_id);
    if (source_entry == at_source.end()) return std::nullopt;
    const auto target_entry = std::find_if(at_target.begin(), at_target.end(), of_id);
    const glm::dmat4& from = source_entry->world_from_object;
    return MoverMotion{from, target_entry == at_target.end() ? from : target_entry->world_from_object};
}

StabilityCase make_case(std::uint64_t seed, CaseRange range) { return CaseMaker{seed, range}.make(); }

Layer layer_of(const StabilityCase& made, CasePattern pattern) {
    const glm::ivec2 size_px = made.source.size_px;
    Layer layer;
    layer.camera = made.source;
    layer.movers = made.at_source;
    CpuPixels pixels{ColourImage{size_px}, DepthImage{size_px}, ObjectIdImage{size_px}};
    for (const CaseRegion& region : made.regions) {
        for (int y = region.y0; y < region.y1; ++y) {
            for (int x = region.x0; x < region.x1; ++x) {
                pixels.depth.at(x, y) = static_cast<float>(region.plane.at(x + 0.5L, y + 0.5L));
                pixels.object_id.at(x, y) = region.id;
            }
        }
    }
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            const auto lit = [](int n) { return static_cast<std::uint8_t>(n % 2 == 0 ? 0 : 255); };
            pixels.colour.at(x, y) = pattern == CasePattern::index
                                         ? colour_of_index(static_cast<std::uint32_t>(y * size_px.x + x))
                                         : Rgba8{lit(x), lit(y), 0, 255};
        }
    }
    layer.pixels = std::move(pixels);
    return layer;
}

Rgba8 colour_of_index(std::uint32_t index) {
    return {static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8U),
            static_cast<std::uint8_t>(index >> 16U), 255};
}

std::uint32_t index_of_colour(Rgba8 colour) {
    return std::uint32_t{colour.r} | (std::uint32_t{colour.g} << 8U) | (std::uint32_t{colour.b} << 16U);
}

}  // namespace lw::stability
