#include "scene/chairs_scooter.h"

#include <array>

#include "scene/chairs_materials.h"
#include "scene/curved_surface.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr double kWheelRadius_m = 0.22;
constexpr double kFrontAxleZ_m = -0.64;
constexpr double kRearAxleZ_m = 0.56;
constexpr glm::dvec3 kAcross{1.0, 0.0, 0.0};
constexpr glm::dvec3 kUp{0.0, 1.0, 0.0};

void use(MeshBuilder& builder, ChairsMaterial material, Rgba8 colour) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(colour);
}

/// Cross-section of a body at a place along z.
struct Station {
    double z;
    double centre_y;
    double half_width;
    double half_height;
    double roundness;
};

/// A closed body through the stations, which run towards -z; refined to `rings` cross-sections.
template <std::size_t N>
void add_body(MeshBuilder& builder, const std::array<Station, N>& stations, int rings, int sides) {
    std::array<glm::dvec3, N> centres;
    std::array<glm::dvec3, N> shapes;
    for (std::size_t i = 0; i < N; ++i) {
        centres[i] = {0.0, stations[i].centre_y, stations[i].z};
        shapes[i] = {stations[i].half_width, stations[i].half_height, stations[i].roundness};
    }
    std::vector<glm::dvec3> points;
    for (int ring = 0; ring < rings; ++ring) {
        const double t = static_cast<double>(ring) / (rings - 1);
        const glm::dvec3 shape = glm::max(on_curve(shapes, t), glm::dvec3{1e-4, 1e-4, 0.0});
        for (const glm::dvec3& point :
             rounded_section(on_curve(centres, t), kAcross, kUp, shape.x, shape.y, shape.z, sides)) {
            points.push_back(point);
        }
    }
    add_sheet(builder, points, sides, true);
}

void add_rear_body(MeshBuilder& builder) {
    add_body(builder,
             std::array<Station, 8>{{{0.84, 0.46, 0.01, 0.01, 1.0},
                                     {0.82, 0.46, 0.12, 0.12, 1.0},
                                     {0.70, 0.47, 0.21, 0.19, 0.9},
                                     {0.50, 0.48, 0.24, 0.22, 0.8},
                                     {0.28, 0.48, 0.22, 0.23, 0.7},
                                     {0.12, 0.48, 0.17, 0.24, 0.7},
                                     {0.03, 0.46, 0.13, 0.22, 0.8},
                                     {0.02, 0.46, 0.01, 0.02, 1.0}}},
             30, 28);
}

void add_floor_board(MeshBuilder& builder) {
    add_body(builder,
             std::array<Station, 5>{{{0.12, 0.24, 0.14, 0.05, 0.5},
                                     {0.0, 0.23, 0.18, 0.04, 0.3},
                                     {-0.2, 0.23, 0.19, 0.035, 0.3},
                                     {-0.34, 0.24, 0.17, 0.04, 0.4},
                                     {-0.42, 0.28, 0.10, 0.03, 0.6}}},
             14, 20);
}

/// The bent panel before the rider's knees.
void add_leg_shield(MeshBuilder& builder) {
    constexpr int kColumns = 19;
    constexpr int kRows = 21;
    std::vector<glm::dvec3> points;
    for (int row = 0; row < kRows; ++row) {
        const double t = static_cast<double>(row) / (kRows - 1);
        const double half_width_m = 0.2 + 0.13 * t * (1.0 - t) * 2.0 - 0.09 * t * t * t;
        for (int column = 0; column < kColumns; ++column) {
            const double s = 2.0 * column / (kColumns - 1) - 1.0;
            const double z = -0.36 - 0.16 * t + 0.14 * s * s - 0.03 * (1.0 - t) * (1.0 - t);
            points.emplace_back(-half_width_m * s, 0.26 + 0.62 * t, z);
        }
    }
    add_sheet(builder, points, kColumns, false);
}

void add_front_fender(MeshBuilder& builder) {
    constexpr int kColumns = 13;
    constexpr int kRows = 21;
    std::vector<glm::dvec3> points;
    for (int row = 0; row < kRows; ++row) {
        const double t = static_cast<double>(row) / (kRows - 1);
        const Direction2 along = direction_of_turns(0.02 + 0.46 * t);
        const double half_width_m = 0.035 + 0.2 * t * (1.0 - t);
        for (int column = 0; column < kColumns; ++column) {
            const double s = 2.0 * column / (kColumns - 1) - 1.0;
            const double reach_m = kWheelRadius_m + 0.065 - 0.06 * s * s;
            points.emplace_back(half_width_m * s, kWheelRadius_m + reach_m * along.sine,
                                kFrontAxleZ_m + reach_m * along.cosine);
        }
    }
    add_sheet(builder, points, kColumns, false);
}

/// A wheel about the x axis: the lathe's own axis is y.
void add_wheel(MeshBuilder& builder, double axle_z) {
    const glm::dmat4 upright{
        {0.0, -1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}, {0.0, kWheelRadius_m, axle_z, 1.0}};
    builder.place(upright);
    use(builder, kTyre, tint(0x1c1c1e));
    std::vector<ProfilePoint> tyre;
    for (int i = 0; i <= 14; ++i) {
        const Direction2 d = direction_of_turns(-0.36 + 0.72 * i / 14.0);
        tyre.push_back({0.17 + 0.05 * d.cosine, 0.048 * d.sine});
    }
    builder.lathe({0.0, 0.0, 0.0}, tyre, 32);
    use(builder, kChrome, tint(0xc9ccd0));
    builder.lathe({0.0, 0.0, 0.0},
                  {{0.01, -0.035},
                   {0.05, -0.035},
                   {0.09, -0.015},
                   {0.125, -0.03},
                   {0.14, -0.032},
                   {0.14, 0.032},
                   {0.125, 0.03},
                   {0.09, 0.015},
                   {0.05, 0.035},
                   {0.01, 0.035}},
                  28);
    builder.place(glm::dmat4{1.0});
}

void add_steering(MeshBuilder& builder) {
    const std::array<glm::dvec3, 3> column{{{0.0, 0.24, -0.62}, {0.0, 0.6, -0.54}, {0.0, 0.95, -0.46}}};
    builder.tube(curve(column, 13), 0.026, 12);
    const std::array<glm::dvec3, 5> bar{
        {{-0.34, 0.985, -0.37}, {-0.2, 1.0, -0.43}, {0.0, 0.98, -0.47}, {0.2, 1.0, -0.43}, {0.34, 0.985, -0.37}}};
    builder.tube(curve(bar, 33), 0.014, 10);
    for (const double side : {-1.0, 1.0}) {
        const std::array<glm::dvec3, 3> stalk{
            {{0.2 * side, 1.0, -0.43}, {0.24 * side, 1.09, -0.46}, {0.27 * side, 1.16, -0.45}}};
        builder.tube(curve(stalk, 9), 0.006, 6);
        builder.lathe({0.28 * side, 1.15, -0.45},
                      {{0.01, 0.0}, {0.035, 0.004}, {0.05, 0.02}, {0.05, 0.06}, {0.035, 0.076}, {0.004, 0.08}}, 16);
    }
}

void add_grips(MeshBuilder& builder) {
    for (const double side : {-1.0, 1.0}) {
        const std::array<glm::dvec3, 3> grip{
            {{0.24 * side, 0.996, -0.41}, {0.3 * side, 0.991, -0.388}, {0.37 * side, 0.98, -0.357}}};
        builder.tube(curve(grip, 9), 0.02, 12);
    }
}

void add_head_lamp(MeshBuilder& builder, Rgba8 paint) {
    const double lean = 0.5;  // of a right angle: the lathe's axis turns from +y towards -z
    const Direction2 d = direction_of_turns(0.25 * (1.0 + lean * 0.2));
    builder.place(
        {{1.0, 0.0, 0.0, 0.0}, {0.0, d.cosine, -d.sine, 0.0}, {0.0, d.sine, d.cosine, 0.0}, {0.0, 0.94, -0.46, 1.0}});
    use(builder, kScooterPaint, paint);
    builder.lathe({0.0, -0.06, 0.0},
                  {{0.02, 0.0}, {0.06, 0.01}, {0.085, 0.04}, {0.092, 0.08}, {0.088, 0.11}, {0.082, 0.12}}, 24);
    use(builder, kLens, tint(0xdfe6ea));
    builder.lathe({0.0, -0.06, 0.0}, {{0.082, 0.12}, {0.06, 0.132}, {0.03, 0.138}, {0.003, 0.14}}, 24);
    builder.place(glm::dmat4{1.0});
}

void add_saddle(MeshBuilder& builder) {
    add_body(builder,
             std::array<Station, 6>{{{0.74, 0.745, 0.02, 0.02, 1.0},
                                     {0.70, 0.75, 0.11, 0.05, 0.8},
                                     {0.50, 0.75, 0.14, 0.055, 0.7},
                                     {0.28, 0.735, 0.12, 0.05, 0.7},
                                     {0.12, 0.725, 0.085, 0.045, 0.8},
                                     {0.06, 0.725, 0.02, 0.015, 1.0}}},
             18, 22);
}

void add_chrome_trim(MeshBuilder& builder) {
    const std::array<glm::dvec3, 4> rack{{{-0.1, 0.66, 0.8}, {-0.09, 0.7, 0.92}, {0.09, 0.7, 0.92}, {0.1, 0.66, 0.8}}};
    builder.tube(curve(rack, 21), 0.009, 8);
    const std::array<glm::dvec3, 3> exhaust{{{0.12, 0.2, 0.2}, {0.16, 0.18, 0.45}, {0.17, 0.2, 0.78}}};
    builder.tube(curve(exhaust, 13), 0.032, 12);
    const std::array<glm::dvec3, 3> stand{{{-0.13, 0.22, 0.1}, {-0.2, 0.1, 0.12}, {-0.25, 0.01, 0.14}}};
    builder.tube(curve(stand, 9), 0.012, 8);
}

}  // namespace

Mesh make_scooter(Rgba8 paint, Rgba8 saddle) {
    MeshBuilder builder{"scooter"};
    use(builder, kScooterPaint, paint);
    add_rear_body(builder);
    add_floor_board(builder);
    add_leg_shield(builder);
    add_front_fender(builder);
    add_wheel(builder, kFrontAxleZ_m);
    add_wheel(builder, kRearAxleZ_m);
    use(builder, kChrome, tint(0xc9ccd0));
    add_steering(builder);
    add_chrome_trim(builder);
    use(builder, kTyre, tint(0x1c1c1e));
    add_grips(builder);
    add_head_lamp(builder, paint);
    use(builder, kLeather, saddle);
    add_saddle(builder);
    use(builder, kTailLamp, tint(0xb01010));
    builder.lathe({0.0, 0.56, 0.84}, {{0.01, -0.03}, {0.035, -0.025}, {0.04, 0.0}, {0.035, 0.025}, {0.01, 0.03}}, 14);
    return builder.take();
}

}  // namespace lw::scene
