#include "scene/city_building.h"

#include <array>

#include "scene/city_facade.h"
#include "scene/city_roof.h"
#include "scene/city_tiles.h"

namespace lw::scene {

namespace {

constexpr std::array<std::uint32_t, 10> kPlasterColours{0xF2E3C6, 0xEBCDA4, 0xE5B98C, 0xDDA487, 0xEFD6CC,
                                                        0xD5DAC2, 0xC8D5DB, 0xF1EBDF, 0xE9D79A, 0xE3C7B4};
constexpr std::array<std::uint32_t, 4> kBrickColours{0xFFFFFF, 0xFFE9DC, 0xE9D6CE, 0xFFF3DE};
constexpr std::array<std::uint32_t, 5> kTileColours{0xC9714D, 0xB4573C, 0xD08A63, 0xA8523F, 0xBE6A50};
constexpr std::array<std::uint32_t, 2> kSlateColours{0x737B84, 0x5F6770};
constexpr std::array<std::uint32_t, 3> kTrimColours{0xFBF6EA, 0xEFE5D2, 0xE2DAC8};
constexpr std::array<std::uint32_t, 3> kFrameColours{0xF4F0E6, 0xE8E4DA, 0x5B5148};
constexpr std::array<std::uint32_t, 7> kAccentColours{0x4D6B58, 0x44637A, 0x7C3B33, 0x5D6B70,
                                                      0x2F4A44, 0x8A5A33, 0x34466B};

/// The look of one of `kStyleKinds` kinds of house.
BuildingStyle style_of_kind(int kind, Random& random) {
    BuildingStyle style;
    style.wall_colour = tint(random.pick(kPlasterColours));
    style.trim_colour = tint(random.pick(kTrimColours));
    style.frame_colour = tint(random.pick(kFrameColours));
    style.accent_colour = tint(random.pick(kAccentColours));
    style.roof_colour = tint(random.pick(kTileColours));
    style.ground_height_m = random.between(3.5, 3.9);
    style.storey_height_m = random.between(2.95, 3.2);
    style.width_m = kLotWidth_m;
    style.depth_m = random.between(10.2, 11.4);
    switch (kind) {
        case 0:  // plastered terrace house
            style.storeys = 3 + random.below(2);
            style.columns = 4;
            style.shutters = random.chance(0.5);
            style.dormers = random.chance(0.6);
            style.name = "terrace";
            break;
        case 1:  // brick gable house
            style.wall = kBrick;
            style.wall_colour = tint(random.pick(kBrickColours));
            style.roof = RoofKind::gable_front;
            style.storeys = 3;
            style.columns = 3 + random.below(2);
            if (random.chance(0.4)) style.roof_colour = tint(random.pick(kSlateColours));
            style.name = "gable";
            break;
        case 2:  // flats with balconies
            style.roof = RoofKind::flat;
            style.storeys = 4 + random.below(2);
            style.columns = 4;
            style.balconies = true;
            style.shop = random.chance(0.6);
            style.name = "flats";
            break;
        case 3:  // detached house
            style.roof = RoofKind::hip;
            style.storeys = 2 + random.below(2);
            style.columns = 3;
            style.width_m = 9.8;
            style.shutters = random.chance(0.7);
            style.windows_left = true;
            style.windows_right = true;
            if (random.chance(0.4)) style.roof_colour = tint(random.pick(kSlateColours));
            style.name = "villa";
            break;
        case 4:  // brick over a shop
            style.wall = kBrick;
            style.wall_colour = tint(random.pick(kBrickColours));
            style.storeys = 3;
            style.columns = 4;
            style.shop = true;
            style.dormers = random.chance(0.5);
            if (random.chance(0.4)) style.roof_colour = tint(random.pick(kSlateColours));
            style.name = "shop";
            break;
        default:  // plastered with balconies under a roof
            style.storeys = 4;
            style.columns = 4;
            style.balconies = true;
            style.dormers = true;
            style.shop = random.chance(0.5);
            style.name = "mansion";
            break;
    }
    return style;
}

constexpr int kStyleKinds = 6;
constexpr int kMiddleVariants = 12;
constexpr int kEndVariants = 6;

}  // namespace

Mesh make_building(const BuildingStyle& style, Random& random) {
    MeshBuilder builder{style.name};
    add_facade(builder, style, style.width_m, true, true, random);
    builder.place(placement({0.0, 0.0, -style.depth_m}, 0.5));
    add_facade(builder, style, style.width_m, false, true, random);
    builder.place(placement({0.5 * style.width_m, 0.0, -0.5 * style.depth_m}, 0.25));
    add_facade(builder, style, style.depth_m, false, style.windows_right, random);
    builder.place(placement({-0.5 * style.width_m, 0.0, -0.5 * style.depth_m}, -0.25));
    add_facade(builder, style, style.depth_m, false, style.windows_left, random);
    builder.place(glm::dmat4{1.0});
    add_roof(builder, style, random);
    builder.darken_towards_ground(0.4, 1.6);
    return builder.take();
}

std::vector<BuildingVariant> make_building_variants(std::uint64_t seed) {
    std::vector<BuildingVariant> variants;
    const auto add = [&](LotKind lot, int count) {
        for (int i = 0; i < count; ++i) {
            Random random{seed, 1000u + variants.size()};
            BuildingStyle style = style_of_kind(i % kStyleKinds, random);
            style.windows_left = style.windows_left || lot == LotKind::left_end;
            style.windows_right = style.windows_right || lot == LotKind::right_end;
            style.name = "house " + style.name + " " + std::to_string(variants.size() + 1);
            variants.push_back({lot, make_building(style, random)});
        }
    };
    add(LotKind::middle, kMiddleVariants);
    add(LotKind::left_end, kEndVariants);
    add(LotKind::right_end, kEndVariants);
    return variants;
}

Mesh make_church() {
    Random random{7};
    BuildingStyle style;
    style.wall = kPlaster;
    style.wall_colour = tint(0xF0E8D6);
    style.trim_colour = tint(0xD9CDB4);
    style.frame_colour = tint(0x5B5148);
    style.accent_colour = tint(0x5A3B24);
    style.roof_colour = tint(0xA8523F);
    MeshBuilder builder{"church"};
    const auto wall_box = [&](double x, double z0, double z1, double top) {
        builder.use_material(kPlaster, texture_size_m(kPlaster));
        builder.use_colour(style.wall_colour);
        builder.box({-x, 0.0, z1}, {x, top, z0}, kLeft | kRight | kFront | kBack);
    };
    wall_box(4.0, 0.0, -8.0, 24.0);
    wall_box(8.5, -8.0, -34.0, 11.0);
    // Buttresses and tall windows along the nave.
    for (const double side : {0.25, -0.25}) {
        builder.place(placement({side > 0.0 ? 8.5 : -8.5, 0.0, -21.0}, side));
        for (int i = 0; i < 5; ++i) {
            const double x = -10.4 + i * 5.2;
            builder.use_material(kStone, texture_size_m(kStone));
            builder.use_colour(style.trim_colour);
            builder.box({x - 2.9, 0.0, 0.0}, {x - 2.3, 9.0, 0.7}, kNoBack);
            builder.box({x - 1.1, 2.6, 0.0}, {x + 1.1, 9.2, 0.08}, kNoBack);
            builder.use_material(kGlass);
            builder.use_colour(tint(0x33414C));
            builder.box({x - 0.85, 2.9, 0.08}, {x + 0.85, 8.9, 0.1}, kNoBack);
        }
        builder.place(glm::dmat4{1.0});
    }
    const double eaves = 11.0;
    const glm::dvec3 ridge_front{0.0, 18.0, -8.0};
    const glm::dvec3 ridge_back{0.0, 18.0, -34.0};
    add_tiled_slope(builder, style.roof_colour, {9.0, eaves - 0.3, -8.0}, {9.0, eaves - 0.3, -34.3}, ridge_back,
                    ridge_front);
    add_tiled_slope(builder, style.roof_colour, {-9.0, eaves - 0.3, -34.3}, {-9.0, eaves - 0.3, -8.0}, ridge_front,
                    ridge_back);
    builder.use_material(kPlaster, texture_size_m(kPlaster));
    builder.use_colour(style.wall_colour);
    builder.polygon({{-8.5, eaves, -8.0}, {8.5, eaves, -8.0}, {0.0, 17.9, -8.0}});
    builder.polygon({{8.5, eaves, -34.0}, {-8.5, eaves, -34.0}, {0.0, 17.9, -34.0}});
    // Tower: portal, belfry openings, clock, cornice, spire.
    for (int side = 0; side < 4; ++side) {
        builder.place(placement({0.0, 0.0, -4.0}, side * 0.25));
        builder.use_material(kStone, texture_size_m(kStone));
        builder.use_colour(style.trim_colour);
        builder.box({-4.3, 23.6, 3.9}, {4.3, 24.3, 4.4});
        builder.box({-4.15, 13.0, 4.0}, {4.15, 13.4, 4.15}, kNoBack);
        builder.box({-1.3, 17.4, 4.0}, {1.3, 22.4, 4.12}, kNoBack);
        builder.use_material(kGlass);
        builder.use_colour(tint(0x2A2724));
        builder.box({-1.0, 17.7, 4.12}, {1.0, 22.1, 4.14}, kNoBack);
        builder.use_material(kPaint);
        builder.use_colour(tint(0xF4EEDD));
        builder.box({-1.1, 14.1, 4.0}, {1.1, 16.3, 4.1}, kNoBack);
        builder.use_colour(tint(0x2A2724));
        builder.box({-0.06, 15.2, 4.1}, {0.06, 16.1, 4.13}, kNoBack);
        builder.box({0.0, 15.14, 4.1}, {0.6, 15.26, 4.13}, kNoBack);
    }
    builder.place(glm::dmat4{1.0});
    builder.use_material(kWood, texture_size_m(kWood));
    builder.use_colour(tint(0x9A6B45));
    builder.box({-1.3, 0.3, 0.0}, {1.3, 4.0, 0.08}, kNoBack);
    builder.use_material(kStone, texture_size_m(kStone));
    builder.use_colour(style.trim_colour);
    builder.box({-1.8, 0.0, 0.0}, {-1.3, 4.6, 0.3}, kNoBack);
    builder.box({1.3, 0.0, 0.0}, {1.8, 4.6, 0.3}, kNoBack);
    builder.box({-1.8, 4.0, 0.0}, {1.8, 4.7, 0.3}, kNoBack);
    const glm::dvec3 tip{0.0, 40.0, -4.0};
    const Rgba8 copper = tint(0x6F9A88);
    add_tiled_slope(builder, copper, {-4.4, 24.3, 0.4}, {4.4, 24.3, 0.4}, tip, tip);
    add_tiled_slope(builder, copper, {4.4, 24.3, 0.4}, {4.4, 24.3, -8.4}, tip, tip);
    add_tiled_slope(builder, copper, {4.4, 24.3, -8.4}, {-4.4, 24.3, -8.4}, tip, tip);
    add_tiled_slope(builder, copper, {-4.4, 24.3, -8.4}, {-4.4, 24.3, 0.4}, tip, tip);
    builder.use_material(kIron);
    builder.use_colour(tint(0xC9A94E));
    builder.bar({0.0, 39.8, -4.0}, {0.0, 42.2, -4.0}, 0.07, 6);
    builder.bar({-0.6, 41.5, -4.0}, {0.6, 41.5, -4.0}, 0.06, 6);
    builder.darken_towards_ground(0.4, 2.5);
    return builder.take();
}

}  // namespace lw::scene
