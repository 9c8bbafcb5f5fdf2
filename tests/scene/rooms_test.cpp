#include "scene/rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "scene/built_in.h"
#include "scene/cells.h"
#include "scene/gltf.h"
#include "scene/random.h"

namespace lw::scene {
namespace {

TEST(Rooms, HasTheRoomsAskedForAndCellsForThem) {
    for (const int rooms : {4, 60, 240}) {
        const Scene scene = make_rooms({rooms, 2, 1});
        const CellGraph graph = cells_of(scene);
        EXPECT_GT(graph.cells.size(), static_cast<std::size_t>(rooms)) << "rooms, corridors, lobbies and the outside";
        for (std::size_t cell = 1; cell < graph.cells.size(); ++cell) {
            EXPECT_FALSE(graph.cells[cell].portals.empty()) << "a room without a door";
            EXPECT_FALSE(graph.cells[cell].instances.empty());
        }
        std::vector<int> held(scene.instances.size(), 0);
        for (const Cell& cell : graph.cells) {
            for (const std::uint32_t instance : cell.instances) ++held[instance];
        }
        for (std::size_t i = 0; i < held.size(); ++i) {
            EXPECT_EQ(held[i] > 0, scene.instances[i].mover == 0) << "instance " << i;
        }
        EXPECT_EQ(scene.movers.size(), 2U);
        EXPECT_NE(graph.cell_at(scene.start_pose->position_m), 0) << "the viewer starts inside";
    }
}

TEST(Rooms, CellsSurviveAFile) {
    const Scene scene = make_rooms({24, 2, 1});
    const CellGraph graph = cells_of(scene);
    const std::filesystem::path path = std::filesystem::path{testing::TempDir()} / "lw_rooms_test.glb";
    ASSERT_TRUE(save_glb(scene, path).ok());
    const auto loaded = load_scene(path.string(), {});
    std::filesystem::remove(path);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message();
    const CellGraph again = cells_of(*loaded);
    ASSERT_EQ(again.cells.size(), graph.cells.size());
    EXPECT_EQ(again.portals.size(), graph.portals.size());
    for (std::size_t cell = 0; cell < graph.cells.size(); ++cell) {
        EXPECT_EQ(again.cells[cell].instances.size(), graph.cells[cell].instances.size()) << "cell " << cell;
        EXPECT_NEAR(glm::distance(again.cells[cell].min_world, graph.cells[cell].min_world), 0.0, 1e-4);
    }
}

TEST(Rooms, SceneWithoutCellsHasNone) {
    const auto city = make_built_in("city", {{"buildings", 4.0}});
    ASSERT_TRUE(city.ok());
    EXPECT_TRUE(cells_of(*city).empty());
}

/// The portal through which a ray leaves a cell's box, if it goes through one: the box's exit point against portals'
/// rectangles, carried on through the wall.
std::optional<int> portal_met(const CellGraph& graph, int cell, const glm::dvec3& origin, const glm::dvec3& direction) {
    std::optional<int> met;
    double nearest = 1e30;
    for (const int index : graph.cells[static_cast<std::size_t>(cell)].portals) {
        const auto& c = graph.portals[static_cast<std::size_t>(index)].corners_world;
        const glm::dvec3 normal = glm::cross(c[1] - c[0], c[3] - c[0]);
        const double along = glm::dot(normal, direction);
        if (std::abs(along) < 1e-12) continue;
        const double t = glm::dot(normal, c[0] - origin) / along;
        if (t <= 1e-9 || t >= nearest) continue;
        const glm::dvec3 at = origin + direction * t - c[0];
        const glm::dvec3 u = c[1] - c[0];
        const glm::dvec3 v = c[3] - c[0];
        const double a = glm::dot(at, u) / glm::dot(u, u);
        const double b = glm::dot(at, v) / glm::dot(v, v);
        if (a < 0.0 || a > 1.0 || b < 0.0 || b > 1.0) continue;
        // In the plane of the portal, and before the ray leaves the cell for good: within the wall's thickness.
        const Cell& here = graph.cells[static_cast<std::size_t>(cell)];
        const glm::dvec3 point = origin + direction * t;
        if (glm::distance(point, glm::clamp(point, here.min_world, here.max_world)) > 0.4) continue;
        nearest = t;
        met = index;
    }
    return met;
}

TEST(Rooms, NoRayReachesACellThatIsSaidToBeHidden) {
    const Scene scene = make_rooms({60, 0, 3});
    const CellGraph graph = cells_of(scene);
    Random random{9};
    int deepest = 0;
    for (int cell = 1; cell < static_cast<int>(graph.cells.size()); ++cell) {
        const Cell& from = graph.cells[static_cast<std::size_t>(cell)];
        for (int ray = 0; ray < 400; ++ray) {
            glm::dvec3 at = from.min_world +
                            (from.max_world - from.min_world) * glm::dvec3{random.unit(), random.unit(), random.unit()};
            glm::dvec3 direction = random_direction(random);
            direction.y *= 0.2;
            int here = cell;
            // Straight through every portal it meets; walls stop it. That it might graze a door's frame does not
            // matter.
            for (int step = 0; step < 12 && here != 0; ++step) {
                const auto portal = portal_met(graph, here, at, direction);
                if (!portal) break;
                const auto& cells = graph.portals[static_cast<std::size_t>(*portal)].cells;
                const auto& c = graph.portals[static_cast<std::size_t>(*portal)].corners_world;
                const glm::dvec3 normal = glm::cross(c[1] - c[0], c[3] - c[0]);
                at += direction * (glm::dot(normal, c[0] - at) / glm::dot(normal, direction));
                here = cells[0] == here ? cells[1] : cells[0];
                EXPECT_TRUE(graph.may_see(cell, here)) << "from " << cell << " to " << here;
                deepest = std::max(deepest, step + 1);
            }
        }
    }
    EXPECT_GE(deepest, 3) << "no ray went through several doors";
}

TEST(Rooms, MostCellsAreHiddenFromARoom) {
    const CellGraph graph = cells_of(make_rooms({240, 0, 1}));
    double seen = 0.0;
    for (int from = 1; from < static_cast<int>(graph.cells.size()); ++from) {
        for (int to = 0; to < static_cast<int>(graph.cells.size()); ++to) seen += graph.may_see(from, to) ? 1.0 : 0.0;
    }
    const double mean = seen / static_cast<double>(graph.cells.size() - 1);
    EXPECT_LT(mean, 0.25 * static_cast<double>(graph.cells.size())) << mean << " of " << graph.cells.size();
}

}  // namespace
}  // namespace lw::scene
