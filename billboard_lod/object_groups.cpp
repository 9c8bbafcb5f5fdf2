#include "billboard_lod/object_groups.h"

#include <algorithm>
#include <numeric>

namespace lw {

namespace {

/// Objects further apart in size than this stay apart: a chair on a lawn is not part of the lawn.
constexpr double kLargestSizeRatio = 4.0;

struct Placed {
    std::uint32_t instance = 0;
    scene::Bounds bounds_world;
};

struct Pair {
    std::size_t a = 0;
    std::size_t b = 0;
    double distance2 = 0.0;
};

bool touch(const scene::Bounds& a, const scene::Bounds& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

bool similar(const scene::Bounds& a, const scene::Bounds& b) {
    const double size_a = glm::distance(a.min, a.max);
    const double size_b = glm::distance(b.min, b.max);
    return size_a <= kLargestSizeRatio * size_b && size_b <= kLargestSizeRatio * size_a;
}

/// Pairs of `placed` (sorted by the box's least x) that touch, nearest centres first.
std::vector<Pair> touching_pairs(const std::vector<Placed>& placed) {
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < placed.size(); ++a) {
        for (std::size_t b = a + 1; b < placed.size(); ++b) {
            if (placed[b].bounds_world.min.x > placed[a].bounds_world.max.x) break;
            if (!touch(placed[a].bounds_world, placed[b].bounds_world)) continue;
            if (!similar(placed[a].bounds_world, placed[b].bounds_world)) continue;
            const glm::dvec3 apart = placed[a].bounds_world.centre() - placed[b].bounds_world.centre();
            pairs.push_back({a, b, glm::dot(apart, apart)});
        }
    }
    std::ranges::stable_sort(pairs, {}, &Pair::distance2);
    return pairs;
}

/// Disjoint sets of at most kMaxGroupSize members.
class SmallSets {
public:
    explicit SmallSets(std::size_t count) : parent_(count), size_(count, 1) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    std::size_t root(std::size_t i) const {
        while (parent_[i] != i) i = parent_[i];
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        const std::size_t into = std::min(root(a), root(b));
        const std::size_t from = std::max(root(a), root(b));
        if (into == from || size_[into] + size_[from] > kMaxGroupSize) return;
        parent_[from] = into;
        size_[into] += size_[from];
    }

private:
    std::vector<std::size_t> parent_;
    std::vector<std::size_t> size_;
};

}  // namespace

std::vector<BillboardObject> billboard_objects(const scene::Scene& scene, const scene::SceneState& state,
                                               const std::vector<bool>& eligible, bool group_touching) {
    std::vector<BillboardObject> objects;
    std::vector<Placed> fixed;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (!eligible[i]) continue;
        const scene::Instance& instance = scene.instances[i];
        const scene::Bounds& bounds = scene.meshes[static_cast<std::size_t>(instance.mesh)].bounds;
        if (group_touching && instance.mover == 0) {
            fixed.push_back({i, scene::transformed(bounds, state.world_from_object(instance))});
        } else {
            objects.push_back({{i}, bounds, instance.mover});
        }
    }
    std::ranges::stable_sort(fixed, {}, [](const Placed& placed) { return placed.bounds_world.min.x; });
    SmallSets sets{fixed.size()};
    for (const Pair& pair : touching_pairs(fixed)) sets.join(pair.a, pair.b);
    std::vector<std::size_t> object_of_root(fixed.size(), fixed.size());
    const std::size_t first_group = objects.size();
    for (std::size_t k = 0; k < fixed.size(); ++k) {
        const std::size_t root = sets.root(k);
        if (object_of_root[root] == fixed.size()) {
            object_of_root[root] = objects.size() - first_group;
            objects.push_back({});
        }
        BillboardObject& object = objects[first_group + object_of_root[root]];
        object.instances.push_back(fixed[k].instance);
        object.bounds.include(fixed[k].bounds_world);
    }
    for (std::size_t k = first_group; k < objects.size(); ++k) {
        if (objects[k].group()) continue;
        const scene::Instance& instance = scene.instances[objects[k].instances.front()];
        objects[k].bounds = scene.meshes[static_cast<std::size_t>(instance.mesh)].bounds;
    }
    return objects;
}

}  // namespace lw
