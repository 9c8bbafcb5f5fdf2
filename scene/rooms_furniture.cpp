#include "scene/rooms_furniture.h"

#include <array>

#include "scene/city_materials.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

void use(MeshBuilder& builder, CityMaterial material, std::uint32_t srgb_hex) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(tint(srgb_hex));
}

constexpr std::array<std::uint32_t, 9> kBookColours{0x7C3B33, 0x2F4A44, 0x34466B, 0x8A5A33, 0xB9AE9A,
                                                    0x4D6B58, 0xA58F7C, 0x44637A, 0xC9A94E};

/// Books side by side on a board.
void add_books(MeshBuilder& builder, double x0, double x1, double y, double z0, double depth, Random& random) {
    builder.use_material(kPaint);
    double x = x0;
    while (true) {
        const double thick = random.between(0.022, 0.05);
        if (x + thick > x1) return;
        if (random.chance(0.12)) {
            x += 2.0 * thick;
            continue;
        }
        builder.use_colour(tint(random.pick(kBookColours)));
        const double height = random.between(0.2, 0.29);
        const double deep = depth * random.between(0.75, 0.97);
        builder.box({x, y, z0}, {x + thick - 0.002, y + height, z0 + deep}, kAllSides & ~unsigned{kBottom | kBack});
        x += thick;
    }
}

Mesh make_desk() {
    MeshBuilder builder{"desk"};
    use(builder, kWood, 0xC9A87C);
    builder.box({-0.8, 0.71, 0.02}, {0.8, 0.74, 0.82});
    use(builder, kPaint, 0xD8D8D4);
    builder.box({0.32, 0.08, 0.1}, {0.76, 0.7, 0.76});
    for (int i = 0; i < 4; ++i) {
        builder.box({0.34, 0.1 + i * 0.15, 0.76}, {0.74, 0.235 + i * 0.15, 0.775}, kNoBack);
        builder.bar({0.48, 0.17 + i * 0.15, 0.79}, {0.6, 0.17 + i * 0.15, 0.79}, 0.006, 6);
    }
    use(builder, kIron, 0x4A4F52);
    for (const double z : {0.08, 0.76}) builder.bar({-0.75, 0.0, z}, {-0.75, 0.71, z}, 0.022, 8);
    // Screen, keyboard, mug.
    use(builder, kPaint, 0x23262A);
    builder.box({-0.33, 0.86, 0.2}, {0.33, 1.24, 0.235});
    builder.box({-0.04, 0.74, 0.19}, {0.04, 0.9, 0.21});
    builder.lathe({0.0, 0.74, 0.22}, {{0.13, 0.0}, {0.13, 0.015}, {0.0, 0.02}}, 16);
    use(builder, kGlass, 0x6F93B8);
    builder.polygon({{-0.315, 0.875, 0.236}, {0.315, 0.875, 0.236}, {0.315, 1.225, 0.236}, {-0.315, 1.225, 0.236}});
    use(builder, kPaint, 0x3A3E42);
    for (int row = 0; row < 5; ++row) {
        for (int key = 0; key < 14; ++key) {
            const double x = -0.21 + key * 0.03;
            const double z = 0.42 + row * 0.028;
            builder.box({x, 0.74, z}, {x + 0.025, 0.752, z + 0.023}, kNoBottom);
        }
    }
    use(builder, kPaint, 0xC8553D);
    builder.lathe({-0.45, 0.74, 0.5}, {{0.0, 0.0}, {0.04, 0.0}, {0.04, 0.095}, {0.034, 0.095}, {0.034, 0.02}}, 18);
    return builder.take();
}

Mesh make_office_chair() {
    MeshBuilder builder{"office chair"};
    use(builder, kRubber, 0x2A2C30);
    builder.lathe({0.0, 0.44, 0.0}, {{0.0, 0.0}, {0.2, 0.0}, {0.24, 0.03}, {0.24, 0.07}, {0.2, 0.09}, {0.0, 0.095}},
                  24);
    builder.box({-0.2, 0.62, -0.24}, {0.2, 1.05, -0.18});
    use(builder, kIron, 0x3C4043);
    builder.bar({0.0, 0.1, 0.0}, {0.0, 0.45, 0.0}, 0.028, 12);
    builder.bar({0.0, 0.5, -0.2}, {0.0, 0.7, -0.21}, 0.02, 8);
    for (int i = 0; i < 5; ++i) {
        const Direction2 d = direction_of_turns(i / 5.0);
        builder.bar({0.0, 0.1, 0.0}, {0.3 * d.cosine, 0.07, 0.3 * d.sine}, 0.016, 8);
        builder.lathe({0.3 * d.cosine, 0.0, 0.3 * d.sine}, {{0.0, 0.0}, {0.025, 0.012}, {0.025, 0.04}, {0.0, 0.055}},
                      10);
    }
    for (const double x : {-0.26, 0.26}) {
        builder.bar({x, 0.5, -0.02}, {x, 0.66, -0.02}, 0.014, 8);
        builder.box({x - 0.03, 0.66, -0.14}, {x + 0.03, 0.685, 0.12});
    }
    return builder.take();
}

Mesh make_bookcase(std::uint64_t seed) {
    MeshBuilder builder{"bookcase"};
    Random random{seed, 501};
    constexpr double kDepth = 0.3;
    use(builder, kWood, 0xA9825A);
    for (const double x : {-0.5, 0.475}) builder.box({x, 0.0, 0.0}, {x + 0.025, 2.0, kDepth});
    builder.box({-0.475, 0.0, 0.0}, {0.475, 2.0, 0.012});
    for (int i = 0; i < 6; ++i) {
        use(builder, kWood, 0xA9825A);
        const double y = 0.05 + i * 0.38;
        builder.box({-0.475, y, 0.012}, {0.475, y + 0.022, kDepth});
        if (i < 5) add_books(builder, -0.46, 0.46, y + 0.022, 0.014, kDepth, random);
    }
    return builder.take();
}

Mesh make_filing_cabinet() {
    MeshBuilder builder{"filing cabinet"};
    use(builder, kPaint, 0x9FA8A3);
    builder.box({-0.23, 0.0, 0.0}, {0.23, 1.32, 0.6});
    for (int i = 0; i < 4; ++i) {
        const double y = 0.03 + i * 0.32;
        builder.use_colour(tint(0xAEB7B2));
        builder.box({-0.21, y, 0.6}, {0.21, y + 0.3, 0.615}, kNoBack);
        builder.use_colour(tint(0x4A4F52));
        builder.bar({-0.06, y + 0.2, 0.635}, {0.06, y + 0.2, 0.635}, 0.008, 8);
        builder.box({-0.05, y + 0.23, 0.615}, {0.05, y + 0.27, 0.622}, kNoBack);
    }
    return builder.take();
}

Mesh make_meeting_table() {
    MeshBuilder builder{"meeting table"};
    use(builder, kWood, 0xB88A5C);
    builder.box({-1.3, 0.72, -0.55}, {1.3, 0.76, 0.55});
    use(builder, kIron, 0x55595C);
    for (const double x : {-0.9, 0.9}) {
        builder.lathe({x, 0.0, 0.0}, {{0.32, 0.0}, {0.32, 0.02}, {0.06, 0.06}, {0.05, 0.4}, {0.06, 0.7}, {0.2, 0.72}},
                      24);
    }
    use(builder, kPaint, 0xF2F0EA);
    for (int i = 0; i < 6; ++i) {
        const double x = -0.9 + 0.9 * (i % 3);
        const double z = i < 3 ? -0.3 : 0.3;
        builder.box({x - 0.105, 0.76, z - 0.148}, {x + 0.105, 0.763, z + 0.148}, kNoBottom);
        builder.lathe({x + 0.2, 0.76, z}, {{0.0, 0.0}, {0.035, 0.0}, {0.038, 0.1}, {0.033, 0.1}, {0.03, 0.02}}, 16);
    }
    return builder.take();
}

Mesh make_chair() {
    MeshBuilder builder{"chair"};
    use(builder, kWood, 0x9C7048);
    builder.box({-0.21, 0.43, -0.21}, {0.21, 0.46, 0.21});
    for (const double x : {-0.18, 0.18}) {
        for (const double z : {-0.18, 0.18}) builder.bar({x, 0.0, 1.1 * z}, {x, 0.43, z}, 0.017, 10);
        builder.bar({x, 0.46, -0.18}, {x, 0.92, -0.25}, 0.016, 10);
    }
    for (int i = 0; i < 3; ++i) {
        const double y = 0.62 + i * 0.12;
        builder.beam({-0.18, y, -0.2 - (y - 0.46) * 0.15}, {0.18, y, -0.2 - (y - 0.46) * 0.15}, 0.016, 0.05);
    }
    return builder.take();
}

Mesh make_sofa() {
    MeshBuilder builder{"sofa"};
    use(builder, kPlaster, 0x6C7F8E);
    builder.box({-1.0, 0.12, 0.02}, {1.0, 0.32, 0.86});
    builder.box({-1.0, 0.32, 0.02}, {1.0, 0.82, 0.22});
    for (const double x : {-1.0, 0.82}) builder.box({x, 0.32, 0.22}, {x + 0.18, 0.6, 0.86});
    builder.use_colour(tint(0x7F93A3));
    for (int i = 0; i < 3; ++i) {
        const double x = -0.81 + i * 0.545;
        builder.box({x, 0.32, 0.22}, {x + 0.53, 0.45, 0.88});
        builder.box({x, 0.45, 0.2}, {x + 0.53, 0.84, 0.34});
    }
    use(builder, kWood, 0x6B4B30);
    for (const double x : {-0.92, 0.92}) {
        for (const double z : {0.1, 0.78}) builder.lathe({x, 0.0, z}, {{0.02, 0.0}, {0.035, 0.12}}, 12);
    }
    return builder.take();
}

Mesh make_low_table() {
    MeshBuilder builder{"low table"};
    use(builder, kWood, 0xC0996B);
    builder.lathe({0.0, 0.0, 0.0}, {{0.0, 0.4}, {0.45, 0.4}, {0.47, 0.41}, {0.47, 0.43}, {0.45, 0.44}, {0.0, 0.44}},
                  40);
    use(builder, kIron, 0x33373A);
    for (int i = 0; i < 3; ++i) {
        const Direction2 d = direction_of_turns(i / 3.0);
        builder.bar({0.38 * d.cosine, 0.0, 0.38 * d.sine}, {0.25 * d.cosine, 0.4, 0.25 * d.sine}, 0.014, 10);
    }
    return builder.take();
}

Mesh make_plant(std::uint64_t seed) {
    MeshBuilder builder{"plant"};
    Random random{seed, 502};
    use(builder, kStone, 0xC77B54);
    builder.lathe({0.0, 0.0, 0.0}, {{0.0, 0.0}, {0.16, 0.0}, {0.22, 0.36}, {0.2, 0.36}, {0.18, 0.32}, {0.0, 0.32}}, 24);
    use(builder, kLeaf, 0x3F7A46);
    for (int i = 0; i < 46; ++i) {
        const Direction2 d = direction_of_turns(random.unit());
        const glm::dvec3 out{d.cosine, 0.0, d.sine};
        const glm::dvec3 side{-d.sine, 0.0, d.cosine};
        const double reach = random.between(0.2, 0.5);
        const double rise = random.between(0.5, 1.1);
        const double wide = random.between(0.03, 0.06);
        builder.use_colour(tint(0x3F7A46, random.between(0.7, 1.25)));
        const glm::dvec3 root{0.0, 0.32, 0.0};
        const glm::dvec3 middle = root + out * (0.5 * reach) + glm::dvec3{0.0, rise, 0.0};
        const glm::dvec3 tip = root + out * (1.3 * reach) + glm::dvec3{0.0, 0.75 * rise, 0.0};
        builder.polygon({root - side * 0.008, root + side * 0.008, middle + side * wide, middle - side * wide});
        builder.polygon({middle - side * wide, middle + side * wide, tip});
    }
    return builder.take();
}

Mesh make_floor_lamp() {
    MeshBuilder builder{"floor lamp"};
    use(builder, kIron, 0x3A3E42);
    builder.lathe({0.0, 0.0, 0.0}, {{0.15, 0.0}, {0.15, 0.02}, {0.015, 0.04}, {0.012, 1.45}}, 24);
    use(builder, kLamp, 0xFFF3D6);
    builder.lathe({0.0, 1.4, 0.0}, {{0.2, 0.0}, {0.14, 0.28}}, 28);
    return builder.take();
}

Mesh make_ceiling_lamp() {
    MeshBuilder builder{"ceiling lamp"};
    use(builder, kIron, 0xD8D8D8);
    builder.bar({0.0, -0.45, 0.0}, {0.0, 0.0, 0.0}, 0.008, 6);
    builder.lathe({0.0, -0.6, 0.0}, {{0.24, 0.0}, {0.2, 0.1}, {0.05, 0.16}, {0.0, 0.17}}, 28);
    use(builder, kLamp, 0xFFF3D6);
    builder.lathe({0.0, -0.6, 0.0}, {{0.0, -0.02}, {0.12, -0.01}, {0.2, 0.03}}, 20);
    return builder.take();
}

Mesh make_radiator() {
    MeshBuilder builder{"radiator"};
    use(builder, kPaint, 0xF4F2EC);
    for (int i = 0; i < 16; ++i) {
        const double x = -0.56 + i * 0.075;
        builder.lathe({x, 0.14, 0.09}, {{0.0, 0.0}, {0.028, 0.02}, {0.028, 0.58}, {0.0, 0.6}}, 10);
    }
    for (const double y : {0.2, 0.68}) builder.bar({-0.6, y, 0.09}, {0.6, y, 0.09}, 0.016, 8);
    return builder.take();
}

Mesh make_waste_bin() {
    MeshBuilder builder{"waste bin"};
    use(builder, kIron, 0x6A6E70);
    builder.lathe({0.0, 0.0, 0.0}, {{0.0, 0.0}, {0.1, 0.0}, {0.13, 0.3}, {0.125, 0.3}, {0.096, 0.01}, {0.0, 0.01}}, 24);
    return builder.take();
}

Mesh make_picture(std::uint64_t seed) {
    MeshBuilder builder{"picture"};
    Random random{seed, 503};
    use(builder, kWood, 0x5A3B24);
    for (const double y : {-0.3, 0.27}) builder.box({-0.42, y, 0.0}, {0.42, y + 0.03, 0.03}, kNoBack);
    for (const double x : {-0.42, 0.39}) builder.box({x, -0.27, 0.0}, {x + 0.03, 0.27, 0.03}, kNoBack);
    builder.use_material(kPaint);
    for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 8; ++j) {
            builder.use_colour(tint(random.pick(kBookColours), random.between(0.6, 1.4)));
            const double x = -0.39 + i * 0.065;
            const double y = -0.27 + j * 0.0675;
            builder.polygon(
                {{x, y, 0.012}, {x + 0.065, y, 0.012}, {x + 0.065, y + 0.0675, 0.012}, {x, y + 0.0675, 0.012}});
        }
    }
    return builder.take();
}

/// Its hinge at x = 0, the leaf along +Z: it stands open, at a right angle to its wall.
Mesh make_door_leaf() {
    MeshBuilder builder{"door leaf"};
    use(builder, kPaint, 0xB89B78);
    builder.box({0.0, 0.01, 0.0}, {0.04, 2.07, 0.92});
    for (int i = 0; i < 3; ++i) {
        const double y = 0.15 + i * 0.64;
        for (const double x : {-0.008, 0.04}) builder.box({x, y, 0.14}, {x + 0.008, y + 0.52, 0.78});
    }
    use(builder, kIron, 0xC9A94E);
    for (const double x : {-0.05, 0.09}) builder.bar({x, 1.02, 0.84}, {x, 1.02, 0.72}, 0.01, 10);
    builder.bar({-0.05, 1.02, 0.84}, {0.09, 1.02, 0.84}, 0.009, 10);
    return builder.take();
}

/// From the floor at z = 0 up to the next one at z = 4.6, 1.4 m wide, beginning at x = 0.
Mesh make_stairs() {
    MeshBuilder builder{"stairs"};
    constexpr int kSteps = 18;
    constexpr double kRise = 3.2 / kSteps;
    constexpr double kGoing = 4.6 / kSteps;
    for (int i = 0; i < kSteps; ++i) {
        use(builder, kWood, 0xB08A60);
        builder.box({0.0, (i + 1) * kRise - 0.04, i * kGoing}, {1.4, (i + 1) * kRise, (i + 1) * kGoing + 0.03});
        use(builder, kIron, 0x3A3E42);
        builder.bar({0.03, (i + 1) * kRise, (i + 0.5) * kGoing}, {0.03, (i + 1) * kRise + 0.95, (i + 0.5) * kGoing},
                    0.009, 6);
    }
    builder.bar({0.03, kRise + 0.95, 0.5 * kGoing}, {0.03, 3.2 + 0.95, (kSteps - 0.5) * kGoing}, 0.02, 10);
    builder.beam({0.08, 0.0, 0.0}, {0.08, 3.1, 4.55}, 0.05, 0.2);
    builder.beam({1.32, 0.0, 0.0}, {1.32, 3.1, 4.55}, 0.05, 0.2);
    return builder.take();
}

Mesh make_trolley(std::uint64_t seed) {
    MeshBuilder builder{"trolley"};
    Random random{seed, 504};
    use(builder, kIron, 0x8A9094);
    for (const double x : {-0.3, 0.3}) {
        for (const double z : {-0.45, 0.45}) {
            builder.bar({x, 0.06, z}, {x, 0.9, z}, 0.014, 8);
            builder.lathe({x, 0.0, z}, {{0.0, 0.0}, {0.04, 0.02}, {0.04, 0.05}, {0.0, 0.08}}, 12);
        }
    }
    for (const double y : {0.2, 0.55, 0.86}) {
        use(builder, kPaint, 0xB7C4BE);
        builder.box({-0.32, y, -0.47}, {0.32, y + 0.02, 0.47});
        if (y < 0.8) add_books(builder, -0.3, 0.3, y + 0.02, -0.3, 0.28, random);
    }
    return builder.take();
}

}  // namespace

std::vector<Mesh> make_furniture(std::uint64_t seed) {
    std::vector<Mesh> meshes;
    meshes.push_back(make_desk());
    meshes.push_back(make_office_chair());
    meshes.push_back(make_bookcase(seed));
    meshes.push_back(make_filing_cabinet());
    meshes.push_back(make_meeting_table());
    meshes.push_back(make_chair());
    meshes.push_back(make_sofa());
    meshes.push_back(make_low_table());
    meshes.push_back(make_plant(seed));
    meshes.push_back(make_floor_lamp());
    meshes.push_back(make_ceiling_lamp());
    meshes.push_back(make_radiator());
    meshes.push_back(make_waste_bin());
    meshes.push_back(make_picture(seed));
    meshes.push_back(make_door_leaf());
    meshes.push_back(make_stairs());
    meshes.push_back(make_trolley(seed));
    return meshes;
}

}  // namespace lw::scene
