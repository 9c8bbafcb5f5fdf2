#pragma once
/// The draws that show a camera's visible instances: one indirect command per visible mesh part, however many instances
/// it has. No GL here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "client_renderer/clusters.h"
#include "client_renderer/draw_order.h"
#include "client_renderer/packed_vertex.h"
#include "client_renderer/placed_instances.h"
#include "core/camera.h"
#include "core/task_pool.h"
#include "scene/scene.h"

namespace lw {

/// A part of a mesh with one material, where it lies in the shared buffers.
struct MeshPart {
    int mesh = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_index = 0;
    std::int32_t base_vertex = 0;
    ClusterRange clusters;  ///< empty: the part is drawn as a whole
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

/// How parts that have clusters are drawn.
struct ClusterUse {
    Clusters* clusters = nullptr;  ///< null: as a whole
    ClusterView view;
    TaskPool* threads = nullptr;  ///< that share the tests; null: the caller's alone
};

/// Keeps its memory between frames. One thread at a time.
class DrawList {
public:
    /// `placed` outlives the list.
    explicit DrawList(const PlacedInstances& placed, DrawOrder order = {});

    /// Fills the list with the instances `visible` (indices into the placed ones, ascending), as seen by `camera`.
    /// `batches[b]` are the parts drawn with the state of batch b. Leaving an instance out does not change the order of
    /// the others, nor does leaving out clusters. Any number of threads gives the same list. Transforms are composed in
    /// double relative to the eye and rounded to float once.
    void build(std::span<const std::uint32_t> visible, const Camera& camera,
               std::span<const std::vector<MeshPart>> batches, const ClusterUse& clusters = {});

    [[nodiscard]] const std::vector<PackedInstance>& instances() const { return packed_; }
    [[nodiscard]] const std::vector<DrawCommand>& commands() const { return commands_; }
    [[nodiscard]] const std::vector<DrawRange>& ranges() const { return ranges_; }
    /// Not grouped: the states of the draws as they came to the sorting buffer.
    [[nodiscard]] const std::vector<std::uint32_t>& arriving_states() const { return states_; }
    [[nodiscard]] std::uint64_t objects_drawn() const { return packed_.size(); }
    [[nodiscard]] std::uint64_t triangles_drawn() const { return triangles_drawn_; }
    /// Of the last build().
    [[nodiscard]] const ClusterCounters& cluster_counters() const { return cluster_counters_; }

private:
    struct VisibleRange {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    // An instance whose clusters are tested.
    struct ClusterTest {
        std::uint32_t placed = 0;      ///< index into placed_
        std::uint32_t first_word = 0;  ///< in shown_
    };
    // Tests of one thread.
    struct TestRun {
        std::size_t first = 0;  ///< of tests_
        std::size_t end = 0;
        ClusterCounters counters;
    };

    void collect(std::span<const std::uint32_t> visible, const Camera& camera, bool by_clusters);
    void end_mesh(std::size_t mesh, const glm::dvec3& eye_world, bool by_clusters);
    void test_clusters(const ClusterUse& clusters);
    void test_run(const Clusters& clusters, TestRun& run);
    void find_clusters_of_meshes(std::span<const std::vector<MeshPart>> batches);
    void append_ranges(std::size_t zone, std::span<const std::vector<MeshPart>> batches, const ClusterUse& clusters);
    void append_part(const MeshPart& part, const VisibleRange& visible, const ClusterUse& clusters);
    void append_by_distance(const Camera& camera, std::span<const std::vector<MeshPart>> batches,
                            const ClusterUse& clusters);
    void pass_through_buffer();

    const PlacedInstances& placed_;
    DrawOrder order_;
    /// Instances are drawn by distance from the eye, in zones that end at these metres and a last one that does not
    /// end. Nearer zones first saves an eighth of the processor time of the start view of the city.
    static constexpr std::array kZoneEnds_m{12.0, 30.0, 75.0};
    static constexpr std::size_t kZones = kZoneEnds_m.size() + 1;
    std::array<std::array<std::vector<VisibleRange>, 2>, kZones> visible_;  ///< by mesh; [1] the mirrored ones
    std::vector<PackedInstance> packed_;
    std::vector<std::uint32_t> placed_of_packed_;  ///< indices into placed_
    std::vector<std::uint32_t> shown_of_packed_;   ///< first words of shown_, where a mesh has clusters
    std::vector<std::uint64_t> shown_;             ///< clusters, one bit each
    std::size_t words_ = 0;                        ///< of shown_, of what is collected
    std::vector<ClusterTest> tests_;
    std::vector<TestRun> test_runs_;
    const Clusters* tested_ = nullptr;
    ClusterCounters cluster_counters_;
    std::vector<ClusterRange> clusters_of_meshes_;
    std::array<std::array<std::vector<std::uint32_t>, 2>, kZones> collected_;  ///< of the mesh being collected
    std::vector<IndexRun> runs_;
    std::vector<DrawCommand> commands_;
    std::vector<DrawRange> ranges_;
    std::vector<std::vector<std::pair<std::uint32_t, MeshPart>>> parts_of_meshes_;  ///< with their batches
    std::vector<std::uint32_t> states_;  ///< of commands that are not grouped: 2 * batch + mirrored
    std::vector<DrawCommand> arrived_;
    std::vector<std::pair<double, std::uint32_t>> by_distance_;  ///< indices into packed_
    std::uint64_t triangles_drawn_ = 0;
    // Kept, because making a function object may allocate.
    TaskPool::Work test_run_ = [this](int run, int /*worker*/) {
        test_run(*tested_, test_runs_[static_cast<std::size_t>(run)]);
    };
};

}  // namespace lw
