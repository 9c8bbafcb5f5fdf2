#include "client_renderer/draw_list.h"

#include <algorithm>

namespace lw {

namespace {

PackedInstance packed(const glm::dmat4& world_from_object, const glm::dvec3& eye_world, ObjectId id) {
    glm::dmat4 relative_from_object = world_from_object;
    relative_from_object[3] -= glm::dvec4{eye_world, 0.0};
    PackedInstance instance;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            instance.relative_from_object_rows[row][column] = static_cast<float>(relative_from_object[column][row]);
        }
    }
    instance.object_id = id;
    return instance;
}

double distance_to_box_m(const glm::dvec3& place, const scene::Bounds& box) {
    return glm::distance(place, glm::clamp(place, box.min, box.max));
}

}  // namespace

DrawList::DrawList(const scene::Scene& scene, const scene::SceneState& state) : scene_{scene} {
    for (const scene::Instance& instance : scene.instances) placed_.push_back({&instance, {}, {}, false});
    std::ranges::stable_sort(placed_, {}, [](const PlacedInstance& placed) { return placed.instance->mesh; });

    first_of_mesh_.assign(scene.meshes.size() + 1, 0);
    for (std::size_t i = 0; i < placed_.size(); ++i) {
        place(placed_[i], state);
        ++first_of_mesh_[static_cast<std::size_t>(placed_[i].instance->mesh) + 1];
        if (placed_[i].instance->mover != 0) movers_.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) first_of_mesh_[mesh + 1] += first_of_mesh_[mesh];
    for (auto& zone : visible_) {
        for (auto& visible : zone) visible.resize(scene.meshes.size());
    }
}

void DrawList::place(PlacedInstance& placed, const scene::SceneState& state) const {
    const scene::Mesh& mesh = scene_.meshes[static_cast<std::size_t>(placed.instance->mesh)];
    placed.world_from_object = state.world_from_object(*placed.instance);
    placed.bounds_world = scene::transformed(mesh.bounds, placed.world_from_object);
    placed.mirrored = glm::determinant(glm::dmat3{placed.world_from_object}) < 0.0;
}

void DrawList::collect_visible(const Camera& camera, bool cull, std::span<const std::uint8_t> replaced) {
    const Frustum frustum = frustum_of(camera);
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    packed_.clear();
    for (std::size_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
        for (std::uint32_t i = first_of_mesh_[mesh]; i < first_of_mesh_[mesh + 1]; ++i) {
            const PlacedInstance& placed = placed_[i];
            if (!replaced.empty() &&
                replaced[static_cast<std::size_t>(placed.instance - scene_.instances.data())] != 0) {
                continue;
            }
            if (cull && !may_see(frustum, placed.bounds_world)) continue;
            const double distance_m = distance_to_box_m(eye_world, placed.bounds_world);
            const auto zone =
                static_cast<std::size_t>(std::ranges::upper_bound(kZoneEnds_m, distance_m) - kZoneEnds_m.begin());
            collected_[zone][placed.mirrored ? 1 : 0].push_back(
                packed(placed.world_from_object, eye_world, placed.instance->mover));
        }
        for (std::size_t zone = 0; zone < kZones; ++zone) {
            for (std::size_t mirrored = 0; mirrored < 2; ++mirrored) {
                std::vector<PackedInstance>& collected = collected_[zone][mirrored];
                visible_[zone][mirrored][mesh] = {static_cast<std::uint32_t>(packed_.size()),
                                                  static_cast<std::uint32_t>(collected.size())};
                packed_.insert(packed_.end(), collected.begin(), collected.end());
                collected.clear();
            }
        }
    }
}

void DrawList::build(const scene::SceneState& state, const Camera& camera,
                     std::span<const std::vector<MeshPart>> batches, bool cull,
                     std::span<const std::uint8_t> replaced) {
    for (const std::uint32_t mover : movers_) place(placed_[mover], state);
    collect_visible(camera, cull, replaced);

    commands_.clear();
    ranges_.clear();
    triangles_drawn_ = 0;
    for (std::size_t zone = 0; zone < kZones; ++zone) append_ranges(zone, batches);
}

void DrawList::append_ranges(std::size_t zone, std::span<const std::vector<MeshPart>> batches) {
    for (std::size_t batch = 0; batch < batches.size(); ++batch) {
        for (const bool mirrored : {false, true}) {
            DrawRange range{static_cast<int>(batch), mirrored, commands_.size(), 0};
            for (const MeshPart& part : batches[batch]) {
                const auto mesh = static_cast<std::size_t>(part.mesh);
                const VisibleRange& visible = visible_[zone][mirrored ? 1 : 0][mesh];
                if (visible.count == 0) continue;
                commands_.push_back(
                    {part.index_count, visible.count, part.first_index, part.base_vertex, visible.first});
                triangles_drawn_ += std::uint64_t{part.index_count / 3} * visible.count;
            }
            range.command_count = commands_.size() - range.first_command;
            if (range.command_count > 0) ranges_.push_back(range);
        }
    }
}

}  // namespace lw
