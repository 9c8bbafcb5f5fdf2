#pragma once
/// Which instances a camera sees, and the draws that show them: one indirect command per visible mesh part, however
/// many instances it has. No GL here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/frustum.h"
#include "client_renderer/packed_vertex.h"
#include "core/camera.h"
#include "scene/scene.h"

namespace lw {

/// A part of a mesh with one material, where it lies in the shared buffers.
struct MeshPart {
    int mesh = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_index = 0;
    std::int32_t base_vertex = 0;
};

/// As glMultiDrawElementsIndirect reads it.
struct DrawCommand {
    std::uint32_t index_count = 0;
    std::uint32_t instance_count = 0;
    std::uint32_t first_index = 0;
    std::int32_t base_vertex = 0;
    std::uint32_t base_instance = 0;
};
static_assert(sizeof(DrawCommand) == 20);

/// Commands that need the same state and lie in the same range of distances: a range of DrawList::commands(). Nearer
/// ranges come first: what they hide need not be shaded.
struct DrawRange {
    int batch = 0;          ///< index into the parts given to build()
    bool mirrored = false;  ///< fronts are clockwise: the instances' transforms turn the mesh inside out
    std::size_t first_command = 0;
    std::size_t command_count = 0;
};

/// Keeps its memory between frames. One thread at a time.
class DrawList {
public:
    /// `scene` is finished and outlives the list; `state` is at any time.
    DrawList(const scene::Scene& scene, const scene::SceneState& state);

    /// Fills the list for `camera`. `state` is at the time to draw: movers are placed anew, static instances keep their
    /// boxes. `batches[b]` are the parts drawn with the state of batch b. With `cull` false everything is drawn.
    /// Instances i of the scene with `replaced[i]` set are left out; an empty span leaves out none.
    /// Transforms are composed in double relative to the eye and rounded to float once.
    void build(const scene::SceneState& state, const Camera& camera, std::span<const std::vector<MeshPart>> batches,
               bool cull, std::span<const std::uint8_t> replaced = {});

    [[nodiscard]] const std::vector<PackedInstance>& instances() const { return packed_; }
    [[nodiscard]] const std::vector<DrawCommand>& commands() const { return commands_; }
    [[nodiscard]] const std::vector<DrawRange>& ranges() const { return ranges_; }
    [[nodiscard]] std::uint64_t objects_tested() const { return placed_.size(); }
    [[nodiscard]] std::uint64_t objects_drawn() const { return packed_.size(); }
    [[nodiscard]] std::uint64_t triangles_drawn() const { return triangles_drawn_; }

private:
    struct PlacedInstance {
        const scene::Instance* instance = nullptr;
        glm::dmat4 world_from_object{1.0};
        scene::Bounds bounds_world;
        bool mirrored = false;
    };
    struct VisibleRange {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    void place(PlacedInstance& placed, const scene::SceneState& state) const;
    void collect_visible(const Camera& camera, bool cull, std::span<const std::uint8_t> replaced);
    void append_ranges(std::size_t zone, std::span<const std::vector<MeshPart>> batches);

    const scene::Scene& scene_;
    std::vector<PlacedInstance> placed_;        ///< by mesh
    std::vector<std::uint32_t> first_of_mesh_;  ///< into placed_, one more than there are meshes
    std::vector<std::uint32_t> movers_;         ///< into placed_
    /// Instances are drawn by distance from the eye, in zones that end at these metres and a last one that does not
    /// end. Nearer zones first saves an eighth of the processor time of the start view of the city.
    static constexpr std::array kZoneEnds_m{12.0, 30.0, 75.0};
    static constexpr std::size_t kZones = kZoneEnds_m.size() + 1;
    std::array<std::array<std::vector<VisibleRange>, 2>, kZones> visible_;  ///< by mesh; [1] the mirrored ones
    std::vector<PackedInstance> packed_;
    std::array<std::array<std::vector<PackedInstance>, 2>, kZones> collected_;  ///< of the mesh being collected
    std::vector<DrawCommand> commands_;
    std::vector<DrawRange> ranges_;
    std::uint64_t triangles_drawn_ = 0;
};

}  // namespace lw
