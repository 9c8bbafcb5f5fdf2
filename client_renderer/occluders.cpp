#include "client_renderer/occluders.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "client_renderer/occluder_rows.h"

namespace lw {

namespace {

Occluder placed_occluder(const scene::SolidBox& box, const PlacedInstance& placed) {
    Occluder occluder;
    occluder.open_sides = box.open_sides;
    occluder.bounds_world = scene::transformed(box.box_object, placed.world_from_object);
    occluder.surface_bounds_world = placed.bounds_world;
    const glm::dmat3 axes{placed.world_from_object};
    // A plane's normal turns with the cofactors of the matrix; a mirroring one would turn it inside out.
    const glm::dmat3 cofactors = glm::transpose(glm::inverse(axes));
    for (int side = 0; side < 6; ++side) {
        const bool upper = side % 2 == 1;
        glm::dvec3 normal_object{0.0};
        normal_object[side / 2] = upper ? 1.0 : -1.0;
        const glm::dvec3 normal = glm::normalize(cofactors * normal_object);
        const glm::dvec3 point{placed.world_from_object *
                               glm::dvec4{upper ? box.box_object.max : box.box_object.min, 1.0}};
        occluder.solid.planes_world[static_cast<std::size_t>(side)] = {normal, glm::dot(normal, point)};
    }
    return occluder;
}

double largest_face(const scene::Bounds& bounds) {
    const glm::dvec3 size = bounds.max - bounds.min;
    return std::max({size.x * size.y, size.y * size.z, size.z * size.x});
}

/// How large something of that area looks, roughly, at the box's nearest point: area over squared distance.
float score_of(double area, const scene::Bounds& bounds, const glm::dvec3& eye_world) {
    const glm::dvec3 to_box = glm::clamp(eye_world, bounds.min, bounds.max) - eye_world;
    return static_cast<float>(area / (glm::dot(to_box, to_box) + 1.0));
}

/// The occluder made smaller, or nothing where it hides nothing from an eye within the margin.
std::optional<ConvexSolid> usable(const Occluder& occluder, const Camera& camera, double margin_m) {
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    // The near plane must not cut a hole into the surface around the solid.
    const glm::dvec2 tangent{std::max(std::abs(camera.fov.left), std::abs(camera.fov.right)),
                             std::max(std::abs(camera.fov.down), std::abs(camera.fov.up))};
    const double clear_m = margin_m + camera.near_m * std::sqrt(1.0 + glm::dot(tangent, tangent));
    const glm::dvec3 nearest =
        glm::clamp(eye_world, occluder.surface_bounds_world.min, occluder.surface_bounds_world.max);
    if (glm::distance(nearest, eye_world) <= clear_m) return std::nullopt;
    ConvexSolid solid = occluder.solid;
    for (std::size_t side = 0; side < 6; ++side) {
        glm::dvec4& plane = solid.planes_world[side];
        const double outside_m = glm::dot(glm::dvec3{plane}, eye_world) - plane.w;
        if ((occluder.open_sides >> side & 1U) != 0 && outside_m + margin_m > 0.0) return std::nullopt;
        plane.w -= margin_m;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // The planes of one axis are parallel, with opposite normals.
        if (solid.planes_world[2 * axis].w + solid.planes_world[2 * axis + 1].w <= 0.0) return std::nullopt;
    }
    return solid;
}

}  // namespace

Occluders::Occluders(const PlacedInstances& placed) {
    const scene::Scene& scene = placed.scene();
    std::vector<bool> used(scene.meshes.size(), false);
    for (const PlacedInstance& instance : placed.all()) used[static_cast<std::size_t>(instance.instance->mesh)] = true;
    boxes_of_meshes_.resize(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (used[mesh]) boxes_of_meshes_[mesh] = scene::solid_boxes(scene.meshes[mesh], scene.materials);
    }
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(placed[i].instance->mesh);
        for (std::size_t box = 0; box < boxes_of_meshes_[mesh].size(); ++box) {
            if (std::abs(glm::determinant(glm::dmat3{placed[i].world_from_object})) < 1e-12) continue;
            if (placed[i].instance->mover != 0) {
                moving_.push_back({0, i, box});
            } else {
                occluders_.push_back(placed_occluder(boxes_of_meshes_[mesh][box], placed[i]));
            }
        }
    }
    append_rows(occluders_);
    static_count_ = occluders_.size();
    for (Moving& moving : moving_) {
        moving.occluder = occluders_.size();
        moved_.push_back(static_cast<std::uint32_t>(moving.occluder));
        const auto mesh = static_cast<std::size_t>(placed[moving.instance].instance->mesh);
        occluders_.push_back(placed_occluder(boxes_of_meshes_[mesh][moving.box], placed[moving.instance]));
    }
    index();
}

void Occluders::move(const PlacedInstances& placed) {
    if (moving_.empty()) return;
    for (const Moving& moving : moving_) {
        const PlacedInstance& instance = placed[moving.instance];
        const auto mesh = static_cast<std::size_t>(instance.instance->mesh);
        occluders_[moving.occluder] = placed_occluder(boxes_of_meshes_[mesh][moving.box], instance);
        bounds_[moving.occluder] = occluders_[moving.occluder].bounds_world;
    }
    bvh_->refit(moved_, bounds_);
}

void Occluders::index() {
    for (const Occluder& occluder : occluders_) bounds_.push_back(occluder.bounds_world);
    bvh_.emplace(bounds_, 8);
    // Children come after their parents.
    largest_areas_.assign(bvh_->nodes().size(), 0.0F);
    for (std::size_t node = bvh_->nodes().size(); node-- > 0;) {
        const auto index = static_cast<std::uint32_t>(node);
        if (bvh_->nodes()[node].count > 0) {
            for (std::uint32_t i = bvh_->first_item(index); i < bvh_->end_item(index); ++i) {
                // A mover's box changes as it turns, by less than this.
                const std::uint32_t item = bvh_->order()[i];
                const double slack = item < static_count_ ? 1.0 : 2.0;
                const auto area = static_cast<float>(slack * largest_face(bounds_[item]));
                largest_areas_[node] = std::max(largest_areas_[node], area);
            }
        }
        const std::uint32_t parent = bvh_->parent(index);
        if (parent != scene::Bvh::kNone)
            largest_areas_[parent] = std::max(largest_areas_[parent], largest_areas_[node]);
    }
}

void Occluders::offer(const Choice& choice) {
    const auto better = [](const Choice& a, const Choice& b) {
        return a.score != b.score ? a.score > b.score : a.occluder < b.occluder;
    };
    if (choices_.size() == kMostDrawn) {
        if (!better(choice, choices_.front())) return;
        std::ranges::pop_heap(choices_, better);
        choices_.pop_back();
    }
    choices_.push_back(choice);
    std::ranges::push_heap(choices_, better);
}

void Occluders::choose(const Camera& camera, bool movers_too) {
    const Frustum frustum = frustum_of(camera);
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    choices_.clear();
    if (bvh_->empty()) return;
    const auto bounds_of = [&](std::uint32_t node) {
        return scene::Bounds{glm::dvec3{bvh_->nodes()[node].min}, glm::dvec3{bvh_->nodes()[node].max}};
    };
    const auto promise = [&](std::uint32_t node) {
        return score_of(double{largest_areas_[node]}, bounds_of(node), eye_world);
    };
    std::vector<std::uint32_t> stack{scene::Bvh::kRoot};
    while (!stack.empty()) {
        const std::uint32_t node = stack.back();
        stack.pop_back();
        if (choices_.size() == kMostDrawn && promise(node) < choices_.front().score) continue;
        if (!may_see(frustum, bounds_of(node))) continue;
        const scene::BvhNode& here = bvh_->nodes()[node];
        if (here.count == 0) {
            // The better one first: it raises what the others must reach.
            const bool first_is_better = promise(here.first) >= promise(here.first + 1);
            stack.push_back(first_is_better ? here.first + 1 : here.first);
            stack.push_back(first_is_better ? here.first : here.first + 1);
            continue;
        }
        for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
            const std::uint32_t item = bvh_->order()[i];
            if (!movers_too && item >= static_count_) continue;
            if (!may_see(frustum, bounds_[item])) continue;
            offer({score_of(largest_face(bounds_[item]), bounds_[item], eye_world), item});
        }
    }
}

std::size_t Occluders::draw(const Camera& camera, double margin_m, OcclusionBuffer& buffer) {
    // What moves has moved on while the frame is shown: with a margin only what stands still hides anything.
    choose(camera, !(margin_m > 0.0));
    std::size_t drawn = 0;
    for (const Choice& choice : choices_) {
        const auto solid = usable(occluders_[choice.occluder], camera, margin_m);
        if (!solid) continue;
        buffer.add(*solid, occluders_[choice.occluder].bounds_world);
        ++drawn;
    }
    return drawn;
}

}  // namespace lw
