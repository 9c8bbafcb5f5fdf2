#include "client_renderer/occluders.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "client_renderer/fetch_lines.h"
#include "client_renderer/occluder_rows.h"

namespace lw {

namespace {

// Smaller ones cover few parts, and there are many of them.
constexpr double kLeastParts = 8.0;

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

/// How large something of that area looks, roughly, at the box's nearest point: area over squared distance.
float score_of(float area, const glm::vec3& box_min, const glm::vec3& box_max, const glm::vec3& eye_world) {
    const glm::vec3 to_box = glm::clamp(eye_world, box_min, box_max) - eye_world;
    return area / (glm::dot(to_box, to_box) + 1.0F);
}

/// Without allowing for rounding: an occluder missed at the edge of the view hides nothing there.
bool is_in_view(const FloatFrustum& frustum, const glm::vec3& box_min, const glm::vec3& box_max) {
    for (const FloatFrustum::Plane& plane : frustum.planes) {
        const float farthest = plane.x * (plane.x > 0.0F ? box_max.x : box_min.x) +
                               plane.y * (plane.y > 0.0F ? box_max.y : box_min.y) +
                               plane.z * (plane.z > 0.0F ? box_max.z : box_min.z) + plane.w;
        if (farthest < 0.0F) return false;
    }
    return true;
}

constexpr std::uint32_t kNodeBit = 0x80000000U;

/// For a heap: the best score on top (bits of positive floats are in the order of their values), equal ones by place.
std::uint64_t candidate_of(float score, std::uint32_t place) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(score)} << 32U | std::uint32_t{~place};
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
        const std::uint32_t place = bvh_->place_of(static_cast<std::uint32_t>(moving.occluder));
        items_[place] = item_of(static_cast<std::uint32_t>(moving.occluder));
    }
    bvh_->refit(moved_, bounds_);
}

Occluders::Item Occluders::item_of(std::uint32_t occluder) const {
    // A mover's box changes as it turns, by less than this.
    const float slack = occluder < static_count_ ? 1.0F : 2.0F;
    const scene::Bounds& bounds = bounds_[occluder];
    return {glm::vec3{bounds.min}, slack * largest_face(glm::vec3{bounds.max - bounds.min}), glm::vec3{bounds.max},
            occluder};
}

void Occluders::index() {
    for (const Occluder& occluder : occluders_) bounds_.push_back(occluder.bounds_world);
    bvh_.emplace(bounds_, 8);
    for (const std::uint32_t occluder : bvh_->order()) items_.push_back(item_of(occluder));
    // Children come after their parents.
    largest_areas_.assign(bvh_->nodes().size(), 0.0F);
    for (std::size_t node = bvh_->nodes().size(); node-- > 0;) {
        const auto index = static_cast<std::uint32_t>(node);
        if (bvh_->nodes()[node].count > 0) {
            for (std::uint32_t i = bvh_->first_item(index); i < bvh_->end_item(index); ++i) {
                largest_areas_[node] = std::max(largest_areas_[node], items_[i].area);
            }
        }
        const std::uint32_t parent = bvh_->parent(index);
        if (parent != scene::Bvh::kNone)
            largest_areas_[parent] = std::max(largest_areas_[parent], largest_areas_[node]);
    }
}

void Occluders::offer(const Query& query, const Item& item, std::uint32_t place) {
    const float score = score_of(item.area, item.min, item.max, query.eye_world);
    if (score < query.least_score || !is_in_view(query.frustum, item.min, item.max)) return;
    fetch(place);
    candidates_.push_back(candidate_of(score, place));
    std::ranges::push_heap(candidates_);
}

void Occluders::fetch(std::uint32_t place) const {
    if ((place & kNodeBit) == 0) {
        fetch_lines(&occluders_[items_[place].index]);
        fetch_lines(&bounds_[items_[place].index]);
        return;
    }
    const scene::BvhNode& node = bvh_->nodes()[place & ~kNodeBit];
    if (node.count == 0) {
        fetch_lines(&bvh_->nodes()[node.first]);
    } else {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) fetch_lines(&items_[i]);
    }
}

void Occluders::offer_inside(const Query& query, std::uint32_t node) {
    const scene::BvhNode& here = bvh_->nodes()[node];
    if (here.count == 0) {
        for (const std::uint32_t child : {here.first, here.first + 1}) {
            const scene::BvhNode& box = bvh_->nodes()[child];
            offer(query, {box.min, largest_areas_[child], box.max, child}, child | kNodeBit);
        }
        return;
    }
    for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
        if (items_[i].index < query.end) offer(query, items_[i], i);
    }
}

std::size_t Occluders::draw(const Camera& camera, double margin_m, OcclusionBuffer& buffer) {
    candidates_.clear();
    if (bvh_->empty()) return 0;
    // What looks smaller than a part of a pixel of the buffer covers none.
    const glm::dvec2 part{(camera.fov.right - camera.fov.left) / (OcclusionBuffer::kParts * buffer.size_px().x),
                          (camera.fov.up - camera.fov.down) / (OcclusionBuffer::kParts * buffer.size_px().y)};
    // What moves has moved on while the frame is shown: with a margin only what stands still hides anything.
    const Query query{rounded(frustum_of(camera)), glm::vec3{camera.world_from_eye.position_m},
                      static_cast<float>(kLeastParts * part.x * part.y),
                      margin_m > 0.0 ? static_cast<std::uint32_t>(static_count_) : 0xFFFFFFFFU};
    candidates_.push_back(candidate_of(1e30F, scene::Bvh::kRoot | kNodeBit));
    std::size_t drawn = 0;
    while (!candidates_.empty() && drawn < kMostDrawn) {
        std::ranges::pop_heap(candidates_);
        const std::uint32_t place = ~static_cast<std::uint32_t>(candidates_.back());
        candidates_.pop_back();
        if ((place & kNodeBit) != 0) {
            const std::uint32_t node = place & ~kNodeBit;
            if (!buffer.hides(bvh_->nodes()[node].min, bvh_->nodes()[node].max)) offer_inside(query, node);
            continue;
        }
        const Item& item = items_[place];
        if (buffer.hides(item.min, item.max)) continue;
        const auto solid = usable(occluders_[item.index], camera, margin_m);
        if (!solid) continue;
        buffer.add(*solid, bounds_[item.index]);
        ++drawn;
    }
    return drawn;
}

}  // namespace lw
