#include "client_renderer/occluders.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "client_renderer/fetch_lines.h"
#include "client_renderer/occluder_rows.h"

namespace lw {

namespace {

// Smaller ones cover few parts, and there are many of them.
constexpr double kLeastParts = 24.0;

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

float largest_face(const glm::vec3& size) { return std::max({size.x * size.y, size.y * size.z, size.z * size.x}); }

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
    for (const PlacedInstance& instance : placed.all()) used[static_cast<std::size_t>(instance.mesh)] = true;
    boxes_of_meshes_.resize(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        if (used[mesh]) boxes_of_meshes_[mesh] = scene::solid_boxes(scene.meshes[mesh], scene.materials);
    }
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(placed[i].mesh);
        for (std::size_t box = 0; box < boxes_of_meshes_[mesh].size(); ++box) {
            if (std::abs(glm::determinant(glm::dmat3{placed[i].world_from_object})) < 1e-12) continue;
            if (placed[i].mover != 0) {
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
        const auto mesh = static_cast<std::size_t>(placed[moving.instance].mesh);
        occluders_.push_back(placed_occluder(boxes_of_meshes_[mesh][moving.box], placed[moving.instance]));
    }
    index();
}

void Occluders::move(const PlacedInstances& placed) {
    if (moving_.empty()) return;
    for (const Moving& moving : moving_) {
        const PlacedInstance& instance = placed[moving.instance];
        const auto mesh = static_cast<std::size_t>(instance.mesh);
        occluders_[moving.occluder] = placed_occluder(boxes_of_meshes_[mesh][moving.box], instance);
        bounds_[moving.occluder] = occluders_[moving.occluder].bounds_world;
    }
    bvh_->refit(moved_, bounds_);
    tree_->move(*bvh_, moved_, bounds_);
}

void Occluders::index() {
    for (const Occluder& occluder : occluders_) bounds_.push_back(occluder.bounds_world);
    bvh_.emplace(bounds_, 8);
    tree_.emplace(*bvh_, bounds_);
    // Children come after their parents.
    areas_.assign(tree_->slot_count(), 0.0F);
    for (auto slot = static_cast<std::uint32_t>(areas_.size()); slot-- > 0;) {
        if (tree_->item_count(slot) == 0) continue;
        const WideBvh::Child& child = tree_->child(slot);
        if (child.is_item()) {
            // A mover's box changes as it turns, by less than this.
            const float slack = child.first < static_count_ ? 1.0F : 2.0F;
            const scene::Bounds& bounds = bounds_[child.first];
            areas_[slot] = slack * largest_face(glm::vec3{bounds.max - bounds.min});
        } else {
            const float* first = areas_.data() + child.first;
            areas_[slot] = *std::max_element(first, first + child.slot_count);
        }
    }
}

void Occluders::fetch(const WideBvh::Child& child) const {
    if (child.is_item()) {
        fetch_lines(&occluders_[child.first]);
        fetch_lines(&bounds_[child.first]);
        return;
    }
    tree_->fetch(child);
    fetch_run(areas_.data() + child.first, child.slot_count);
}

void Occluders::open(const OccluderQuery& query, const WideBvh::Child& node, const OcclusionBuffer& buffer) {
    std::size_t end = candidates_.size();
    append_worth(*tree_, node, areas_.data(), query, buffer, candidates_);
    while (end < candidates_.size()) {
        fetch(tree_->child(candidates_[end].slot()));
        ++end;
        std::push_heap(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(end));
    }
}

std::size_t Occluders::draw(const Camera& camera, double margin_m, OcclusionBuffer& buffer) {
    candidates_.clear();
    if (bvh_->empty()) return 0;
    // What looks smaller than a part of a pixel of the buffer covers none.
    const glm::dvec2 part{(camera.fov.right - camera.fov.left) / (OcclusionBuffer::kParts * buffer.size_px().x),
                          (camera.fov.up - camera.fov.down) / (OcclusionBuffer::kParts * buffer.size_px().y)};
    // What moves has moved on while the frame is shown: with a margin only what stands still hides anything.
    const OccluderQuery query{rounded(frustum_of(camera)), glm::vec3{camera.world_from_eye.position_m},
                              static_cast<float>(kLeastParts * part.x * part.y),
                              margin_m > 0.0 ? static_cast<std::uint32_t>(static_count_) : 0xFFFFFFFFU};
    open(query, tree_->root(), buffer);
    std::size_t drawn = 0;
    while (!candidates_.empty() && drawn < kMostDrawn) {
        std::pop_heap(candidates_.begin(), candidates_.end());
        const WideBvh::Child& child = tree_->child(candidates_.back().slot());
        candidates_.pop_back();
        if (!child.is_item()) {
            open(query, child, buffer);
            continue;
        }
        // What was drawn since it was found may hide it.
        const scene::Bounds& bounds = bounds_[child.first];
        if (buffer.hides(glm::vec3{bounds.min}, glm::vec3{bounds.max})) continue;
        const auto solid = usable(occluders_[child.first], camera, margin_m);
        if (!solid) continue;
        buffer.add(*solid, bounds);
        ++drawn;
    }
    return drawn;
}

}  // namespace lw
