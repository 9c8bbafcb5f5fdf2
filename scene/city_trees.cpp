#include "scene/city_trees.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/city_materials.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

struct TreeShape {
    const char* name;
    double trunk_m;         ///< height of the crown's lower end
    glm::dvec3 crown_half;  ///< half size of the whole crown
    int blobs;
    int leaves;
    double leaf_m;
    std::uint32_t green;
};

constexpr std::array<TreeShape, 6> kShapes{{
    {"street tree 1", 2.5, {1.7, 1.9, 1.7}, 5, 700, 0.27, 0x7C9A4A},
    {"street tree 2", 2.7, {1.6, 2.3, 1.6}, 6, 760, 0.27, 0x6C9150},
    {"street tree 3", 2.4, {1.5, 1.6, 1.5}, 5, 660, 0.26, 0x93A650},
    {"garden tree", 2.2, {2.8, 2.6, 2.8}, 8, 780, 0.37, 0x6B8A45},
    {"tall tree", 3.0, {2.6, 3.8, 2.6}, 9, 810, 0.41, 0x5E8248},
    {"poplar", 1.2, {1.1, 4.6, 1.1}, 7, 710, 0.32, 0x71904A},
}};

struct Blob {
    glm::dvec3 centre;
    glm::dvec3 half;
};

std::vector<Blob> blobs_of(const TreeShape& shape, const glm::dvec3& middle, Random& random) {
    std::vector<Blob> blobs;
    for (int i = 0; i < shape.blobs; ++i) {
        // Spread round the crown by the golden ratio, the last one on top.
        const double t = (i + 0.5) / shape.blobs;
        const Direction2 around = direction_of_turns(i * 0.61803398875 + random.between(-0.05, 0.05));
        const double y = 2.0 * t - 1.0;
        const double r = 0.52 * std::sqrt(std::max(0.0, 1.0 - y * y));
        const glm::dvec3 offset{r * around.cosine, 0.58 * y, r * around.sine};
        blobs.push_back({middle + offset * shape.crown_half, shape.crown_half * random.between(0.48, 0.6)});
    }
    return blobs;
}

/// Dark inside, so that gaps between leaves do not show the sky everywhere.
void add_core(MeshBuilder& builder, const Blob& blob, std::uint32_t green) {
    builder.use_material(kLeaf);
    builder.use_colour(tint(green, 0.34));
    const double r = 0.58 * blob.half.x;
    const double h = 0.58 * blob.half.y;
    builder.lathe(blob.centre, {{0.0, -h}, {0.85 * r, -0.5 * h}, {0.85 * r, 0.5 * h}, {0.0, h}}, 6);
}

void add_leaf(MeshBuilder& builder, const glm::dvec3& at, const glm::dvec3& outward, double size, Random& random) {
    glm::dvec3 facing = outward + 0.75 * random_direction(random);
    facing /= std::sqrt(glm::dot(facing, facing));
    glm::dvec3 along = glm::cross(facing, random_direction(random));
    along /= std::sqrt(glm::dot(along, along));
    const glm::dvec3 across = glm::cross(facing, along);
    glm::dvec3 normal = outward * 1.6 + facing + glm::dvec3{0.0, 0.4, 0.0};
    normal /= std::sqrt(glm::dot(normal, normal));
    const double half = 0.5 * size;
    const glm::dvec3 droop = facing * (-0.22 * size);
    // A pointed oval, bent over its middle: six corners, four triangles.
    const auto corner = [&](double forward, double sideways, double bend) {
        return builder.vertex(at + along * (forward * half) + across * (sideways * half) + droop * bend, normal);
    };
    const std::array<std::uint32_t, 6> rim{corner(1.0, 0.0, 1.0),  corner(0.3, 0.62, 0.0),   corner(-0.4, 0.58, 0.1),
                                           corner(-1.0, 0.0, 1.0), corner(-0.4, -0.58, 0.1), corner(0.3, -0.62, 0.0)};
    for (std::size_t i = 1; i + 1 < rim.size(); ++i) builder.triangle(rim[0], rim[i], rim[i + 1]);
}

void add_leaves(MeshBuilder& builder, const TreeShape& shape, std::span<const Blob> blobs, double low, double high,
                Random& random) {
    builder.use_material(kLeaf);
    int placed = 0;
    while (placed < shape.leaves) {
        const Blob& blob = blobs[static_cast<std::size_t>(placed) % blobs.size()];
        const glm::dvec3 outward = random_direction(random);
        const glm::dvec3 at = blob.centre + outward * blob.half * random.between(0.74, 1.06);
        ++placed;
        const bool inside = std::any_of(blobs.begin(), blobs.end(), [&](const Blob& other) {
            const glm::dvec3 q = (at - other.centre) / other.half;
            return glm::dot(q, q) < 0.5;
        });
        if (inside) continue;  // hidden in another part of the crown
        // Lighter and yellower towards the top and the outside.
        const double height = std::clamp((at.y - low) / (high - low), 0.0, 1.0);
        const double light = 0.62 + 0.5 * height + random.between(-0.13, 0.13);
        const std::uint32_t warm = random.chance(0.2) ? 0x180A00u : 0u;
        builder.use_colour(tint(shape.green + warm, light));
        add_leaf(builder, at, outward, shape.leaf_m * random.between(0.8, 1.35), random);
    }
}

void add_trunk(MeshBuilder& builder, const TreeShape& shape, std::span<const Blob> blobs) {
    builder.use_material(kBark, texture_size_m(kBark));
    builder.use_colour(tint(0xC9B9A8));
    const double r = 0.055 * shape.crown_half.x + 0.06;
    const double top = shape.trunk_m + 0.9 * shape.crown_half.y;
    builder.lathe({0.0, 0.0, 0.0},
                  {{1.5 * r, 0.0}, {1.08 * r, 0.25}, {0.92 * r, shape.trunk_m}, {0.4 * r, top}, {0.0, top + 0.1}}, 9);
    for (const Blob& blob : blobs) {
        const glm::dvec3 from{0.0, shape.trunk_m - 0.35 + 0.35 * (blob.centre.y - shape.trunk_m), 0.0};
        const std::array<glm::dvec3, 3> path{from, glm::mix(from, blob.centre, 0.55) + glm::dvec3{0.0, -0.12, 0.0},
                                             blob.centre};
        builder.tube(path, 0.3 * r + 0.015, 5);
    }
}

Mesh make_tree(const TreeShape& shape, Random& random) {
    MeshBuilder builder{shape.name};
    const glm::dvec3 middle{0.0, shape.trunk_m + shape.crown_half.y, 0.0};
    const std::vector<Blob> blobs = blobs_of(shape, middle, random);
    add_trunk(builder, shape, blobs);
    for (const Blob& blob : blobs) add_core(builder, blob, shape.green);
    add_leaves(builder, shape, blobs, shape.trunk_m, shape.trunk_m + 2.0 * shape.crown_half.y, random);
    return builder.take();
}

}  // namespace

std::vector<Mesh> make_trees(std::uint64_t seed) {
    std::vector<Mesh> trees;
    for (const TreeShape& shape : kShapes) {
        Random random{seed, 2000u + trees.size()};
        trees.push_back(make_tree(shape, random));
    }
    return trees;
}

Mesh make_hedge(std::uint64_t seed) {
    Random random{seed, 2100};
    MeshBuilder builder{"hedge"};
    builder.use_material(kLeaf);
    builder.use_colour(tint(0x4D6A38, 0.5));
    builder.box({-1.0, 0.0, -0.28}, {1.0, 1.0, 0.28}, kNoBottom);
    for (int i = 0; i < 150; ++i) {
        const int face = random.below(5);
        const double x = random.between(-1.0, 1.0);
        const double y = random.between(0.05, 1.05);
        glm::dvec3 at{x, 1.05, random.between(-0.3, 0.3)};
        glm::dvec3 outward{0.0, 1.0, 0.0};
        if (face >= 1) {
            const double side = face >= 3 ? 1.0 : -1.0;
            at = {x, y, side * 0.32};
            outward = {0.0, 0.0, side};
        }
        builder.use_colour(tint(0x5F7F3F, random.between(0.65, 1.2)));
        add_leaf(builder, at, outward, 0.2, random);
    }
    return builder.take();
}

}  // namespace lw::scene
