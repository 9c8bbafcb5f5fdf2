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

/// Of one instance.
struct ClusterTest {
    RelativePlacement relative_from_object;
    float eye_object[3];
    float margin_object;
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

/// Clusters whose triangles are all turned away from every eye within the margin.
HWY_INLINE MF turned_away(const float* cones, std::size_t stride, const ClusterTest& test) {
    const DF d;
    const auto row = [&](std::size_t which) HWY_ATTR { return hn::LoadU(d, cones + which * stride); };
    const VF x = hn::Sub(row(0), hn::Set(d, test.eye_object[0]));
    const VF y = hn::Sub(row(1), hn::Set(d, test.eye_object[1]));
    const VF z = hn::Sub(row(2), hn::Set(d, test.eye_object[2]));
    const VF margin = hn::Set(d, test.margin_object);
    const VF along = hn::Sub(hn::MulAdd(x, row(3), hn::MulAdd(y, row(4), hn::Mul(z, row(5)))), margin);
    const VF distance = hn::Add(hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)))), margin);
    const VF cutoff = row(6);
    return hn::And(hn::And(hn::Le(cutoff, hn::Set(d, 1.0F)), hn::Gt(along, hn::Zero(d))),
                   hn::Ge(along, hn::Mul(cutoff, distance)));
}

/// Clusters at least a pixel of the buffer large: smaller ones lie in the same pixels as their object, which was not
/// hidden, and there are many of them far away.
HWY_INLINE MF worth_a_test(const Projected& projected) {
    const DF d;
    const VF width = hn::Sub(hn::Load(d, projected.x1.data()), hn::Load(d, projected.x0.data()));
    const VF height = hn::Sub(hn::Load(d, projected.y1.data()), hn::Load(d, projected.y0.data()));
    return hn::Ge(hn::Max(width, height), hn::Set(d, 1.0F));
}

void test_here(const Clusters& clusters, const ClusterRange& range, const ClusterTest& test, std::uint8_t* drawn,
               ClusterCounters& counters) {
    const Clusters::View& view = clusters.view();
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
    for (std::uint32_t i = 0; i < range.count; i += lanes) {
        const std::uint32_t count = std::min(lanes, range.count - i);
        const std::uint32_t all = count == 32 ? ~0U : (1U << count) - 1U;
        std::uint32_t bits =
            all & ~bits_of(turned_away(clusters.cone_row(0) + range.first + i, clusters.cone_stride(), test));
        counters.turned_away += static_cast<std::uint64_t>(std::popcount(all & ~bits));
        const BoxVector relative = placed(load_boxes(clusters.boxes(), range.first + i), test.relative_from_object);
        const std::uint32_t inside =
            bits & bits_of(in_frustum(relative, view.frustum_relative, FloatFrustum::kAllPlanes));
        counters.outside += static_cast<std::uint64_t>(std::popcount(bits & ~inside));
        bits = inside;
        if (view.least_size_per_distance > 0.0F) {
            const std::uint32_t large = bits & bits_of(large_enough(relative, {}, view.least_size_per_distance));
            counters.too_small += static_cast<std::uint64_t>(std::popcount(bits & ~large));
            bits = large;
        }
        if (view.occlusion != nullptr && bits != 0) {
            Projected projected;
            project(relative, view.buffer_relative, projected);
            const std::uint32_t sampled = bits & bits_of(meets_sample(projected, view.buffer_relative));
            counters.between_samples += static_cast<std::uint64_t>(std::popcount(bits & ~sampled));
            bits = sampled;
            for (std::uint32_t rest = bits & bits_of(worth_a_test(projected)); rest != 0; rest &= rest - 1) {
                const auto at = static_cast<std::uint32_t>(std::countr_zero(rest));
                if (!is_hidden(*view.occlusion, lane(projected, at))) continue;
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

ClusterTest test_of(const glm::dmat4& world_from_object, const glm::dvec3& eye_world, double margin_m) {
    ClusterTest test{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            test.relative_from_object.linear[row][column] = static_cast<float>(world_from_object[column][row]);
        }
        test.relative_from_object.origin[row] = static_cast<float>(world_from_object[3][row] - eye_world[row]);
    }
    const glm::dmat3 inverse = glm::inverse(glm::dmat3{world_from_object});
    const glm::dvec3 eye_object = inverse * (eye_world - glm::dvec3{world_from_object[3]});
    // The margin in object space, as far as the inverse stretches it at most.
    double stretch = 0.0;
    for (int column = 0; column < 3; ++column) stretch += glm::dot(inverse[column], inverse[column]);
    for (int i = 0; i < 3; ++i) test.eye_object[i] = static_cast<float>(eye_object[i]);
    test.margin_object = static_cast<float>(margin_m * std::sqrt(stretch));
    return test;
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
    // A vector may begin at any cluster.
    constexpr std::size_t kMostLanes = 64;
    cone_stride_ = bounds_.size() + kMostLanes;
    cone_rows_.assign(7 * cone_stride_, 2.0F);
    for (std::size_t i = 0; i < cones_.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<glm::length_t>(axis);
            cone_rows_[axis * cone_stride_ + i] = cones_[i].apex_object[a];
            cone_rows_[(3 + axis) * cone_stride_ + i] = cones_[i].axis_object[a];
        }
        cone_rows_[6 * cone_stride_ + i] = cones_[i].cutoff;
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
    if (view.occlusion == nullptr) return;
    view_.buffer_relative = view.occlusion->view();
    view_.buffer_relative.eye_world = {};
}

void Clusters::append_runs(const ClusterRange& range, const glm::dmat4& world_from_object,
                           std::vector<IndexRun>& runs) {
    drawn_.resize(std::max<std::size_t>(drawn_.size(), range.count));
    counters_.tested += range.count;
    const ClusterTest test = test_of(world_from_object, eye_world_, reveal_margin_m_);
    HWY_DYNAMIC_DISPATCH(test_here)(*this, range, test, drawn_.data(), counters_);
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
