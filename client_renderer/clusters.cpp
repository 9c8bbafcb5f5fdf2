#include "client_renderer/clusters.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/clusters.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "client_renderer/cluster_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

template <typename Test>
HWY_INLINE void test_all(Test test, const Clusters& clusters, const ClusterRange& range, std::uint64_t* shown) {
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
    for (std::uint32_t i = 0; i < range.count; i += lanes) {
        const std::size_t first = range.first + i;
        const std::uint32_t bits =
            test.seen(clusters.block(first), first % BoxBlock::kBoxes, lowest_bits(std::min(lanes, range.count - i)));
        shown[i / 64] |= std::uint64_t{bits} << (i % 64);
    }
}

/// @param shown  one bit per cluster; zeros come in
void test_here(const Clusters& clusters, const ClusterRange& range, const ClusterPlacement& placement,
               std::uint64_t* shown, ClusterCounters& counters) {
    const ProjectingRows rows = rows_of(range, placement);
    const InstanceRect rect{range, rows, clusters.view().buffer_relative.near_m};
    const SmallPlacement small{clusters.view(), range, placement, rows, rect};
    if (small.applies()) {
        test_all(SmallInstanceTest{small, counters}, clusters, range, shown);
    } else {
        test_all(InstanceTest{clusters, placement, rows, counters}, clusters, range, shown);
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(test_here);

namespace {

// Triangles seen nearly edge-on may come out either way when GL snaps their corners to 1/256 of a pixel. A cone's
// triangles must be turned away by this much more, as the sine of an angle of 6 degrees: then a triangle would have to
// be smaller than a thirtieth of a pixel to flip, and so fall between the samples.
constexpr float kEdgeOn = 0.1F;
// Skipping fewer triangles than this between two runs costs more, as one more draw, than it saves: a draw takes about
// as long as 30 triangles.
constexpr std::uint32_t kWorthADraw = 3 * 32;

}  // namespace

ClusterCounters& ClusterCounters::operator+=(const ClusterCounters& other) {
    tested += other.tested;
    outside += other.outside;
    turned_away += other.turned_away;
    occluded += other.occluded;
    too_small += other.too_small;
    between_samples += other.between_samples;
    return *this;
}

void ClusterRange::include(const scene::Bounds& cluster) {
    least_object = glm::min(least_object, glm::vec3{cluster.min});
    most_object = glm::max(most_object, glm::vec3{cluster.max});
    largest_half_object = glm::max(largest_half_object, glm::vec3{cluster.half_size()});
}

void ClusterRange::include(const ClusterRange& other) {
    least_object = glm::min(least_object, other.least_object);
    most_object = glm::max(most_object, other.most_object);
    largest_half_object = glm::max(largest_half_object, other.largest_half_object);
}

ClusterRange Clusters::add(std::span<const scene::Vertex> vertices, std::span<std::uint32_t> indices,
                           bool double_sided) {
    ClusterRange range{static_cast<std::uint32_t>(bounds_.size()), 0};
    if (indices.size() / 3 < kSmallestPart) return range;
    const float* positions = &vertices.front().position_object.x;
    std::vector<meshopt_Meshlet> meshlets(meshopt_buildMeshletsBound(indices.size(), kMostVertices, kMostTriangles));
    std::vector<unsigned> meshlet_vertices(meshlets.size() * kMostVertices);
    std::vector<unsigned char> meshlet_triangles(meshlets.size() * kMostTriangles * 3);
    constexpr float kConeWeight = 0.5F;
    meshlets.resize(meshopt_buildMeshlets(meshlets.data(), meshlet_vertices.data(), meshlet_triangles.data(),
                                          indices.data(), indices.size(), positions, vertices.size(),
                                          sizeof(scene::Vertex), kMostVertices, kMostTriangles, kConeWeight));
    std::size_t next = 0;
    for (const meshopt_Meshlet& meshlet : meshlets) {
        const meshopt_Bounds cut = meshopt_computeMeshletBounds(
            &meshlet_vertices[meshlet.vertex_offset], &meshlet_triangles[meshlet.triangle_offset],
            meshlet.triangle_count, positions, vertices.size(), sizeof(scene::Vertex));
        Cone cone{{cut.cone_apex[0], cut.cone_apex[1], cut.cone_apex[2]},
                  {cut.cone_axis[0], cut.cone_axis[1], cut.cone_axis[2]},
                  cut.cone_cutoff + kEdgeOn};
        if (double_sided || !(glm::length(cone.axis_object) > 0.5F)) cone.cutoff = 2.0F;
        cones_.push_back(cone);
        scene::Bounds bounds;
        for (std::size_t i = 0; i < 3 * std::size_t{meshlet.triangle_count}; ++i) {
            const unsigned vertex =
                meshlet_vertices[meshlet.vertex_offset + meshlet_triangles[meshlet.triangle_offset + i]];
            indices[next++] = vertex;
            bounds.include(glm::dvec3{vertices[vertex].position_object});
        }
        range.include(bounds);
        bounds_.push_back(bounds);
        end_indices_.push_back(static_cast<std::uint32_t>(next));
    }
    range.count = static_cast<std::uint32_t>(meshlets.size());
    return range;
}

void Clusters::begin_mesh() {
    while (bounds_.size() % BoxBlock::kBoxes != 0) {
        bounds_.emplace_back();
        cones_.emplace_back();
        end_indices_.push_back(0);
    }
}

void Clusters::finish() {
    blocks_.resize((bounds_.size() + BoxBlock::kBoxes - 1) / BoxBlock::kBoxes);
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
        Block& block = blocks_[i / BoxBlock::kBoxes];
        const std::size_t at = i % BoxBlock::kBoxes;
        block.boxes_object.set(at, bounds_[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<glm::length_t>(axis);
            block.cones[axis][at] = cones_[i].axis_object[a];
            block.cones[4 + axis][at] = cones_[i].apex_object[a];
        }
        block.cones[3][at] = cones_[i].cutoff;
    }
}

void Clusters::begin(const ClusterView& view) {
    eye_world_ = view.eye_world;
    reveal_margin_m_ = view.reveal_margin_m;
    Frustum relative = view.frustum_world;
    for (glm::dvec4& plane : relative.planes) plane.w += glm::dot(glm::dvec3{plane}, view.eye_world);
    view_.frustum_relative = rounded(relative);
    view_.occlusion = view.occlusion;
    view_.least_size_per_distance = static_cast<float>(view.least_size_per_distance);
    view_.buffer_relative = view.buffer_view;
    view_.buffer_relative.eye_world = {};
}

ClusterPlacement Clusters::placement(const glm::dmat4& world_from_object) const {
    ClusterPlacement placement;
    const glm::dmat3 linear{world_from_object};
    const glm::dvec3 origin = glm::dvec3{world_from_object[3]} - eye_world_;
    const glm::dmat3 rows = glm::transpose(linear);
    const OcclusionBuffer::View& buffer = view_.buffer_relative;
    const std::array<const std::array<float, 3>*, 3> buffer_rows{&buffer.x_px, &buffer.y_px, &buffer.distance};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<glm::length_t>(i);
        placement.relative_from_object_rows[i] = glm::vec4{glm::dvec4{rows[axis], origin[axis]}};
        const glm::dvec3 row{(*buffer_rows[i])[0], (*buffer_rows[i])[1], (*buffer_rows[i])[2]};
        placement.buffer_from_object_rows[i] = glm::vec4{glm::dvec4{row * linear, glm::dot(row, origin)}};
    }
    const glm::dmat3 inverse = glm::inverse(linear);
    placement.eye_object = glm::vec3{inverse * -origin};
    // The margin in object space, as far as the inverse stretches it at most.
    double stretch = 0.0;
    for (int column = 0; column < 3; ++column) stretch += glm::dot(inverse[column], inverse[column]);
    placement.margin_object = static_cast<float>(reveal_margin_m_ * std::sqrt(stretch));
    return placement;
}

void Clusters::test(const ClusterRange& range, const glm::dmat4& world_from_object, std::span<std::uint64_t> shown,
                    ClusterCounters& counters) const {
    counters.tested += range.count;
    HWY_DYNAMIC_DISPATCH(test_here)(*this, range, placement(world_from_object), shown.data(), counters);
}

void Clusters::append_runs(const ClusterRange& part, std::span<const std::uint64_t> shown, std::size_t first_bit,
                           std::vector<IndexRun>& runs) const {
    const std::size_t first_new = runs.size();
    for (std::uint32_t i = 0; i < part.count;) {
        // The next up to 64 bits, from i on.
        const std::size_t at = first_bit + i;
        const std::uint64_t bits = shown[at / 64] >> (at % 64);
        const auto left = static_cast<std::uint32_t>(64 - at % 64);
        if (bits == 0) {
            i += left;
            continue;
        }
        const std::uint32_t first = i + static_cast<std::uint32_t>(std::countr_zero(bits));
        if (first >= part.count) break;
        const auto length = static_cast<std::uint32_t>(std::countr_one(bits >> (first - i)));
        i = std::min(first + length, part.count);
        const std::uint32_t begin = first == 0 ? 0 : end_indices_[part.first + first - 1];
        const std::uint32_t end = end_indices_[part.first + i - 1];
        if (runs.size() > first_new && begin - (runs.back().first + runs.back().count) < kWorthADraw) {
            runs.back().count = end - runs.back().first;
        } else {
            runs.push_back({begin, end - begin});
        }
    }
}

}  // namespace lw
#endif
