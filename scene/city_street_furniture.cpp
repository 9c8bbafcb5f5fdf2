#include "scene/city_street_furniture.h"

#include <array>
#include <cmath>

#include "scene/city_materials.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

void use(MeshBuilder& builder, CityMaterial material, std::uint32_t srgb_hex) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(tint(srgb_hex));
}

/// Points of a wire between two ends, hanging `sag_m` in the middle (a parabola: the catenary's shape to 1 %).
std::vector<glm::dvec3> hanging(const glm::dvec3& from, const glm::dvec3& to, double sag_m, int segments) {
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= segments; ++i) {
        const double t = static_cast<double>(i) / segments;
        path.push_back(from + (to - from) * t - glm::dvec3{0.0, 4.0 * sag_m * t * (1.0 - t), 0.0});
    }
    return path;
}

/// A closed ring of bars in the plane across `axis` 0 = x or 2 = z.
void add_hoop(MeshBuilder& builder, const glm::dvec3& centre, double radius, double thick, int segments, int axis) {
    std::vector<glm::dvec3> path;
    for (int i = 0; i <= segments; ++i) {
        const Direction2 d = direction_of_turns(static_cast<double>(i) / segments);
        path.push_back(centre +
                       (axis == 2 ? glm::dvec3{d.cosine, d.sine, 0.0} : glm::dvec3{0.0, d.sine, d.cosine}) * radius);
    }
    builder.tube(path, thick, 4);
}

constexpr std::array<double, 4> kInsulators_m{-0.95, -0.45, 0.45, 0.95};

}  // namespace

Mesh make_lamp_post() {
    MeshBuilder builder{"lamp post"};
    use(builder, kIron, 0x2F4038);
    builder.lathe({0.0, 0.0, 0.0},
                  {{0.17, 0.0},
                   {0.17, 0.12},
                   {0.12, 0.18},
                   {0.12, 0.85},
                   {0.14, 0.9},
                   {0.14, 0.97},
                   {0.075, 1.05},
                   {0.06, 2.6},
                   {0.05, 4.4},
                   {0.075, 4.45},
                   {0.075, 4.52},
                   {0.045, 4.6},
                   {0.04, 5.2},
                   {0.07, 5.3},
                   {0.0, 5.45}},
                  9);
    const std::array<glm::dvec3, 6> arm{glm::dvec3{0.0, 4.75, 0.0},  glm::dvec3{0.0, 5.2, 0.12},
                                        glm::dvec3{0.0, 5.52, 0.4},  glm::dvec3{0.0, 5.6, 0.72},
                                        glm::dvec3{0.0, 5.52, 1.02}, glm::dvec3{0.0, 5.35, kLampReach_m}};
    builder.tube(arm, 0.028, 5);
    const std::array<glm::dvec3, 5> scroll{glm::dvec3{0.0, 4.5, 0.0}, glm::dvec3{0.0, 4.85, 0.35},
                                           glm::dvec3{0.0, 5.25, 0.5}, glm::dvec3{0.0, 5.45, 0.42},
                                           glm::dvec3{0.0, 5.42, 0.3}};
    builder.tube(scroll, 0.014, 4);
    const glm::dvec3 lantern{0.0, kLampHeight_m - 0.25, kLampReach_m};
    builder.lathe(lantern, {{0.0, 0.42}, {0.24, 0.42}, {0.2, 0.5}, {0.07, 0.62}, {0.0, 0.75}}, 6, true);
    builder.lathe(lantern, {{0.0, -0.08}, {0.09, -0.05}, {0.12, 0.03}}, 6);
    for (int i = 0; i < 6; ++i) {
        const Direction2 d = direction_of_turns(i / 6.0);
        const glm::dvec3 out{d.cosine, 0.0, d.sine};
        builder.bar(lantern + out * 0.125, lantern + out * 0.205 + glm::dvec3{0.0, 0.43, 0.0}, 0.009, 3);
    }
    use(builder, kLamp, 0xFFF3D6);
    builder.lathe(lantern, {{0.11, 0.02}, {0.19, 0.42}}, 6);
    return builder.take();
}

Mesh make_guard_rail() {
    MeshBuilder builder{"guard rail"};
    use(builder, kIron, 0x33443C);
    const double half = 0.5 * kRailModule_m;
    for (const double x : {-half, half})
        builder.lathe({x, 0.0, 0.0}, {{0.032, 0.0}, {0.032, 1.06}, {0.05, 1.09}, {0.0, 1.15}}, 8);
    builder.bar({-half, 1.0, 0.0}, {half, 1.0, 0.0}, 0.024, 6);
    builder.bar({-half, 0.14, 0.0}, {half, 0.14, 0.0}, 0.018, 5);
    builder.bar({-half, 0.86, 0.0}, {half, 0.86, 0.0}, 0.012, 4);
    constexpr int kBars = 15;
    for (int i = 1; i < kBars + 1; ++i) {
        const double x = -half + kRailModule_m * i / (kBars + 1);
        builder.bar({x, 0.14, 0.0}, {x, 1.0, 0.0}, 0.009);
    }
    return builder.take();
}

Mesh make_iron_fence() {
    MeshBuilder builder{"iron fence"};
    const double half = 0.5 * kRailModule_m;
    use(builder, kStone, 0xD9D0BF);
    builder.box({-half, 0.0, -0.14}, {half, 0.42, 0.14}, kNoBottom);
    builder.box({-half, 0.42, -0.18}, {half, 0.5, 0.18});
    use(builder, kIron, 0x23282B);
    builder.bar({-half, 0.66, 0.0}, {half, 0.66, 0.0}, 0.014);
    builder.bar({-half, 1.62, 0.0}, {half, 1.62, 0.0}, 0.014);
    constexpr int kBars = 14;
    for (int i = 0; i < kBars; ++i) {
        const double x = -half + kRailModule_m * (i + 0.5) / kBars;
        builder.bar({x, 0.5, 0.0}, {x, 1.78, 0.0}, 0.0095, 3);
        builder.lathe({x, 1.75, 0.0}, {{0.028, 0.0}, {0.0, 0.15}}, 4);
    }
    return builder.take();
}

Mesh make_utility_pole() {
    MeshBuilder builder{"utility pole"};
    use(builder, kWood, 0x9C8A76);
    builder.lathe({0.0, 0.0, 0.0}, {{0.15, 0.0}, {0.135, 2.0}, {0.1, 8.4}, {0.0, 8.46}}, 10);
    builder.box({-0.06, 7.6, -1.15}, {0.06, 7.73, 1.15});
    builder.box({-0.05, 6.95, -0.6}, {0.05, 7.06, 0.6});
    use(builder, kIron, 0x6A6F70);
    builder.bar({0.07, 7.1, 0.05}, {0.07, 7.62, 0.7}, 0.016);
    builder.bar({0.07, 7.1, -0.05}, {0.07, 7.62, -0.7}, 0.016);
    builder.lathe({0.3, 6.1, 0.0}, {{0.0, 0.0}, {0.2, 0.02}, {0.2, 0.62}, {0.0, 0.7}}, 10, true);  // transformer
    builder.bar({0.0, 6.3, 0.0}, {0.3, 6.3, 0.0}, 0.03);
    use(builder, kPaint, 0x8E4F38);
    for (const double z : kInsulators_m) {
        builder.lathe({0.0, 7.73, z}, {{0.02, 0.0}, {0.05, 0.05}, {0.03, 0.09}, {0.045, 0.13}, {0.0, 0.18}}, 6);
    }
    use(builder, kRoadPaint, 0xE8C65A);
    builder.lathe({0.0, 1.4, 0.0}, {{0.1435, 0.0}, {0.1425, 0.18}}, 10);
    return builder.take();
}

Mesh make_wire_span(double length_m) {
    MeshBuilder builder{"wires"};
    use(builder, kRubber, 0x2B2D2F);
    for (const double z : kInsulators_m) {
        builder.tube(hanging({0.0, kWireHeight_m, z}, {length_m, kWireHeight_m, z}, 0.38, 14), 0.009, 4);
    }
    builder.tube(hanging({0.0, 7.1, 0.5}, {length_m, 7.1, 0.5}, 0.5, 14), 0.016, 5);
    builder.tube(hanging({0.0, 6.7, 0.1}, {length_m, 6.7, 0.1}, 0.62, 14), 0.014, 5);
    return builder.take();
}

Mesh make_service_drop() {
    MeshBuilder builder{"service drop"};
    use(builder, kRubber, 0x2B2D2F);
    builder.tube(hanging({0.0, 7.06, -0.5}, {2.6, 6.1, -4.0}, 0.18, 8), 0.010, 4);
    builder.tube(hanging({0.0, 7.06, -0.55}, {-3.4, 6.2, -4.0}, 0.2, 8), 0.010, 4);
    return builder.take();
}

Mesh make_span_lamp(double width_m) {
    MeshBuilder builder{"span lamp"};
    use(builder, kRubber, 0x2B2D2F);
    const double half = 0.5 * width_m;
    builder.tube(hanging({-half, 6.3, 0.0}, {half, 6.3, 0.0}, 0.35, 20), 0.008, 4);
    builder.bar({0.0, 5.95, 0.0}, {0.0, 5.62, 0.0}, 0.012);
    use(builder, kIron, 0x3A4145);
    builder.lathe({0.0, 5.3, 0.0}, {{0.36, 0.0}, {0.26, 0.14}, {0.1, 0.24}, {0.05, 0.34}, {0.0, 0.36}}, 14);
    builder.lathe({0.0, 5.3, 0.0}, {{0.13, 0.11}, {0.36, 0.0}}, 14);
    use(builder, kLamp, 0xFFF3D6);
    builder.lathe({0.0, 5.22, 0.0}, {{0.0, 0.0}, {0.1, 0.04}, {0.13, 0.12}, {0.1, 0.2}}, 10);
    return builder.take();
}

Mesh make_bench() {
    MeshBuilder builder{"bench"};
    use(builder, kIron, 0x2D3330);
    for (const double x : {-0.75, 0.75}) {
        builder.beam({x, 0.0, -0.2}, {x, 0.44, -0.22}, 0.05, 0.05, {1.0, 0.0, 0.0});
        builder.beam({x, 0.0, 0.22}, {x, 0.44, 0.2}, 0.05, 0.05, {1.0, 0.0, 0.0});
        builder.beam({x, 0.43, -0.25}, {x, 0.43, 0.25}, 0.05, 0.04);
        builder.beam({x, 0.4, -0.22}, {x, 0.95, -0.36}, 0.05, 0.04, {1.0, 0.0, 0.0});
        builder.beam({x, 0.66, -0.28}, {x, 0.66, 0.2}, 0.05, 0.035);
        builder.beam({x, 0.43, 0.2}, {x, 0.67, 0.2}, 0.04, 0.04, {1.0, 0.0, 0.0});
    }
    use(builder, kWood, 0xC08A55);
    for (int i = 0; i < 5; ++i) {
        const double z = -0.2 + i * 0.1;
        builder.box({-0.9, 0.45, z - 0.035}, {0.9, 0.485, z + 0.035});
    }
    for (int i = 0; i < 4; ++i) {
        const double y = 0.58 + i * 0.1;
        const double z = -0.25 - (y - 0.45) * 0.25;
        builder.box({-0.9, y, z - 0.0}, {0.9, y + 0.07, z + 0.03});
    }
    return builder.take();
}

Mesh make_litter_bin() {
    MeshBuilder builder{"litter bin"};
    use(builder, kIron, 0x3D5547);
    builder.lathe({0.0, 0.0, 0.0},
                  {{0.2, 0.06}, {0.24, 0.8}, {0.26, 0.82}, {0.26, 0.86}, {0.2, 0.86}, {0.18, 0.5}, {0.0, 0.5}}, 12,
                  true);
    for (int i = 0; i < 18; ++i) {
        const Direction2 d = direction_of_turns(i / 18.0);
        builder.bar({0.215 * d.cosine, 0.05, 0.215 * d.sine}, {0.255 * d.cosine, 0.82, 0.255 * d.sine}, 0.012);
    }
    builder.bar({0.0, 0.0, 0.0}, {0.0, 0.1, 0.0}, 0.05, 8);
    return builder.take();
}

Mesh make_bollard() {
    MeshBuilder builder{"bollard"};
    use(builder, kIron, 0x2F4038);
    builder.lathe({0.0, 0.0, 0.0},
                  {{0.1, 0.0},
                   {0.1, 0.08},
                   {0.065, 0.14},
                   {0.055, 0.72},
                   {0.075, 0.75},
                   {0.075, 0.8},
                   {0.05, 0.84},
                   {0.065, 0.9},
                   {0.0, 0.97}},
                  10);
    use(builder, kRoadPaint, 0xF2EEE2);
    builder.lathe({0.0, 0.0, 0.0}, {{0.0592, 0.58}, {0.0582, 0.68}}, 10);
    return builder.take();
}

Mesh make_post_box() {
    MeshBuilder builder{"post box"};
    use(builder, kPaint, 0xE0B73C);
    builder.box({-0.28, 0.7, -0.2}, {0.28, 1.45, 0.2});
    builder.box({-0.32, 1.45, -0.24}, {0.32, 1.53, 0.24});
    builder.use_colour(tint(0x2D2A24));
    builder.box({-0.2, 1.26, 0.2}, {0.2, 1.31, 0.215}, kNoBack);
    builder.use_colour(tint(0x3C4A66));
    builder.box({-0.12, 0.9, 0.2}, {0.12, 1.14, 0.21}, kNoBack);
    use(builder, kIron, 0x55595A);
    builder.bar({0.0, 0.0, 0.0}, {0.0, 0.72, 0.0}, 0.06, 8);
    return builder.take();
}

Mesh make_street_sign() {
    MeshBuilder builder{"street sign"};
    use(builder, kIron, 0x8A8F90);
    builder.bar({0.0, 0.0, 0.0}, {0.0, 2.75, 0.0}, 0.03, 8);
    use(builder, kPaint, 0x2D5A86);
    builder.box({-0.02, 2.45, -0.48}, {0.02, 2.68, 0.48});
    builder.box({-0.48, 2.18, -0.02}, {0.48, 2.41, 0.02});
    builder.use_colour(tint(0xF4F2EA));
    for (const double z : {-0.021, 0.021}) {
        for (int i = 0; i < 6; ++i) {
            const double x = -0.4 + i * 0.13;
            builder.box({x, 2.26, z > 0 ? 0.02 : z - 0.004}, {x + 0.08, 2.34, z > 0 ? z + 0.004 : -0.02});
        }
    }
    return builder.take();
}

Mesh make_planter(std::uint64_t seed) {
    Random random{seed, 3000};
    MeshBuilder builder{"planter"};
    use(builder, kStone, 0xD2C6B2);
    builder.lathe({0.0, 0.0, 0.0},
                  {{0.32, 0.0}, {0.42, 0.42}, {0.48, 0.45}, {0.48, 0.53}, {0.4, 0.53}, {0.38, 0.46}, {0.0, 0.46}}, 14,
                  true);
    builder.use_material(kLeaf);
    static constexpr std::array<std::uint32_t, 4> kColours{0x5F8A45, 0x6F9A4A, 0xC8435A, 0xE6B24A};
    for (int i = 0; i < 130; ++i) {
        builder.use_colour(tint(random.pick(kColours), random.between(0.7, 1.1)));
        const glm::dvec3 out = random_direction(random) * glm::dvec3{1.0, 0.75, 1.0};
        const glm::dvec3 at =
            glm::dvec3{0.0, 0.56, 0.0} + glm::dvec3{out.x * 0.36, std::abs(out.y) * 0.42, out.z * 0.36};
        const glm::dvec3 side{0.07 * random.between(0.6, 1.3), 0.0, 0.03};
        const glm::dvec3 up{0.02, 0.08 * random.between(0.6, 1.3), 0.02};
        builder.polygon({at - side, at - up, at + side, at + up});
    }
    return builder.take();
}

Mesh make_cafe_table() {
    MeshBuilder builder{"cafe table"};
    use(builder, kIron, 0x3B4046);
    builder.lathe({0.0, 0.0, 0.0}, {{0.24, 0.0}, {0.22, 0.03}, {0.03, 0.06}, {0.025, 0.72}}, 10);
    builder.bar({0.0, 0.7, 0.0}, {0.0, 2.35, 0.0}, 0.02, 6);
    use(builder, kWood, 0xD8B27C);
    builder.lathe({0.0, 0.72, 0.0}, {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.03}, {0.0, 0.03}}, 16, true);
    for (const double side : {-1.0, 1.0}) {
        const double x = side * 0.72;
        use(builder, kIron, 0x3B4046);
        for (const double dx : {-0.19, 0.19}) {
            for (const double z : {-0.19, 0.19}) {
                const bool back = dx * side > 0.0;
                builder.bar({x + dx, 0.0, z}, {x + dx * 0.92, back ? 0.88 : 0.45, z * 0.92}, 0.012);
            }
        }
        use(builder, kWood, 0xC89B66);
        for (int i = 0; i < 4; ++i) builder.box({x - 0.2, 0.44, -0.19 + i * 0.1}, {x + 0.2, 0.462, -0.11 + i * 0.1});
        for (int i = 0; i < 3; ++i) {
            const double back = x + side * 0.175;
            builder.box({back - 0.01, 0.58 + i * 0.1, -0.19}, {back + 0.012, 0.65 + i * 0.1, 0.19});
        }
    }
    // Parasol of eight cloths in two colours.
    for (int i = 0; i < 8; ++i) {
        use(builder, kPaint, i % 2 == 0 ? 0xC9574A : 0xF1E7D3);
        const Direction2 a = direction_of_turns(-i / 8.0);
        const Direction2 b = direction_of_turns(-(i + 1) / 8.0);
        const glm::dvec3 pa{1.15 * a.cosine, 2.05, 1.15 * a.sine};
        const glm::dvec3 pb{1.15 * b.cosine, 2.05, 1.15 * b.sine};
        const glm::dvec3 drop{0.0, 0.16, 0.0};
        builder.polygon({pa, pb, {0.0, 2.5, 0.0}});
        builder.polygon({pa - drop, pb - drop, pb, pa});
        builder.polygon({pb - glm::dvec3{0.0, 0.02, 0.0}, pa - glm::dvec3{0.0, 0.02, 0.0}, {0.0, 2.46, 0.0}});
        builder.polygon({pb - drop, pa - drop, pa, pb});
        use(builder, kIron, 0x6A6F70);
        builder.bar(pa - glm::dvec3{0.0, 0.02, 0.0}, {0.0, 2.44, 0.0}, 0.008, 3);
    }
    return builder.take();
}

Mesh make_bicycle() {
    MeshBuilder builder{"bicycle"};
    use(builder, kIron, 0x70767A);
    const std::array<glm::dvec3, 6> stand{glm::dvec3{-0.3, 0.0, 0.12},  glm::dvec3{-0.3, 0.62, 0.12},
                                          glm::dvec3{-0.2, 0.76, 0.12}, glm::dvec3{0.2, 0.76, 0.12},
                                          glm::dvec3{0.3, 0.62, 0.12},  glm::dvec3{0.3, 0.0, 0.12}};
    builder.tube(stand, 0.024, 6);
    for (const double x : {-0.53, 0.53}) {
        use(builder, kRubber, 0x202224);
        add_hoop(builder, {x, 0.34, 0.0}, 0.33, 0.017, 20, 2);
        use(builder, kIron, 0xA9AEB0);
        for (int i = 0; i < 12; ++i) {
            const Direction2 d = direction_of_turns(i / 12.0);
            builder.bar({x, 0.34, 0.0}, {x + 0.315 * d.cosine, 0.34 + 0.315 * d.sine, 0.0}, 0.0035, 3);
        }
    }
    use(builder, kCarPaint, 0x2E6B73);
    const glm::dvec3 crank{-0.05, 0.3, 0.0};
    const glm::dvec3 seat{-0.2, 0.82, 0.0};
    const glm::dvec3 head{0.36, 0.84, 0.0};
    const glm::dvec3 rear{-0.53, 0.34, 0.0};
    const glm::dvec3 front{0.53, 0.34, 0.0};
    for (const auto& [a, b] : {std::pair{crank, seat}, std::pair{crank, head}, std::pair{seat, head},
                               std::pair{rear, crank}, std::pair{rear, seat}, std::pair{front, head}}) {
        builder.bar(a, b, 0.015, 6);
    }
    use(builder, kIron, 0x3A3E40);
    builder.bar(head, {0.33, 0.98, 0.0}, 0.013);
    builder.bar({0.3, 1.0, -0.26}, {0.3, 1.0, 0.26}, 0.012);
    builder.bar(seat, {-0.23, 0.93, 0.0}, 0.012);
    builder.box({-0.37, 0.93, -0.07}, {-0.11, 0.97, 0.07});
    return builder.take();
}

Mesh make_tree_pit() {
    MeshBuilder builder{"tree pit"};
    use(builder, kStone, 0xC8BFAE);
    builder.box({-0.62, 0.0, -0.62}, {0.62, 0.04, -0.52}, kNoBottom);
    builder.box({-0.62, 0.0, 0.52}, {0.62, 0.04, 0.62}, kNoBottom);
    builder.box({-0.62, 0.0, -0.52}, {-0.52, 0.04, 0.52}, kNoBottom);
    builder.box({0.52, 0.0, -0.52}, {0.62, 0.04, 0.52}, kNoBottom);
    use(builder, kBark, 0x8A7158);
    builder.polygon({{-0.52, 0.02, 0.52}, {0.52, 0.02, 0.52}, {0.52, 0.02, -0.52}, {-0.52, 0.02, -0.52}});
    return builder.take();
}

}  // namespace lw::scene
