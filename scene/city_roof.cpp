#include "scene/city_roof.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/city_facade.h"
#include "scene/city_tiles.h"

namespace lw::scene {

namespace {
void use_trim(MeshBuilder& builder, Rgba8 colour) {
    builder.use_material(kStone, texture_size_m(kStone));
    builder.use_colour(colour);
}

/// A row of ridge tiles.
void add_ridge(MeshBuilder& builder, Rgba8 colour, const glm::dvec3& from, const glm::dvec3& to) {
    builder.use_material(kRoofTile, texture_size_m(kRoofTile));
    builder.use_colour(colour);
    builder.bar(from, to, 0.14, 8);
}

/// Half-round gutter seen from below as a tube, with a pipe down to the ground at its end.
void add_gutter(MeshBuilder& builder, const glm::dvec3& from, const glm::dvec3& to, bool pipe) {
    builder.use_material(kIron);
    builder.use_colour(tint(0x6B6F6C));
    builder.bar(from, to, 0.07, 6);
    if (!pipe) return;
    const std::array<glm::dvec3, 4> path{to, to + glm::dvec3{0.0, -0.15, 0.0}, glm::dvec3{to.x, to.y - 0.85, 0.1},
                                         glm::dvec3{to.x, 0.0, 0.1}};
    builder.tube(path, 0.045, 6);
}

void add_chimney(MeshBuilder& builder, const glm::dvec3& foot, double height_m) {
    builder.use_material(kBrick, texture_size_m(kBrick));
    builder.use_colour(tint(0xF0E4DC));
    builder.box(foot - glm::dvec3{0.5, 0.8, 0.32}, foot + glm::dvec3{0.5, height_m, 0.32}, kNoBottom & ~8u);
    use_trim(builder, tint(0xD8D0C2));
    builder.box(foot + glm::dvec3{-0.58, height_m, -0.4}, foot + glm::dvec3{0.58, height_m + 0.12, 0.4});
    builder.use_material(kRoofTile, texture_size_m(kRoofTile));
    builder.use_colour(tint(0xB8694A));
    for (const double x : {-0.25, 0.25}) {
        builder.lathe(foot + glm::dvec3{x, height_m + 0.12, 0.0},
                      {{0.14, 0.0}, {0.11, 0.35}, {0.14, 0.38}, {0.14, 0.45}, {0.1, 0.45}, {0.0, 0.4}}, 8);
    }
}

void add_dormer(MeshBuilder& builder, const BuildingStyle& style, double x, double pitch, Random& random) {
    constexpr double kHalf = 0.85;
    constexpr double kFront_m = -1.0;
    constexpr double kWall_m = 1.35;
    const double base = style.eaves_height_m() - kFront_m * pitch - 0.1;
    const double top = base + kWall_m;
    const double back = -(top + 0.7 - style.eaves_height_m()) / pitch;
    const glm::dmat4 outer = builder.placed();
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.wall_colour);
    builder.box({x - kHalf, base - 0.3, back}, {x + kHalf, top, kFront_m}, kLeft | kRight);
    builder.polygon({{x - kHalf, top, kFront_m}, {x + kHalf, top, kFront_m}, {x, top + 0.62, kFront_m}});
    builder.place(outer * placement({x, 0.0, kFront_m}));
    const Opening opening{-0.5, 0.5, base + 0.22, top - 0.08, OpeningKind::window};
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.wall_colour);
    const WallCuts wall = add_wall(builder, -kHalf, kHalf, base - 0.3, top, std::span{&opening, 1});
    add_window(builder, style, opening, 2, 2, wall, random);
    use_trim(builder, style.trim_colour);
    builder.box({-0.62, base + 0.14, -0.1}, {0.62, base + 0.22, 0.1}, kNoBack);
    builder.box({-kHalf - 0.1, top - 0.06, 0.0}, {kHalf + 0.1, top + 0.04, 0.08}, kNoBack);
    builder.place(outer);
    const double out = kFront_m + 0.25;
    const double ridge = top + 0.72;
    const double edge = kHalf + 0.18;
    add_tiled_slope(builder, style.roof_colour, {x + edge, top - 0.05, out}, {x + edge, top - 0.05, back},
                    {x, ridge, back}, {x, ridge, out});
    add_tiled_slope(builder, style.roof_colour, {x - edge, top - 0.05, back}, {x - edge, top - 0.05, out},
                    {x, ridge, out}, {x, ridge, back});
    add_ridge(builder, style.roof_colour, {x, ridge, back}, {x, ridge, out});
}

/// Beams of stone along both sloping edges of a gable at `x`, from the eaves at z0 and z1 up to the ridge.
void add_gable_end(MeshBuilder& builder, const BuildingStyle& style, double x, double z0, double z1, double rise_m) {
    const double eaves = style.eaves_height_m();
    const double middle = 0.5 * (z0 + z1);
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.wall_colour);
    const double side = x > 0.0 ? 1.0 : -1.0;
    const double front = x > 0.0 ? z0 : z1;
    const double back = x > 0.0 ? z1 : z0;
    builder.polygon({{x, eaves - 0.2, front},
                     {x, eaves - 0.2, back},
                     {x, eaves, back},
                     {x, eaves + rise_m, middle},
                     {x, eaves, front}});
    use_trim(builder, style.trim_colour);
    const double inset = x - side * 0.14;
    const double slope = rise_m / (0.5 * (z0 - z1));
    builder.beam({inset, eaves - 0.45 * slope + 0.02, z0 + 0.45}, {inset, eaves + rise_m + 0.05, middle}, 0.3, 0.36);
    builder.beam({inset, eaves - 0.45 * slope + 0.02, z1 - 0.45}, {inset, eaves + rise_m + 0.05, middle}, 0.3, 0.36);
}

void add_gable_along(MeshBuilder& builder, const BuildingStyle& style, Random& random) {
    const double half = 0.5 * style.width_m;
    const double depth = style.depth_m;
    const double pitch = 0.8;
    const double rise = 0.5 * depth * pitch;
    const double eaves = style.eaves_height_m();
    constexpr double kOver_m = 0.45;
    const double low = eaves - kOver_m * pitch + 0.05;
    const double x = half - 0.22;
    const glm::dvec3 ridge_left{-x, eaves + rise + 0.05, -0.5 * depth};
    const glm::dvec3 ridge_right{x, eaves + rise + 0.05, -0.5 * depth};
    add_tiled_slope(builder, style.roof_colour, {-x, low, kOver_m}, {x, low, kOver_m}, ridge_right, ridge_left);
    add_tiled_slope(builder, style.roof_colour, {x, low, -depth - kOver_m}, {-x, low, -depth - kOver_m}, ridge_left,
                    ridge_right);
    add_ridge(builder, style.roof_colour, ridge_left, ridge_right);
    add_gable_end(builder, style, half, 0.0, -depth, rise);
    add_gable_end(builder, style, -half, 0.0, -depth, rise);
    add_gutter(builder, {-half, low - 0.02, kOver_m + 0.05}, {half - 0.15, low - 0.02, kOver_m + 0.05}, true);
    if (style.dormers) {
        const int count = style.columns > 3 ? 2 : 1;
        for (int i = 0; i < count; ++i) {
            add_dormer(builder, style, (i + 0.5) * style.width_m / count - half, pitch, random);
        }
    }
    const double chimney_x = (random.chance(0.5) ? 1.0 : -1.0) * half * random.between(0.45, 0.72);
    add_chimney(builder, {chimney_x, eaves + rise, -0.5 * depth}, 1.15);
    if (random.chance(0.7)) add_antenna(builder, {-chimney_x * 0.8, eaves + rise, -0.5 * depth}, 2.4, random);
}

/// A gable wall in steps, in a facade's local space.
void add_stepped_gable(MeshBuilder& builder, const BuildingStyle& style, double rise_m, bool window, Random& random) {
    constexpr int kSteps = 6;
    constexpr double kThick_m = 0.36;
    const double half = 0.5 * style.width_m;
    const double eaves = style.eaves_height_m();
    const double height = rise_m / kSteps;
    const double top = eaves + rise_m + 0.35;
    const auto outer_x = [&](int step) { return half * (1.0 - static_cast<double>(step) / (kSteps + 0.6)); };
    const auto top_of = [&](int step) { return step == kSteps - 1 ? top : eaves + (step + 1) * height + 0.35; };
    std::vector<Opening> cut;
    for (int i = 1; i < kSteps; ++i) {
        cut.push_back({-half, -outer_x(i), top_of(i - 1), top});
        cut.push_back({outer_x(i), half, top_of(i - 1), top});
    }
    const Opening attic{-0.55, 0.55, eaves + 0.9, eaves + 2.3, OpeningKind::window};
    if (window) cut.push_back(attic);
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.wall_colour);
    const WallCuts wall = add_wall(builder, -half, half, eaves - 0.2, top, cut);
    for (int i = 0; i < kSteps; ++i) {
        const double x = outer_x(i);
        const double low = i == 0 ? eaves - 0.2 : top_of(i - 1);
        builder.use_material(style.wall, texture_size_m(style.wall));
        builder.use_colour(style.wall_colour);
        builder.box({-x, low, -kThick_m}, {x, top_of(i), 0.0}, kLeft | kRight | kBack);
        use_trim(builder, style.trim_colour);
        const double inner = i + 1 < kSteps ? outer_x(i + 1) : 0.0;
        builder.box({-x - 0.05, top_of(i), -kThick_m - 0.05}, {-inner, top_of(i) + 0.1, 0.07});
        builder.box({inner, top_of(i), -kThick_m - 0.05}, {x + 0.05, top_of(i) + 0.1, 0.07});
    }
    if (!window) return;
    add_window(builder, style, attic, 2, 2, wall, random);
    use_trim(builder, style.trim_colour);
    builder.box({attic.x0 - 0.12, attic.y0 - 0.1, -0.1}, {attic.x1 + 0.12, attic.y0, 0.12}, kNoBack);
    builder.box({attic.x0 - 0.12, attic.y1, 0.0}, {attic.x1 + 0.12, attic.y1 + 0.18, 0.08}, kNoBack);
}

void add_gable_front(MeshBuilder& builder, const BuildingStyle& style, Random& random) {
    const double half = 0.5 * style.width_m;
    const double depth = style.depth_m;
    const double rise = half * 0.85;
    const double eaves = style.eaves_height_m();
    const double front = -0.3;
    const double back = -depth + 0.3;
    const glm::dvec3 ridge_front{0.0, eaves + rise, front};
    const glm::dvec3 ridge_back{0.0, eaves + rise, back};
    add_tiled_slope(builder, style.roof_colour, {half, eaves, front}, {half, eaves, back}, ridge_back, ridge_front);
    add_tiled_slope(builder, style.roof_colour, {-half, eaves, back}, {-half, eaves, front}, ridge_front, ridge_back);
    add_ridge(builder, style.roof_colour, ridge_front, ridge_back);
    add_stepped_gable(builder, style, rise, true, random);
    const glm::dmat4 outer = builder.placed();
    builder.place(outer * placement({0.0, 0.0, -depth}, 0.5));
    add_stepped_gable(builder, style, rise, false, random);
    builder.place(outer);
    add_chimney(builder, {half * 0.45, eaves + rise * 0.55, -0.6 * depth}, rise * 0.45 + 0.9);
    if (random.chance(0.6)) add_antenna(builder, {-0.1, eaves + rise, -0.7 * depth}, 2.2, random);
}

void add_hip(MeshBuilder& builder, const BuildingStyle& style, Random& random) {
    constexpr double kOver_m = 0.55;
    const double half = 0.5 * style.width_m + kOver_m;
    const double front = kOver_m;
    const double back = -style.depth_m - kOver_m;
    const double eaves = style.eaves_height_m() - 0.02;
    const double middle = 0.5 * (front + back);
    const double ridge_half = std::max(0.8, half - 0.5 * (front - back));
    const double rise = 0.62 * 0.5 * (front - back);
    const glm::dvec3 left{-ridge_half, eaves + rise, middle};
    const glm::dvec3 right{ridge_half, eaves + rise, middle};
    const glm::dvec3 fl{-half, eaves, front};
    const glm::dvec3 fr{half, eaves, front};
    const glm::dvec3 bl{-half, eaves, back};
    const glm::dvec3 br{half, eaves, back};
    add_tiled_slope(builder, style.roof_colour, fl, fr, right, left);
    add_tiled_slope(builder, style.roof_colour, br, bl, left, right);
    add_tiled_slope(builder, style.roof_colour, fr, br, right, right);
    add_tiled_slope(builder, style.roof_colour, bl, fl, left, left);
    add_ridge(builder, style.roof_colour, left, right);
    for (const auto& [corner, top] :
         {std::pair{fl, left}, std::pair{bl, left}, std::pair{fr, right}, std::pair{br, right}}) {
        add_ridge(builder, style.roof_colour, corner, top);
    }
    // Boarded underside of the overhang.
    builder.use_material(kPaint);
    builder.use_colour(style.frame_colour);
    builder.box({-half, eaves - 0.14, back}, {half, eaves - 0.02, front}, kNoBottom & ~8u);
    builder.polygon({{-half, eaves - 0.14, back},
                     {half, eaves - 0.14, back},
                     {half, eaves - 0.14, front},
                     {-half, eaves - 0.14, front}});
    add_gutter(builder, {-half, eaves - 0.06, front + 0.06}, {half - 0.7, eaves - 0.06, front + 0.06}, true);
    add_chimney(builder, {-half * 0.3, eaves + rise * 0.85, middle - 0.8}, rise * 0.15 + 1.0);
    if (random.chance(0.5)) add_antenna(builder, right, 2.2, random);
}

void add_flat(MeshBuilder& builder, const BuildingStyle& style, Random& random) {
    const double half = 0.5 * style.width_m;
    const double depth = style.depth_m;
    const double eaves = style.eaves_height_m();
    const double top = eaves + 0.75;
    constexpr double kThick_m = 0.3;
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.wall_colour);
    builder.box({-half, eaves - 0.1, -kThick_m}, {half, top, 0.0}, kFront | kBack | kLeft | kRight);
    builder.box({-half, eaves - 0.1, -depth}, {half, top, -depth + kThick_m}, kFront | kBack | kLeft | kRight);
    builder.box({-half, eaves - 0.1, -depth + kThick_m}, {-half + kThick_m, top, -kThick_m}, kLeft | kRight);
    builder.box({half - kThick_m, eaves - 0.1, -depth + kThick_m}, {half, top, -kThick_m}, kLeft | kRight);
    use_trim(builder, style.trim_colour);
    builder.box({-half - 0.04, top, -kThick_m - 0.04}, {half + 0.04, top + 0.1, 0.06});
    builder.box({-half - 0.04, top, -depth - 0.06}, {half + 0.04, top + 0.1, -depth + kThick_m + 0.04});
    builder.box({-half - 0.04, top, -depth + kThick_m + 0.04}, {-half + kThick_m + 0.04, top + 0.1, -kThick_m - 0.04},
                kLeft | kRight | kTop);
    builder.box({half - kThick_m - 0.04, top, -depth + kThick_m + 0.04}, {half + 0.04, top + 0.1, -kThick_m - 0.04},
                kLeft | kRight | kTop);
    builder.use_material(kRoofFelt, texture_size_m(kRoofFelt));
    builder.use_colour(tint(0xE6E2DA));
    builder.polygon({{-half, eaves + 0.05, 0.0},
                     {half, eaves + 0.05, 0.0},
                     {half, eaves + 0.05, -depth},
                     {-half, eaves + 0.05, -depth}});
    // Stair head, vents, railing towards the street.
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(style.trim_colour);
    const double hut = (random.chance(0.5) ? 1.0 : -1.0) * half * 0.4;
    builder.box({hut - 1.4, eaves, -depth + 1.2}, {hut + 1.4, eaves + 2.6, -depth + 4.2}, kNoBottom);
    builder.use_material(kIron);
    builder.use_colour(tint(0x9AA0A2));
    for (int i = 0; i < 3; ++i) {
        builder.lathe({-hut + (i - 1) * 0.9, eaves, -0.5 * depth},
                      {{0.16, 0.0}, {0.16, 0.75}, {0.27, 0.8}, {0.27, 0.9}, {0.0, 1.02}}, 8);
    }
    builder.use_colour(tint(0x2A2D30));
    const double rail = top + 0.1;
    builder.bar({-half + 0.2, rail + 0.55, -0.12}, {half - 0.2, rail + 0.55, -0.12}, 0.022);
    builder.bar({-half + 0.2, rail + 0.3, -0.12}, {half - 0.2, rail + 0.3, -0.12}, 0.012);
    const int posts = static_cast<int>(style.width_m / 1.2);
    for (int i = 0; i <= posts; ++i) {
        const double x = -half + 0.2 + (style.width_m - 0.4) * i / posts;
        builder.bar({x, rail, -0.12}, {x, rail + 0.55, -0.12}, 0.018);
    }
    add_antenna(builder, {hut, eaves + 2.6, -depth + 2.6}, 2.6, random);
}

}  // namespace

void add_antenna(MeshBuilder& builder, const glm::dvec3& foot, double height_m, Random& random) {
    builder.use_material(kIron);
    builder.use_colour(tint(0x8C9094));
    builder.bar(foot - glm::dvec3{0.0, 0.4, 0.0}, foot + glm::dvec3{0.0, height_m, 0.0}, 0.022, 5);
    const Direction2 d = direction_of_turns(random.unit());
    const glm::dvec3 along{d.cosine, 0.0, d.sine};
    const glm::dvec3 across{-d.sine, 0.0, d.cosine};
    for (const double drop : {0.1, 0.75}) {
        const glm::dvec3 boom = foot + glm::dvec3{0.0, height_m - drop, 0.0};
        builder.bar(boom - along * 0.6, boom + along * 0.7, 0.012);
        for (int i = 0; i < 7; ++i) {
            const glm::dvec3 at = boom + along * (-0.55 + i * 0.2);
            const double half = 0.45 - i * 0.04;
            builder.bar(at - across * half, at + across * half, 0.007, 3);
        }
    }
}

void add_roof(MeshBuilder& builder, const BuildingStyle& style, Random& random) {
    switch (style.roof) {
        case RoofKind::gable_along:
            add_gable_along(builder, style, random);
            break;
        case RoofKind::gable_front:
            add_gable_front(builder, style, random);
            break;
        case RoofKind::hip:
            add_hip(builder, style, random);
            break;
        case RoofKind::flat:
            add_flat(builder, style, random);
            break;
    }
}

}  // namespace lw::scene
