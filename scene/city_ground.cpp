#include "scene/city_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/city_materials.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr double kHalfRoad_m = 0.5 * kRoadWidth_m;
constexpr double kPaint_m = 0.012;  ///< markings above the asphalt
constexpr double kHalfBlockX_m = 0.5 * kBlockSizeX_m;
constexpr double kHalfBlockZ_m = 0.5 * kBlockSizeZ_m;

void use(MeshBuilder& builder, CityMaterial material, std::uint32_t srgb_hex) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(tint(srgb_hex));
}

/// A colour seen through `share` of haze.
std::uint32_t hazy(std::uint32_t srgb_hex, double share) {
    constexpr std::uint32_t kHaze = 0xB9C9D6;
    std::uint32_t mixed = 0;
    for (const unsigned shift : {16u, 8u, 0u}) {
        const double near = (srgb_hex >> shift) & 255u;
        const double far = (kHaze >> shift) & 255u;
        mixed |= static_cast<std::uint32_t>(near + (far - near) * share) << shift;
    }
    return mixed;
}

/// A rectangle facing up.
void add_patch(MeshBuilder& builder, double x0, double x1, double z0, double z1, double y) {
    builder.polygon({{x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0}});
}

/// Outline of a block, counter-clockwise from above, made smaller by `inset`.
std::vector<glm::dvec3> outline(double inset, double y) {
    std::vector<glm::dvec3> points;
    constexpr int kSegments = 6;
    for (int corner = 0; corner < 4; ++corner) {
        const double sx = corner == 0 || corner == 3 ? 1.0 : -1.0;
        const double sz = corner < 2 ? -1.0 : 1.0;
        const glm::dvec3 centre{sx * (kHalfBlockX_m - kCornerRadius_m), y, sz * (kHalfBlockZ_m - kCornerRadius_m)};
        for (int i = 0; i <= kSegments; ++i) {
            const Direction2 d = direction_of_turns(0.25 * corner + 0.25 * i / kSegments);
            points.push_back(centre + (kCornerRadius_m - inset) * glm::dvec3{d.cosine, 0.0, -d.sine});
        }
    }
    return points;
}

void add_kerb_and_pavement(MeshBuilder& builder) {
    constexpr double kKerb_m = 0.22;
    const std::vector<glm::dvec3> outer = outline(0.0, kKerbHeight_m);
    const std::vector<glm::dvec3> inner = outline(kKerb_m, kKerbHeight_m);
    use(builder, kStone, 0xE0DACD);
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const std::size_t j = (i + 1) % outer.size();
        const glm::dvec3 drop{0.0, -kKerbHeight_m - 0.02, 0.0};
        builder.polygon({outer[i], outer[j], inner[j], inner[i]});
        builder.polygon({outer[i] + drop, outer[j] + drop, outer[j], outer[i]});
    }
    use(builder, kPaving, 0xFFFFFF);
    builder.polygon(inner);
}

/// Half a street that leaves the crossing towards -Z, in the crossing's placement turned for each arm.
void add_arm_markings(MeshBuilder& builder, double length_m) {
    use(builder, kRoadPaint, 0xE9E7DF);
    for (int i = 0; i < 9; ++i) {  // zebra
        const double x = -4.25 + i * 1.0;
        add_patch(builder, x - 0.01, x + 0.49, -11.6, -8.6, kPaint_m);
    }
    add_patch(builder, -4.9, -0.15, -12.75, -12.4, kPaint_m);  // stop line: traffic comes towards the crossing on -x
    for (double z = 14.0; z + 2.0 < length_m; z += 5.0) add_patch(builder, -0.06, 0.06, -z - 2.0, -z, kPaint_m);
    for (double z = 17.0; z < length_m; z += 6.5) {  // parking bays
        for (const double side : {-1.0, 1.0}) {
            const double x = side * 2.95;
            add_patch(builder, std::min(x, x + side * 1.9), std::max(x, x + side * 1.9), -z - 0.05, -z + 0.05,
                      kPaint_m);
            add_patch(builder, x - 0.05, x + 0.05, -z - 0.5, -z - 0.05, kPaint_m);
            add_patch(builder, x - 0.05, x + 0.05, -z + 0.05, -z + 0.5, kPaint_m);
        }
    }
    use(builder, kIron, 0x4A4C4E);
    builder.lathe({1.4, 0.0, -20.0}, {{0.36, 0.0}, {0.36, 0.012}, {0.0, 0.012}}, 16, true);
    builder.box({-4.95, 0.0, -15.4}, {-4.55, 0.013, -14.8}, kNoBottom);
}

}  // namespace

Mesh make_crossing() {
    MeshBuilder builder{"crossing"};
    use(builder, kAsphalt, 0xFFFFFF);
    // Wider than the road: the asphalt goes on below kerbs, whose corners are round.
    constexpr double kWide = kHalfRoad_m + kCornerRadius_m + 0.2;
    add_patch(builder, -kWide, kWide, -kWide, kWide, 0.0);
    add_patch(builder, -kWide, kWide, -0.5 * kPitchZ_m, -kWide, 0.0);
    add_patch(builder, -kWide, kWide, kWide, 0.5 * kPitchZ_m, 0.0);
    add_patch(builder, -0.5 * kPitchX_m, -kWide, -kWide, kWide, 0.0);
    add_patch(builder, kWide, 0.5 * kPitchX_m, -kWide, kWide, 0.0);
    for (int arm = 0; arm < 4; ++arm) {
        builder.place(placement({0.0, 0.0, 0.0}, 0.25 * arm));
        add_arm_markings(builder, 0.5 * (arm % 2 == 0 ? kPitchZ_m : kPitchX_m));
    }
    return builder.take();
}

Mesh make_block_ground() {
    MeshBuilder builder{"block ground"};
    add_kerb_and_pavement(builder);
    const double x = 0.5 * kCourtDepth_m;
    const double z = kHalfBlockZ_m - kPavementWidth_m - 1.0;
    use(builder, kStone, 0xCFC6B4);
    const double y = kKerbHeight_m;
    builder.box({-x, y, -z}, {x, y + 0.06, -z + 0.12}, kNoBottom);
    builder.box({-x, y, z - 0.12}, {x, y + 0.06, z}, kNoBottom);
    use(builder, kGrass, 0xF4F6E8);
    add_patch(builder, -x, x, -z + 0.12, z - 0.12, y + 0.04);
    use(builder, kPaving, 0xE8DCC4);
    add_patch(builder, -0.8, 0.8, -z + 0.12, z - 0.12, y + 0.055);
    return builder.take();
}

Mesh make_park_ground() {
    MeshBuilder builder{"park ground"};
    add_kerb_and_pavement(builder);
    const double x = kHalfBlockX_m - kPavementWidth_m;
    const double z = kHalfBlockZ_m - kPavementWidth_m;
    const double y = kKerbHeight_m;
    use(builder, kStone, 0xCFC6B4);
    builder.box({-x, y, -z}, {x, y + 0.1, -z + 0.15}, kNoBottom);
    builder.box({-x, y, z - 0.15}, {x, y + 0.1, z}, kNoBottom);
    builder.box({-x, y, -z + 0.15}, {-x + 0.15, y + 0.1, z - 0.15}, kNoBottom);
    builder.box({x - 0.15, y, -z + 0.15}, {x, y + 0.1, z - 0.15}, kNoBottom);
    use(builder, kGrass, 0xFFFFFF);
    add_patch(builder, -x + 0.15, x - 0.15, -z + 0.15, z - 0.15, y + 0.05);
    use(builder, kPaving, 0xEADFC8);
    add_patch(builder, -1.6, 1.6, -z + 0.15, z - 0.15, y + 0.07);
    add_patch(builder, -x + 0.15, x - 0.15, -1.6, 1.6, y + 0.085);
    builder.lathe({0.0, y, 0.0}, {{7.0, 0.0}, {7.0, 0.1}, {0.0, 0.1}}, 32, true);
    use(builder, kStone, 0xD9CFBC);
    builder.lathe({0.0, y, 0.0}, {{3.2, 0.1}, {3.2, 0.55}, {2.9, 0.55}, {2.9, 0.2}}, 28, true);
    builder.lathe({0.0, y, 0.0},
                  {{0.45, 0.3},
                   {0.3, 0.6},
                   {0.22, 1.2},
                   {0.9, 1.45},
                   {0.95, 1.52},
                   {0.3, 1.45},
                   {0.14, 1.6},
                   {0.2, 1.9},
                   {0.0, 2.1}},
                  16);
    use(builder, kGlass, 0x5C7F8C);
    builder.lathe({0.0, y, 0.0}, {{2.92, 0.42}, {0.0, 0.42}}, 28, true);
    return builder.take();
}

Mesh make_country(double town_half_size_m, std::uint64_t seed) {
    MeshBuilder builder{"country"};
    Random random{seed, 4000};
    // Rings of a height field: flat below the town, hills beyond it.
    constexpr int kSides = 72;
    constexpr std::array<double, 9> kRadii{0.0, 0.75, 1.0, 1.25, 1.6, 2.1, 2.7, 3.4, 4.2};
    constexpr std::array<double, 9> kHeights{0.0, 0.0, 0.0, 0.015, 0.05, 0.11, 0.2, 0.24, 0.12};
    const double radius = 1.5 * town_half_size_m;
    std::vector<std::array<glm::dvec3, kSides>> rings;
    std::array<double, kSides> wave{};
    double level = 0.0;
    for (double& w : wave) w = level = std::clamp(0.75 * level + random.between(-0.35, 0.35), -0.6, 0.6);
    for (std::size_t r = 0; r < kRadii.size(); ++r) {
        std::array<glm::dvec3, kSides> ring;
        for (int k = 0; k < kSides; ++k) {
            const Direction2 d = direction_of_turns(static_cast<double>(k) / kSides);
            const auto side = static_cast<std::size_t>(k);
            const double height = kHeights[r] * (1.0 + wave[side]) * std::min(radius, 900.0);
            ring[side] = glm::dvec3{radius * kRadii[r] * d.cosine, height - 0.06, -radius * kRadii[r] * d.sine};
        }
        rings.push_back(ring);
    }
    static constexpr std::array<std::uint32_t, 4> kFields{0x8FA36A, 0xB3AE74, 0x7E9A66, 0x6A8A5C};
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        for (std::size_t k = 0; k < kSides; ++k) {
            const std::size_t j = (k + 1) % kSides;
            if (r < 3) {
                use(builder, kGrass, 0xF4F6E8);
            } else {
                // Fields of a few cells each; distance makes them paler and bluer.
                const std::uint64_t field = scrambled(seed + 97 * (r / 2) + 13 * (k / 3));
                use(builder, kHill, hazy(kFields[field % 4], 0.2 * (kRadii[r] - 1.2)));
            }
            if (r == 0) {
                builder.polygon({rings[1][k], rings[1][j], glm::dvec3{0.0, -0.06, 0.0}});
            } else {
                builder.polygon({rings[r + 1][k], rings[r + 1][j], rings[r][j], rings[r][k]});
            }
        }
    }
    return builder.take();
}

}  // namespace lw::scene
