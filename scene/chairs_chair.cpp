#include "scene/chairs_chair.h"

#include <array>

#include "scene/chairs_materials.h"
#include "scene/curved_surface.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr double kSeatHeight_m = 0.45;
constexpr double kSeatRadius_m = 0.205;

void use(MeshBuilder& builder, ChairsMaterial material, Rgba8 colour) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(colour);
}

void add_seat(MeshBuilder& builder) {
    builder.lathe({0.0, kSeatHeight_m - 0.03, 0.0},
                  {{0.02, 0.004},
                   {0.14, 0.002},
                   {0.18, 0.0},
                   {kSeatRadius_m, 0.006},
                   {kSeatRadius_m + 0.012, 0.018},
                   {kSeatRadius_m + 0.010, 0.032},
                   {kSeatRadius_m, 0.040},
                   {0.185, 0.040},
                   {0.17, 0.034},
                   {0.02, 0.030}},
                  40);
}

void add_cushion(MeshBuilder& builder) {
    builder.lathe({0.0, kSeatHeight_m, 0.0},
                  {{0.05, 0.004},
                   {0.165, 0.004},
                   {0.182, 0.014},
                   {0.184, 0.026},
                   {0.176, 0.038},
                   {0.15, 0.046},
                   {0.10, 0.051},
                   {0.05, 0.053},
                   {0.004, 0.054}},
                  32);
}

/// A front leg from the ground to the seat; the back ones run on into the hoop.
void add_front_leg(MeshBuilder& builder, double side) {
    const std::array<glm::dvec3, 5> path{{{0.205 * side, 0.0, -0.215},
                                          {0.185 * side, 0.12, -0.20},
                                          {0.165 * side, 0.26, -0.178},
                                          {0.15 * side, 0.38, -0.16},
                                          {0.142 * side, 0.425, -0.15}}};
    builder.tube(curve(path, 17), 0.0165, 12);
}

void add_back_hoop(MeshBuilder& builder) {
    const std::array<glm::dvec3, 11> path{{{-0.2, 0.0, 0.25},
                                           {-0.19, 0.2, 0.205},
                                           {-0.175, 0.42, 0.165},
                                           {-0.19, 0.6, 0.19},
                                           {-0.165, 0.8, 0.235},
                                           {0.0, 0.905, 0.262},
                                           {0.165, 0.8, 0.235},
                                           {0.19, 0.6, 0.19},
                                           {0.175, 0.42, 0.165},
                                           {0.19, 0.2, 0.205},
                                           {0.2, 0.0, 0.25}}};
    builder.tube(curve(path, 61), 0.0165, 12);
}

void add_inner_hoop(MeshBuilder& builder) {
    const std::array<glm::dvec3, 7> path{{{-0.1, 0.43, 0.175},
                                          {-0.115, 0.56, 0.185},
                                          {-0.1, 0.7, 0.212},
                                          {0.0, 0.79, 0.236},
                                          {0.1, 0.7, 0.212},
                                          {0.115, 0.56, 0.185},
                                          {0.1, 0.43, 0.175}}};
    builder.tube(curve(path, 41), 0.011, 10);
}

void add_leg_ring(MeshBuilder& builder) {
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= 40; ++i) {
        const Direction2 d = direction_of_turns(i / 40.0);
        path.emplace_back(0.178 * d.cosine, 0.24, 0.185 * d.sine);
    }
    builder.tube(path, 0.009, 8);
}

void add_foot(MeshBuilder& builder, const glm::dvec3& at) {
    builder.lathe(at, {{0.019, 0.0}, {0.021, 0.004}, {0.021, 0.014}, {0.019, 0.019}, {0.0165, 0.02}}, 12);
}

}  // namespace

Mesh make_chair(Rgba8 wood, Rgba8 cushion) {
    MeshBuilder builder{"chair"};
    use(builder, kBentWood, wood);
    add_seat(builder);
    for (const double side : {-1.0, 1.0}) add_front_leg(builder, side);
    add_back_hoop(builder);
    add_inner_hoop(builder);
    add_leg_ring(builder);
    use(builder, kFabric, cushion);
    add_cushion(builder);
    use(builder, kFelt, tint(0x2a2522));
    for (const double side : {-1.0, 1.0}) {
        add_foot(builder, {0.205 * side, 0.0, -0.215});
        add_foot(builder, {0.2 * side, 0.0, 0.25});
    }
    return builder.take();
}

}  // namespace lw::scene
