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

#include "client_renderer/box_kernels.h"

#ifndef LW_CLUSTERS_ONCE
#define LW_CLUSTERS_ONCE
namespace lw {

/// The placement of an instance, in single precision relative to the eye: positions keep their digits however far the
/// eye is from the world's origin.
struct RelativePlacement {
    float linear[3][3];  ///< rows
    float origin[3];
};

struct ClusterTest {
    RelativePlacement relative_from_object;
    FloatFrustum frustum_relative;
    OcclusionBuffer::View view_relative;
    const OcclusionBuffer* occlusion;
    float least_size_per_distance;
};

}  // namespace lw
#endif

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

/// Boxes around the placed boxes.
HWY_INLINE BoxVector placed(const BoxVector& object, const RelativePlacement& placement) {
    const DF d;
    const std::array<VF, 3> centre{object.centre_x, object.centre_y, object.centre_z};
    const std::array<VF, 3> half{object.half_x, object.half_y, object.half_z};
    std::array<VF, 3> to{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    std::array<VF, 3> reach{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t row = 0; row < 3; ++row) {
        to[row] = hn::Set(d, placement.origin[row]);
        VF size = hn::Set(d, std::abs(placement.origin[row]));
        for (std::size_t k = 0; k < 3; ++k) {
            const VF m = hn::Set(d, placement.linear[row][k]);
            to[row] = hn::MulAdd(m, centre[k], to[row]);
            size = hn::MulAdd(hn::Abs(m), hn::Abs(centre[k]), size);
            reach[row] = hn::MulAdd(hn::Abs(m), half[k], reach[row]);
        }
        // Rounding of this sum and of the part's vertices on their own way through single precision.
        reach[row] = hn::MulAdd(hn::Add(size, reach[row]), hn::Set(d, 1e-6F), reach[row]);
    }
    return {to[0], to[1], to[2], reach[0], reach[1], reach[2]};
}

void test_here(const BoxList& boxes, const ClusterRange& range, const ClusterTest& test, std::uint8_t* drawn,
               ClusterCounters& counters) {
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
    for (std::uint32_t i = 0; i < range.count; i += lanes) {
        const std::uint32_t count = std::min(lanes, range.count - i);
        std::uint32_t wanted = 0;
        for (std::uint32_t k = 0; k < count; ++k) wanted |= std::uint32_t{drawn[i + k]} << k;
        if (wanted == 0) continue;
        const BoxVector relative = placed(load_boxes(boxes, range.first + i), test.relative_from_object);
        std::uint32_t bits = wanted & bits_of(in_frustum(relative, test.frustum_relative, FloatFrustum::kAllPlanes));
        counters.outside += static_cast<std::uint64_t>(std::popcount(wanted & ~bits));
        if (test.least_size_per_distance > 0.0F) {
            const std::uint32_t large = bits & bits_of(large_enough(relative, {}, test.least_size_per_distance));
            counters.too_small += static_cast<std::uint64_t>(std::popcount(bits & ~large));
            bits = large;
        }
        if (test.occlusion != nullptr && bits != 0) {
            Projected projected;
            project(relative, test.view_relative, projected);
            const std::uint32_t sampled = bits & bits_of(meets_sample(projected, test.view_relative));
            counters.between_samples += static_cast<std::uint64_t>(std::popcount(bits & ~sampled));
            bits = sampled;
            for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
                const auto at = static_cast<std::uint32_t>(std::countr_zero(rest));
                if (!is_hidden(*test.occlusion, lane(projected, at))) continue;
                bits &= ~(1U << at);
                ++counters.occluded;
            }
        }
        for (std::uint32_t k = 0; k < count; ++k) drawn[i + k] = static_cast<std::uint8_t>(bits >> k & 1U);
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

ClusterTest test_of(const glm::dmat4& world_from_object, const ClusterView& view) {
    ClusterTest test{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            test.relative_from_object.linear[row][column] = static_cast<float>(world_from_object[column][row]);
        }
        test.relative_from_object.origin[row] = static_cast<float>(world_from_object[3][row] - view.eye_world[row]);
    }
    Frustum relative = view.frustum_world;
    for (glm::dvec4& plane : relative.planes) plane.w += glm::dot(glm::dvec3{plane}, view.eye_world);
    test.frustum_relative = rounded(relative);
    test.occlusion = view.occlusion;
    test.least_size_per_distance = static_cast<float>(view.least_size_per_distance);
    if (view.occlusion != nullptr) {
        test.view_relative = view.occlusion->view();
        test.view_relative.eye_world = {};
    }
    return test;
}

/// Of the cone's triangles, for every eye within `margin` of `eye`, object space.
bool is_turned_away(const Clusters::Cone& cone, const glm::dvec3& eye, double margin) {
    if (cone.cutoff > 1.0F) return false;
    const glm::dvec3 to_apex = glm::dvec3{cone.apex_object} - eye;
    const double along = glm::dot(to_apex, glm::dvec3{cone.axis_object}) - margin;
    return along > 0.0 && along >= cone.cutoff * (glm::length(to_apex) + margin);
}

}  // namespace

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
        first_indices_.push_back(static_cast<std::uint32_t>(next));
        index_counts_.push_back(3 * meshlet.triangle_count);
        scene::Bounds bounds;
        for (std::size_t i = 0; i < 3 * std::size_t{meshlet.triangle_count}; ++i) {
            const unsigned vertex =
                meshlet_vertices[meshlet.vertex_offset + meshlet_triangles[meshlet.triangle_offset + i]];
            indices[next++] = vertex;
            bounds.include(glm::dvec3{vertices[vertex].position_object});
        }
        bounds_.push_back(bounds);
    }
    range.count = static_cast<std::uint32_t>(meshlets.size());
    return range;
}

void Clusters::finish() {
    boxes_.resize(bounds_.size());
    for (std::size_t i = 0; i < bounds_.size(); ++i) boxes_.set(i, bounds_[i]);
}

void Clusters::append_runs(const ClusterRange& range, const glm::dmat4& world_from_object, const ClusterView& view,
                           std::vector<IndexRun>& runs) {
    drawn_.assign(range.count, 1);
    counters_.tested += range.count;
    const glm::dmat3 linear{world_from_object};
    const glm::dmat3 inverse = glm::inverse(linear);
    const glm::dvec3 eye_object = inverse * (view.eye_world - glm::dvec3{world_from_object[3]});
    // The margin in object space, as far as the inverse stretches it at most.
    double stretch = 0.0;
    for (int column = 0; column < 3; ++column) stretch += glm::dot(inverse[column], inverse[column]);
    const double margin_object = view.reveal_margin_m * std::sqrt(stretch);
    for (std::uint32_t i = 0; i < range.count; ++i) {
        if (!is_turned_away(cones_[range.first + i], eye_object, margin_object)) continue;
        drawn_[i] = 0;
        ++counters_.turned_away;
    }
    HWY_DYNAMIC_DISPATCH(test_here)(boxes_, range, test_of(world_from_object, view), drawn_.data(), counters_);
    const std::size_t first_new = runs.size();
    for (std::uint32_t i = 0; i < range.count; ++i) {
        if (drawn_[i] == 0) continue;
        const std::uint32_t begin = first_indices_[range.first + i];
        const std::uint32_t count = index_counts_[range.first + i];
        if (runs.size() > first_new) {
            IndexRun& last = runs.back();
            if (begin - (last.first + last.count) < kWorthADraw) {
                last.count = begin + count - last.first;
                continue;
            }
        }
        runs.push_back({begin, count});
    }
}

}  // namespace lw
#endif
