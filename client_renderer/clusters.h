#pragma once
/// Meshes cut into clusters of about a hundred triangles that are skipped one by one: out of view, hidden, or turned
/// away.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/box_block.h"
#include "client_renderer/frustum.h"
#include "client_renderer/occlusion_buffer.h"
#include "scene/scene.h"

namespace lw {

/// Clusters of a part of a mesh, or of all of its parts: a range of Clusters.
struct ClusterRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    // Around all of them, and the largest half size on each axis.
    glm::vec3 least_object{1e30F};
    glm::vec3 most_object{-1e30F};
    glm::vec3 largest_half_object{0.0F};

    void include(const scene::Bounds& cluster);
    void include(const ClusterRange& other);
    /// No coordinate is larger, on each axis.
    [[nodiscard]] glm::vec3 reach_object() const { return glm::max(glm::abs(least_object), glm::abs(most_object)); }
};

/// Neighbouring clusters of a part that are drawn: a range of the part's indices, counted from its first.
struct IndexRun {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

/// What became of clusters.
struct ClusterCounters {
    std::uint64_t tested = 0;
    std::uint64_t outside = 0;
    std::uint64_t turned_away = 0;
    std::uint64_t occluded = 0;
    std::uint64_t too_small = 0;
    std::uint64_t between_samples = 0;

    ClusterCounters& operator+=(const ClusterCounters& other);
};

/// What is known of a view when clusters are tested.
struct ClusterView {
    Frustum frustum_world;
    glm::dvec3 eye_world{0.0};
    double reveal_margin_m = 0.0;
    OcclusionBuffer::View buffer_view;           ///< where things lie in the picture
    const OcclusionBuffer* occlusion = nullptr;  ///< null: nothing is hidden
    double least_size_per_distance = 0.0;        ///< clusters that look smaller are left out, as WalkQuery says
};

/// An instance as a view sees it.
struct ClusterPlacement {
    std::array<glm::vec4, 3> relative_from_object_rows;  ///< origin in the eye, axes of the world
    std::array<glm::vec4, 3> buffer_from_object_rows;    ///< x_px * distance, y_px * distance, distance
    glm::vec3 eye_object{0.0F};
    float margin_object = 0.0F;
};

/// One thread at a time, but for what says otherwise.
class Clusters {
public:
    static constexpr std::size_t kMostVertices = 64;
    static constexpr std::size_t kMostTriangles = 96;  ///< a multiple of four, as the cutting asks
    /// Parts of fewer triangles stay whole: they would be a single cluster or two.
    static constexpr std::size_t kSmallestPart = 2 * kMostTriangles;

    /// Before the parts of a mesh.
    void begin_mesh();

    /// Cuts a part and puts its indices in the order of its clusters; the triangles stay the same. A part too small is
    /// left as it is, with an empty range.
    /// @param indices      triangles, into `vertices`; every index is valid
    /// @param double_sided  its clusters are never turned away
    ClusterRange add(std::span<const scene::Vertex> vertices, std::span<std::uint32_t> indices, bool double_sided);

    /// Ends adding.
    void finish();

    /// Before the tests of a view; what the view points to outlives them.
    void begin(const ClusterView& view);

    /// Sets one bit for each cluster of the range that an instance shows, first lowest. It may keep what is not seen,
    /// never leave out what is. Any thread.
    /// @param shown     words_for() the range, zeros
    /// @param counters  grow by what became of the clusters
    void test(const ClusterRange& range, const glm::dmat4& world_from_object, std::span<std::uint64_t> shown,
              ClusterCounters& counters) const;

    /// Words that hold one bit per cluster.
    [[nodiscard]] static std::size_t words_for(const ClusterRange& range) { return (range.count + 63) / 64; }

    /// Appends the runs of a part.
    /// @param shown      bits of test() for a range that holds the part's
    /// @param first_bit  of the part's clusters
    void append_runs(const ClusterRange& part, std::span<const std::uint64_t> shown, std::size_t first_bit,
                     std::vector<IndexRun>& runs) const;

    /// By cluster: all of its triangles are turned away from an eye when dot(axis, apex - eye) >= cutoff *
    /// |apex - eye|. A cutoff above 1: never.
    struct Cone {
        glm::vec3 apex_object{0.0F};
        glm::vec3 axis_object{0.0F};
        float cutoff = 2.0F;
    };
    [[nodiscard]] const std::vector<Cone>& cones() const { return cones_; }

    /// Sixteen clusters next to each other, in cache lines that follow each other; a mesh begins with one.
    struct Block {
        BoxBlock boxes_object;
        std::array<std::array<float, BoxBlock::kBoxes>, 7> cones{};  ///< axis x y z, cutoff, apex x y z
    };
    [[nodiscard]] const Block& block(std::size_t cluster) const { return blocks_[cluster / BoxBlock::kBoxes]; }

    /// A view in single precision, relative to its eye.
    struct View {
        FloatFrustum frustum_relative;
        OcclusionBuffer::View buffer_relative;
        const OcclusionBuffer* occlusion = nullptr;
        float least_size_per_distance = 0.0F;
    };
    [[nodiscard]] const View& view() const { return view_; }

private:
    [[nodiscard]] ClusterPlacement placement(const glm::dmat4& world_from_object) const;

    std::vector<scene::Bounds> bounds_;       ///< object space
    std::vector<Cone> cones_;                 ///< the same clusters
    std::vector<std::uint32_t> end_indices_;  ///< of each cluster in its part, where the next one begins
    std::vector<Block> blocks_;
    View view_;
    glm::dvec3 eye_world_{0.0};
    double reveal_margin_m_ = 0.0;
};

}  // namespace lw
