#include "scene/city_vehicles.h"

#include <array>
#include <cmath>

#include "scene/city_materials.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

/// Side view of a car: heights along z from the rear to the front, metres.
struct BodyStation {
    double z;
    double half_width;
    double low;
    double high;
};

struct Cabin {
    double belt_rear_z, belt_front_z;  ///< lower edge of the windows
    double roof_rear_z, roof_front_z;
    double belt_y, roof_y;
    double belt_half, roof_half;  ///< half widths
    double post_z;                ///< between front and rear side windows
};

struct CarShape {
    const char* name;
    std::vector<BodyStation> stations;
    Cabin cabin;
    double rear_axle_z, front_axle_z, wheel_radius;
    bool rear_side_glass;
};

std::vector<CarShape> car_shapes() {
    return {
        {"hatchback",
         {{-1.92, 0.70, 0.36, 0.80},
          {-1.86, 0.80, 0.28, 0.92},
          {-1.3, 0.86, 0.22, 0.95},
          {0.0, 0.88, 0.2, 0.93},
          {0.85, 0.88, 0.2, 0.93},
          {1.45, 0.85, 0.22, 0.82},
          {1.8, 0.78, 0.26, 0.72},
          {1.92, 0.64, 0.34, 0.6}},
         {-1.82, 0.95, -1.42, 0.25, 0.92, 1.46, 0.82, 0.64, -0.42},
         -1.2,
         1.2,
         0.31,
         true},
        {"saloon",
         {{-2.3, 0.72, 0.4, 0.82},
          {-2.22, 0.82, 0.3, 0.93},
          {-1.6, 0.88, 0.22, 0.97},
          {0.0, 0.9, 0.2, 0.95},
          {0.95, 0.9, 0.2, 0.93},
          {1.7, 0.87, 0.22, 0.83},
          {2.15, 0.8, 0.28, 0.72},
          {2.28, 0.66, 0.36, 0.6}},
         {-1.62, 1.05, -0.95, 0.3, 0.94, 1.42, 0.84, 0.64, -0.35},
         -1.38,
         1.38,
         0.32,
         true},
        {"van",
         {{-2.42, 0.84, 0.42, 1.0},
          {-2.38, 0.92, 0.34, 1.12},
          {-1.6, 0.96, 0.26, 1.15},
          {0.6, 0.96, 0.24, 1.15},
          {1.4, 0.95, 0.24, 1.12},
          {1.95, 0.9, 0.26, 0.98},
          {2.3, 0.82, 0.32, 0.82},
          {2.4, 0.7, 0.4, 0.68}},
         {-2.38, 1.62, -2.3, 0.95, 1.12, 2.05, 0.93, 0.8, 0.35},
         -1.5,
         1.55,
         0.34,
         false},
    };
}

/// A smooth skin over stations: points of a cross-section from the left sill over the top to the right sill.
void add_body(MeshBuilder& builder, const CarShape& shape) {
    constexpr int kAcross = 8;
    const auto section = [](const BodyStation& s) {
        const double h = s.high - s.low;
        const double w = s.half_width;
        return std::array<glm::dvec3, kAcross>{
            glm::dvec3{-w * 0.92, s.low, s.z}, {-w, s.low + 0.3 * h, s.z}, {-w * 0.985, s.low + 0.72 * h, s.z},
            {-w * 0.86, s.high, s.z},          {w * 0.86, s.high, s.z},    {w * 0.985, s.low + 0.72 * h, s.z},
            {w, s.low + 0.3 * h, s.z},         {w * 0.92, s.low, s.z}};
    };
    std::vector<std::array<glm::dvec3, kAcross>> grid;
    for (const BodyStation& s : shape.stations) grid.push_back(section(s));
    const std::size_t rows = grid.size();
    std::vector<glm::dvec3> normals(rows * kAcross, glm::dvec3{0.0});
    const auto at = [&](std::size_t row, std::size_t k) { return row * kAcross + k; };
    for (std::size_t r = 0; r + 1 < rows; ++r) {
        for (std::size_t k = 0; k + 1 < kAcross; ++k) {
            // From left over the top to the right, and forward: (across) x (along z) points outward when negated.
            const glm::dvec3 n = glm::cross(grid[r + 1][k] - grid[r][k + 1], grid[r + 1][k + 1] - grid[r][k]);
            for (const std::size_t index : {at(r, k), at(r, k + 1), at(r + 1, k), at(r + 1, k + 1)})
                normals[index] += n;
        }
    }
    std::vector<std::uint32_t> indices;
    for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t k = 0; k < kAcross; ++k) {
            const glm::dvec3 n = normals[at(r, k)];
            indices.push_back(builder.vertex(grid[r][k], n / std::sqrt(glm::dot(n, n))));
        }
    }
    for (std::size_t r = 0; r + 1 < rows; ++r) {
        for (std::size_t k = 0; k + 1 < kAcross; ++k) {
            builder.triangle(indices[at(r, k)], indices[at(r + 1, k)], indices[at(r + 1, k + 1)]);
            builder.triangle(indices[at(r, k)], indices[at(r + 1, k + 1)], indices[at(r, k + 1)]);
        }
    }
    const auto& rear = grid.front();
    const auto& front = grid.back();
    builder.polygon(
        std::array<glm::dvec3, kAcross>{rear[7], rear[0], rear[1], rear[2], rear[3], rear[4], rear[5], rear[6]});
    builder.polygon(std::array<glm::dvec3, kAcross>{front[0], front[7], front[6], front[5], front[4], front[3],
                                                    front[2], front[1]});
    builder.use_material(kRubber);
    builder.use_colour(tint(0x1A1B1C));
    for (std::size_t r = 0; r + 1 < rows; ++r) {
        builder.polygon({grid[r][0], grid[r][7], grid[r + 1][7], grid[r + 1][0]});
    }
}

/// A pane on the quad a b c d (counter-clockwise), inset from its edges and a little proud of it.
void add_pane(MeshBuilder& builder, const std::array<glm::dvec3, 4>& q, double u0, double u1, double v0, double v1) {
    const auto point = [&](double u, double v) {
        return glm::mix(glm::mix(q[0], q[1], u), glm::mix(q[3], q[2], u), v);
    };
    glm::dvec3 out = glm::cross(q[1] - q[0], q[3] - q[0]);
    out *= 0.008 / std::sqrt(glm::dot(out, out));
    builder.use_material(kGlass);
    builder.use_colour(tint(0x25303A));
    builder.polygon({point(u0, v0) + out, point(u1, v0) + out, point(u1, v1) + out, point(u0, v1) + out});
}

void add_cabin(MeshBuilder& builder, const CarShape& shape, Rgba8 paint) {
    const Cabin& c = shape.cabin;
    const auto corner = [&](double side, bool roof, bool front) {
        const double half = roof ? c.roof_half : c.belt_half;
        const double z = roof ? (front ? c.roof_front_z : c.roof_rear_z) : (front ? c.belt_front_z : c.belt_rear_z);
        return glm::dvec3{side * half, roof ? c.roof_y : c.belt_y - 0.03, z};
    };
    const std::array<std::array<glm::dvec3, 4>, 4> walls{{
        {corner(-1, false, true), corner(1, false, true), corner(1, true, true), corner(-1, true, true)},      // front
        {corner(1, false, false), corner(-1, false, false), corner(-1, true, false), corner(1, true, false)},  // rear
        {corner(1, false, true), corner(1, false, false), corner(1, true, false), corner(1, true, true)},      // +x
        {corner(-1, false, false), corner(-1, false, true), corner(-1, true, true), corner(-1, true, false)},  // -x
    }};
    builder.use_material(kCarPaint);
    builder.use_colour(paint);
    for (const auto& wall : walls) builder.polygon(wall);
    // The roof, slightly domed.
    const double y = c.roof_y + 0.035;
    const double in = 0.16;
    const std::array<glm::dvec3, 4> edge{corner(-1, true, true), corner(1, true, true), corner(1, true, false),
                                         corner(-1, true, false)};
    const std::array<glm::dvec3, 4> top{glm::dvec3{edge[0].x + in, y, edge[0].z - in},
                                        {edge[1].x - in, y, edge[1].z - in},
                                        {edge[2].x - in, y, edge[2].z + in},
                                        {edge[3].x + in, y, edge[3].z + in}};
    builder.polygon(top);
    for (std::size_t i = 0; i < 4; ++i) builder.polygon({edge[i], edge[(i + 1) % 4], top[(i + 1) % 4], top[i]});
    add_pane(builder, walls[0], 0.06, 0.94, 0.06, 0.93);
    add_pane(builder, walls[1], 0.08, 0.92, 0.12, 0.9);
    const double post = (c.belt_front_z - c.post_z) / (c.belt_front_z - c.belt_rear_z);
    add_pane(builder, walls[2], 0.05, post - 0.02, 0.1, 0.9);
    add_pane(builder, walls[3], 1.02 - post, 0.95, 0.1, 0.9);
    if (shape.rear_side_glass) {
        add_pane(builder, walls[2], post + 0.02, 0.93, 0.1, 0.9);
        add_pane(builder, walls[3], 0.07, 0.98 - post, 0.1, 0.9);
    }
}

void add_wheels(MeshBuilder& builder, const CarShape& shape) {
    const double r = shape.wheel_radius;
    for (const double z : {shape.rear_axle_z, shape.front_axle_z}) {
        for (const double side : {-1.0, 1.0}) {
            builder.use_material(kRubber);
            builder.use_colour(tint(0x121314));
            builder.wheel({side * (shape.cabin.belt_half + 0.08), r + 0.03, z}, r + 0.06, side * 0.02, 12);  // the arch
            builder.use_colour(tint(0x2A2B2D));
            builder.wheel({side * (shape.cabin.belt_half + 0.1), r, z}, r, side * 0.2, 16);
            builder.use_material(kIron);
            builder.use_colour(tint(0xB8BCC0));
            builder.wheel({side * (shape.cabin.belt_half + 0.11), r, z}, 0.62 * r, side * 0.02, 10);
        }
    }
}

void add_details(MeshBuilder& builder, const CarShape& shape, Rgba8 paint) {
    const BodyStation& nose = shape.stations[shape.stations.size() - 2];
    const BodyStation& tail = shape.stations[1];
    const double front = shape.stations.back().z;
    const double rear = shape.stations.front().z;
    for (const double side : {-1.0, 1.0}) {
        builder.use_material(kPaint);
        builder.use_colour(tint(0xF3F1E6));
        const double x = side * 0.55;
        builder.box({x - 0.13, nose.high - 0.17, front - 0.14}, {x + 0.13, nose.high - 0.04, front - 0.01});
        builder.use_colour(tint(0xB02A22));
        const double xt = side * (tail.half_width - 0.16);
        builder.box({xt - 0.09, tail.high - 0.3, rear - 0.015}, {xt + 0.09, tail.high - 0.08, rear + 0.12});
        // Mirror and door handles.
        builder.use_material(kCarPaint);
        builder.use_colour(paint);
        const double xm = side * (shape.cabin.belt_half + 0.09);
        builder.box({xm - 0.09, shape.cabin.belt_y + 0.01, shape.cabin.belt_front_z - 0.42},
                    {xm + 0.09, shape.cabin.belt_y + 0.14, shape.cabin.belt_front_z - 0.31});
        builder.use_material(kIron);
        builder.use_colour(tint(0xC4C8CA));
        const double xh = side * shape.stations[3].half_width;
        builder.box({xh - 0.02, shape.cabin.belt_y - 0.16, shape.cabin.post_z + 0.1},
                    {xh + 0.02, shape.cabin.belt_y - 0.12, shape.cabin.post_z + 0.28});
    }
    builder.use_material(kRubber);
    builder.use_colour(tint(0x2E3032));
    builder.box({-0.62, 0.3, front - 0.1}, {0.62, 0.44, front + 0.05});
    builder.box({-0.68, 0.38, rear - 0.05}, {0.68, 0.52, rear + 0.1});
    builder.box({-0.4, 0.5, front - 0.06}, {0.4, 0.58, front + 0.02});
    builder.use_material(kRoadPaint);
    builder.use_colour(tint(0xF2F0E4));
    builder.box({-0.26, 0.31, front + 0.05}, {0.26, 0.42, front + 0.06});
    builder.box({-0.26, 0.58, rear - 0.02}, {0.26, 0.69, rear + 0.02});
}

Mesh make_car(const CarShape& shape, std::uint32_t paint_srgb) {
    MeshBuilder builder{shape.name};
    const Rgba8 paint = tint(paint_srgb);
    builder.use_material(kCarPaint);
    builder.use_colour(paint);
    add_body(builder, shape);
    add_cabin(builder, shape, paint);
    add_wheels(builder, shape);
    add_details(builder, shape, paint);
    builder.darken_towards_ground(0.55, 0.55);
    return builder.take();
}

}  // namespace

std::vector<Mesh> make_vehicles() {
    struct Colour {
        const char* name;
        std::uint32_t srgb;
    };
    static constexpr std::array<Colour, 4> kColours{
        {{"red", 0xA83A32}, {"blue", 0x35608A}, {"cream", 0xE8E0CC}, {"green", 0x4F7358}}};
    static constexpr std::array<Colour, 4> kOthers{
        {{"grey", 0x8D9296}, {"black", 0x34373B}, {"ochre", 0xD09A3C}, {"white", 0xEFEFEA}}};
    std::vector<Mesh> meshes;
    const std::vector<CarShape> shapes = car_shapes();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        for (const Colour& colour : i == 1 ? kOthers : kColours) {
            meshes.push_back(make_car(shapes[i], colour.srgb));
            meshes.back().name += std::string{" "} + colour.name;
        }
    }
    return meshes;
}

}  // namespace lw::scene
