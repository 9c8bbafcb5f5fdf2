#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "scene/cells.h"

namespace lw::scene {

namespace {

/// The whole numbers of "PREFIX N" or "PREFIX N<separator>M..."; empty when the name is of another kind.
std::vector<int> numbers_of(std::string_view name, std::string_view prefix, char separator) {
    std::vector<int> numbers;
    if (name.substr(0, prefix.size()) != prefix) return numbers;
    const char* at = name.data() + prefix.size();
    const char* end = name.data() + name.size();
    while (at != end) {
        int number = 0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || number < 0 || number > 1'000'000) return {};
        numbers.push_back(number);
        if (next == end) return numbers;
        if (*next != separator) return {};
        at = next + 1;
    }
    return {};
}

class CellReader {
public:
    explicit CellReader(const Scene& scene) : scene_{scene}, state_{scene} { state_.set_time(0.0); }

    CellGraph run() {
        for (std::size_t node = 0; node < scene_.nodes.size(); ++node) read_node(static_cast<int>(node));
        if (graph_.cells.size() < 2 || !read_portals()) return {};
        const bool all_have_extents =
            std::all_of(has_extent_.begin() + 1, has_extent_.end(), [](bool has) { return has; });
        if (!all_have_extents) return {};
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (scene_.instances[i].mover != 0) continue;
            for (const int cell : cells_above(scene_.instances[i].node)) {
                if (static_cast<std::size_t>(cell) >= graph_.cells.size()) return {};
                graph_.cells[static_cast<std::size_t>(cell)].instances.push_back(i);
            }
        }
        graph_.find_visible();
        return std::move(graph_);
    }

private:
    void read_node(int node) {
        const Node& here = scene_.nodes[static_cast<std::size_t>(node)];
        if (here.name == "extent" && here.parent != kNone) {
            const auto cells = numbers_of(scene_.nodes[static_cast<std::size_t>(here.parent)].name, "cell ", '+');
            if (cells.size() == 1 && cells[0] > 0) read_extent(cells[0], state_.world_from_node(node));
            return;
        }
        if (numbers_of(here.name, "portal ", '-').size() == 2) portals_.push_back(node);
    }

    void read_extent(int cell, const glm::dmat4& world_from_extent) {
        const auto index = static_cast<std::size_t>(cell);
        if (index >= graph_.cells.size()) {
            graph_.cells.resize(index + 1);
            has_extent_.resize(index + 1, false);
        }
        const Bounds box = transformed({glm::dvec3{-1.0}, glm::dvec3{1.0}}, world_from_extent);
        graph_.cells[index].min_world = box.min;
        graph_.cells[index].max_world = box.max;
        has_extent_[index] = true;
    }

    bool read_portals() {
        for (const int node : portals_) {
            const auto cells = numbers_of(scene_.nodes[static_cast<std::size_t>(node)].name, "portal ", '-');
            Portal portal;
            for (std::size_t side = 0; side < 2; ++side) {
                if (static_cast<std::size_t>(cells[side]) >= graph_.cells.size()) return false;
                portal.cells[side] = cells[side];
                graph_.cells[static_cast<std::size_t>(cells[side])].portals.push_back(
                    static_cast<int>(graph_.portals.size()));
            }
            const glm::dmat4& world_from_square = state_.world_from_node(node);
            static constexpr double kCorners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
            for (std::size_t i = 0; i < 4; ++i) {
                portal.corners_world[i] =
                    glm::dvec3{world_from_square * glm::dvec4{kCorners[i][0], kCorners[i][1], 0.0, 1.0}};
            }
            graph_.portals.push_back(portal);
        }
        return true;
    }

    [[nodiscard]] std::vector<int> cells_above(int node) const {
        for (; node != kNone; node = scene_.nodes[static_cast<std::size_t>(node)].parent) {
            std::vector<int> cells = numbers_of(scene_.nodes[static_cast<std::size_t>(node)].name, "cell ", '+');
            if (!cells.empty()) return cells;
        }
        return {0};
    }

    const Scene& scene_;
    SceneState state_;
    CellGraph graph_;
    std::vector<bool> has_extent_;
    std::vector<int> portals_;
};

}  // namespace

CellGraph cells_of(const Scene& scene) { return CellReader{scene}.run(); }

}  // namespace lw::scene
