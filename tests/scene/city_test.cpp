#include "scene/city.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "scene/city_building.h"
#include "scene/city_layout.h"
#include "scene/city_traffic.h"
#include "scene/city_vehicles.h"
#include "scene/gltf.h"

namespace lw::scene {
namespace {

const Scene& usual_city() {
    static const Scene scene = make_city({}).value();
    return scene;
}

Scene city_of(int buildings, std::uint64_t seed, int movers) {
    CityParameters parameters;
    parameters.buildings = buildings;
    parameters.seed = seed;
    parameters.movers = movers;
    return make_city(parameters).value();
}

/// Whether an eye-space box may meet the frustum of 90 degrees square: no side plane has all corners outside.
bool may_be_seen(const Bounds& bounds, const glm::dmat4& eye_from_object) {
    std::array<int, 5> outside{};
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1u) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2u) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4u) != 0 ? bounds.max.z : bounds.min.z};
        const glm::dvec4 eye = eye_from_object * glm::dvec4{point, 1.0};
        outside[0] += eye.x > -eye.z ? 1 : 0;
        outside[1] += eye.x < eye.z ? 1 : 0;
        outside[2] += eye.y > -eye.z ? 1 : 0;
        outside[3] += eye.y < eye.z ? 1 : 0;
        outside[4] += eye.z > -0.05 ? 1 : 0;
    }
    return std::none_of(outside.begin(), outside.end(), [](int count) { return count == 8; });
}

std::uint64_t centroids_in_view(const Mesh& mesh, const glm::dmat4& eye_from_object) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::dvec3 sum{0.0};
        for (std::size_t k = 0; k < 3; ++k) sum += glm::dvec3{mesh.vertices[mesh.indices[i + k]].position_object};
        const glm::dvec4 eye = eye_from_object * glm::dvec4{sum / 3.0, 1.0};
        if (-eye.z > 0.05 && std::abs(eye.x) < -eye.z && std::abs(eye.y) < -eye.z) ++count;
    }
    return count;
}

std::string bytes_of_glb(const Scene& scene, const std::string& name) {
    const std::filesystem::path folder{LW_TEST_OUTPUT_DIR};
    std::filesystem::create_directories(folder);
    const std::filesystem::path path = folder / name;
    const Status saved = save_glb(scene, path);
    EXPECT_TRUE(saved.ok());
    std::ifstream file{path, std::ios::binary};
    std::string bytes{std::istreambuf_iterator<char>{file}, {}};
    std::filesystem::remove(path);
    return bytes;
}

TEST(City, HasTheSizeItPromises) {
    const Scene& scene = usual_city();
    EXPECT_GE(scene.instances.size(), 300u);
    EXPECT_GE(scene.movers.size(), 20u);
    EXPECT_TRUE(scene.warnings.empty());

    SceneState state{scene};
    state.set_time(0.0);
    const glm::dmat4 eye_from_world = inverse_matrix_of(*scene.start_pose);
    std::uint64_t by_bounds = 0;
    std::uint64_t by_centroid = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const glm::dmat4 eye_from_object = eye_from_world * state.world_from_object(instance);
        if (!may_be_seen(mesh.bounds, eye_from_object)) continue;
        by_bounds += mesh.indices.size() / 3;
        by_centroid += centroids_in_view(mesh, eye_from_object);
    }
    EXPECT_GE(by_bounds, 900000u);
    EXPECT_LE(by_bounds, 1200000u);
    EXPECT_GE(by_centroid, 800000u);
}

TEST(City, NumberOfBuildingsAndMoversIsAsAsked) {
    for (const int buildings : {1, 7, 40, 333}) {
        const Scene scene = city_of(buildings, 3, 5);
        const auto houses = std::count_if(scene.nodes.begin(), scene.nodes.end(),
                                          [](const Node& node) { return node.name.rfind("house ", 0) == 0; });
        EXPECT_EQ(houses, buildings);
        EXPECT_EQ(scene.movers.size(), 5u);
    }
}

TEST(City, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const std::string one = bytes_of_glb(city_of(30, 5, 8), "city_a.glb");
    const std::string same = bytes_of_glb(city_of(30, 5, 8), "city_b.glb");
    const std::string other = bytes_of_glb(city_of(30, 6, 8), "city_c.glb");
    EXPECT_GT(one.size(), 1000000u);
    EXPECT_TRUE(one == same);
    EXPECT_FALSE(one == other);
}

TEST(City, MeshesAreSound) {
    for (const Mesh& mesh : usual_city().meshes) {
        ASSERT_FALSE(mesh.indices.empty()) << mesh.name;
        ASSERT_EQ(mesh.indices.size() % 3, 0u) << mesh.name;
        const auto largest = *std::max_element(mesh.indices.begin(), mesh.indices.end());
        ASSERT_LT(largest, mesh.vertices.size()) << mesh.name;
        for (const Vertex& v : mesh.vertices) {
            ASSERT_TRUE(std::isfinite(v.position_object.x + v.position_object.y + v.position_object.z)) << mesh.name;
            ASSERT_TRUE(std::isfinite(v.uv.x + v.uv.y)) << mesh.name;
            // Products of float rotations and square roots: a few units in the last place.
            ASSERT_NEAR(glm::dot(v.normal_object, v.normal_object), 1.0f, 1e-5f) << mesh.name;
            const glm::vec3 tangent{v.tangent_object};
            ASSERT_NEAR(glm::dot(tangent, tangent), 1.0f, 1e-5f) << mesh.name;
        }
        std::uint32_t next = 0;
        for (const Primitive& primitive : mesh.primitives) {
            ASSERT_EQ(primitive.first_index, next) << mesh.name;
            next += primitive.index_count;
            ASSERT_GE(primitive.material, 0) << mesh.name;
            ASSERT_LT(static_cast<std::size_t>(primitive.material), usual_city().materials.size()) << mesh.name;
        }
        ASSERT_EQ(next, mesh.indices.size()) << mesh.name;
    }
}

TEST(City, TrianglesHaveAreaAndFaceWhereTheirNormalsPoint) {
    for (const Mesh& mesh : usual_city().meshes) {
        std::size_t flat = 0;
        std::size_t turned_away = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vertex& a = mesh.vertices[mesh.indices[i]];
            const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
            const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
            const glm::dvec3 normal = glm::cross(glm::dvec3{b.position_object - a.position_object},
                                                 glm::dvec3{c.position_object - a.position_object});
            if (glm::dot(normal, normal) < 1e-18) ++flat;
            const glm::dvec3 shading{a.normal_object + b.normal_object + c.normal_object};
            if (glm::dot(normal, shading) < 0.0) ++turned_away;
        }
        EXPECT_EQ(flat, 0u) << mesh.name;
        // Leaves are seen from both sides and shaded as part of their crown.
        const bool leafy = mesh.name.find("tree") != std::string::npos || mesh.name == "poplar" ||
                           mesh.name == "hedge" || mesh.name == "planter";
        if (!leafy) {
            EXPECT_EQ(turned_away, 0u) << mesh.name;
        }
    }
}

TEST(City, NodesAndMeshesHaveNamesAndParentsComeFirst) {
    const Scene& scene = usual_city();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        EXPECT_FALSE(scene.nodes[i].name.empty());
        EXPECT_LT(scene.nodes[i].parent, static_cast<int>(i));
    }
    for (const Mesh& mesh : scene.meshes) EXPECT_FALSE(mesh.name.empty());
}

TEST(CityTraffic, ALoopIsClosedAndSmooth) {
    const CityLayout layout = make_city_layout(120, 1);
    for (const BlockGroup& group : layout.groups) {
        const TrafficLoop loop{layout, group};
        const CarState start = loop.at(0.0);
        const CarState end = loop.at(loop.round_s());
        EXPECT_LT(glm::length(start.position_m - end.position_m), 1e-9);  // double precision over 20 legs
        EXPECT_LT(glm::length(start.velocity_m_per_s - end.velocity_m_per_s), 1e-9);
        EXPECT_NEAR(end.heading_turns, start.heading_turns - 1.0, 1e-12);
        constexpr double kStep = 0.01;
        for (double t = 0.0; t + kStep < loop.round_s(); t += kStep) {
            const CarState a = loop.at(t);
            const CarState b = loop.at(t + kStep);
            // The mean of both velocities carries the car: accelerations stay below 4 m/s^2.
            const glm::dvec3 moved = 0.5 * kStep * (a.velocity_m_per_s + b.velocity_m_per_s);
            EXPECT_LT(glm::length(b.position_m - a.position_m - moved), 4.0 * kStep * kStep);
        }
    }
}

TEST(CityTraffic, GroupsCoverEveryBlockOnceAndLeaveTheStartStreetOpen) {
    for (const int buildings : {1, 55, 120, 2000}) {
        const CityLayout layout = make_city_layout(buildings, 9);
        EXPECT_EQ(layout.columns % 2, 0);
        std::vector<int> covered(layout.blocks.size(), 0);
        for (const BlockGroup& group : layout.groups) {
            const bool west = group.column < layout.columns / 2;
            EXPECT_EQ(west, group.column + group.columns - 1 < layout.columns / 2);
            for (int row = group.row; row < group.row + group.rows; ++row) {
                for (int column = group.column; column < group.column + group.columns; ++column) {
                    ++covered[static_cast<std::size_t>(row * layout.columns + column)];
                }
            }
        }
        EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), static_cast<std::ptrdiff_t>(covered.size()));
    }
}

TEST(CityTraffic, CarsFollowTheirLoopWithoutJumps) {
    const Scene& scene = usual_city();
    SceneState state{scene};
    std::vector<ObjectTransform> before;
    std::vector<ObjectTransform> after;
    // Across seams of every loop: none is longer than two minutes.
    constexpr double kStep_s = 1.0 / 30.0;
    state.set_time(0.0);
    state.mover_placements(before);
    for (int i = 1; i < 120 * 30; ++i) {
        state.set_time(i * kStep_s);
        state.mover_placements(after);
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t k = 0; k < after.size(); ++k) {
            const glm::dvec3 moved{after[k].world_from_object[3] - before[k].world_from_object[3]};
            const double speed = glm::length(moved) / kStep_s;
            ASSERT_GT(speed, 4.5) << "car " << k << " at " << i * kStep_s;
            ASSERT_LT(speed, 9.6) << "car " << k << " at " << i * kStep_s;
            // The car looks along +Z. A step turns it by at most 1.5 degrees, half of that off the mean direction.
            const glm::dvec3 forward{0.5 * (after[k].world_from_object[2] + before[k].world_from_object[2])};
            ASSERT_GT(glm::dot(glm::normalize(forward), glm::normalize(moved)), 0.9999) << "car " << k;
        }
        std::swap(before, after);
    }
}

TEST(CityTraffic, CarsStayOnTheRoadAndApart) {
    // As many cars as the streets hold, each seen as a disc around its middle.
    CityParameters parameters;
    parameters.buildings = 40;
    parameters.movers = 60000;
    const Result<Scene> refused = make_city(parameters);
    ASSERT_FALSE(refused.ok());
    const std::string mend = refused.error().mend;  // "at most N cars ..."
    parameters.movers = std::stoi(mend.substr(std::string{"at most "}.size()));
    const Scene scene = make_city(parameters).value();
    const CityLayout layout = make_city_layout(parameters.buildings, parameters.seed);
    SceneState state{scene};
    std::vector<ObjectTransform> cars;
    for (int i = 0; i < 300; ++i) {
        state.set_time(i * 0.37);
        state.mover_placements(cars);
        for (std::size_t a = 0; a < cars.size(); ++a) {
            const glm::dvec3 at{cars[a].world_from_object[3]};
            EXPECT_NEAR(at.y, 0.0, 1e-6);
            double from_street_m = 1e9;
            for (int c = 0; c <= layout.columns; ++c) {
                from_street_m = std::min(from_street_m, std::abs(at.x - layout.street_x_m(c)));
            }
            for (int r = 0; r <= layout.rows; ++r) {
                from_street_m = std::min(from_street_m, std::abs(at.z - layout.street_z_m(r)));
            }
            // In the middle of a turn a car is furthest from both centre lines: 1.65 + 6 (1 - cos 45) m.
            EXPECT_LT(from_street_m, kLane_m + 6.0 * (1.0 - std::sqrt(0.5)) + 1e-3);
            for (std::size_t b = a + 1; b < cars.size(); ++b) {
                const glm::dvec3 other{cars[b].world_from_object[3]};
                // Side by side cars in opposite lanes are 3.3 m apart; behind one another at least a length.
                EXPECT_GT(glm::length(at - other), 2.0 * kLane_m - 0.01);
                const glm::dvec3 forward{cars[a].world_from_object[2]};
                if (std::abs(glm::dot(at - other, forward)) > 3.0 ||
                    glm::dot(forward, glm::dvec3{cars[b].world_from_object[2]}) < 0.5)
                    continue;
                EXPECT_GT(glm::length(at - other), 2.0 * kVehicleHalfLength_m);
            }
        }
    }
}

TEST(SlowCity, TwentyThousandBuildingsFit) {
    const Scene scene = city_of(20000, 1, 1000);
    EXPECT_EQ(scene.movers.size(), 1000u);
    EXPECT_GT(scene.triangle_count(), 100000000u);
    std::size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) vertices += mesh.vertices.size();
    EXPECT_LT(vertices, 1000000u);  // meshes repeat: the town's size is in its nodes
}

/// Corners of the house's wall below `height_m` that lie within an edge of another triangle of its wall: there the
/// rasteriser leaves cracks. One line each.
std::vector<std::string> cracks(const Mesh& house, int wall, double height_m) {
    std::vector<std::array<glm::dvec3, 2>> edges;
    std::vector<glm::dvec3> corners;
    for (const Primitive& primitive : house.primitives) {
        if (primitive.material != wall) continue;
        for (std::uint32_t i = primitive.first_index; i < primitive.first_index + primitive.index_count; i += 3) {
            std::array<glm::dvec3, 3> triangle;
            for (std::uint32_t k = 0; k < 3; ++k) {
                triangle[k] = house.vertices[house.indices[i + k]].position_object;
            }
            if (std::ranges::any_of(triangle, [&](const glm::dvec3& corner) { return corner.y > height_m; })) continue;
            for (std::size_t k = 0; k < 3; ++k) edges.push_back({triangle[k], triangle[(k + 1) % 3]});
            corners.insert(corners.end(), triangle.begin(), triangle.end());
        }
    }
    std::vector<std::string> found;
    for (const auto& [from, to] : edges) {
        for (const glm::dvec3& corner : corners) {
            const double along = glm::dot(corner - from, to - from) / glm::dot(to - from, to - from);
            if (along < 1e-3 || along > 1.0 - 1e-3) continue;
            if (glm::distance(corner, glm::mix(from, to, along)) > 1e-5) continue;
            found.push_back(house.name + ": " + std::to_string(corner.x) + " " + std::to_string(corner.y) + " " +
                            std::to_string(corner.z));
        }
    }
    return found;
}

TEST(City, WallsOfAHouseMeetAtTheirCorners) {
    for (const bool shop : {false, true}) {
        for (const bool balconies : {false, true}) {
            BuildingStyle style;
            style.name = "house";
            style.wall = kBrick;
            style.shop = shop;
            style.balconies = balconies;
            style.windows_left = !shop;
            style.windows_right = true;
            Random random{5};
            const Mesh house = make_building(style, random);
            // Gables begin a little below the eaves, over the wall.
            const std::vector<std::string> found = cracks(house, kBrick, style.eaves_height_m() - 0.25);
            EXPECT_TRUE(found.empty()) << found.size() << ", one of them at " << found.front();
        }
    }
}

}  // namespace
}  // namespace lw::scene
