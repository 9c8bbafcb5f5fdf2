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

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

/// Places in single precision: the sums and products here, and the vertices' own way through the vertex shader.
constexpr float kPlacingRounding = 1e-6F;

/// Boxes around the placed boxes.
BoxVector placed(const BoxVector& object, const std::array<glm::vec4, 3>& rows) {
    const DF d;
    const Vector3 centre{object.centre_x, object.centre_y, object.centre_z};
    const Vector3 half{object.half_x, object.half_y, object.half_z};
    Vector3 to{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    Vector3 reach{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t row = 0; row < 3; ++row) {
        const glm::vec4& m = rows[row];
        to[row] = hn::Add(dot(&m.x, centre), hn::Set(d, m.w));
        VF size = hn::Set(d, std::abs(m.w));
        for (std::size_t k = 0; k < 3; ++k) {
            const VF magnitude = hn::Set(d, std::abs(m[static_cast<glm::length_t>(k)]));
            size = hn::MulAdd(magnitude, hn::Abs(centre[k]), size);
            reach[row] = hn::MulAdd(magnitude, half[k], reach[row]);
        }
        // Rounding of this sum and of the part's vertices on their own way through single precision.
        reach[row] = hn::MulAdd(hn::Add(size, reach[row]), hn::Set(d, kPlacingRounding), reach[row]);
    }
    return {to[0], to[1], to[2], reach[0], reach[1], reach[2]};
}

ProjectingRows rows_of(const ClusterRange& range, const ClusterPlacement& placement) {
    ProjectingRows rows;
    std::array<std::array<float, 4>*, 3> to{&rows.x_px, &rows.y_px, &rows.distance};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& row = placement.buffer_from_object_rows[i];
        *to[i] = {row.x, row.y, row.z, row.w};
        rows.rounding[i] =
            kPlacingRounding * (glm::dot(glm::abs(glm::vec3{row}), range.reach_object) + std::abs(row.w));
    }
    return rows;
}

/// Clusters whose triangles are all turned away from every eye within the margin.
HWY_INLINE MF turned_away(const float* cones, std::size_t stride, const ClusterPlacement& placement) {
    const DF d;
    const auto row = [&](std::size_t which) HWY_ATTR { return hn::LoadU(d, cones + which * stride); };
    const VF x = hn::Sub(row(0), hn::Set(d, placement.eye_object.x));
    const VF y = hn::Sub(row(1), hn::Set(d, placement.eye_object.y));
    const VF z = hn::Sub(row(2), hn::Set(d, placement.eye_object.z));
    const VF margin = hn::Set(d, placement.margin_object);
    const VF cutoff = row(6);
    // along - margin >= cutoff * (distance + margin), without the root.
    const VF along = hn::MulAdd(x, row(3), hn::MulAdd(y, row(4), hn::Mul(z, row(5))));
    const VF beyond = hn::Sub(along, hn::MulAdd(cutoff, margin, margin));
    const VF distance_2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    return hn::And(hn::And(hn::Le(cutoff, hn::Set(d, 1.0F)), hn::Gt(beyond, hn::Zero(d))),
                   hn::Ge(hn::Mul(beyond, beyond), hn::Mul(hn::Mul(cutoff, cutoff), distance_2)));
}

/// Clusters at least two pixels of the buffer large: smaller ones lie in the same pixels as their object, which was not
/// hidden, and there are many of them far away. (In the town of 20,000 buildings one pixel would take a quarter of a
/// millisecond more, and leave 2 % of the triangles out.)
HWY_INLINE MF worth_a_test(const Projected& projected) {
    const DF d;
    const VF width = hn::Sub(projected.x1, projected.x0);
    const VF height = hn::Sub(projected.y1, projected.y0);
    return hn::Ge(hn::Max(width, height), hn::Set(d, 2.0F));
}

/// One instance against the view.
class InstanceTest {
public:
    InstanceTest(const Clusters& clusters, const ClusterRange& range, const ClusterPlacement& placement,
                 ClusterCounters& counters)
        : clusters_{clusters},
          view_{clusters.view()},
          placement_{placement},
          rows_{rows_of(range, placement)},
          counters_{counters} {}

    /// Bits of the clusters from `first` on that may be seen.
    /// @param all  bits of those that there are
    HWY_INLINE std::uint32_t seen(std::size_t first, std::uint32_t all) {
        const BoxVector boxes = load_boxes(clusters_.boxes(), first);
        const Vector3 centre{boxes.centre_x, boxes.centre_y, boxes.centre_z};
        const Vector3 half{boxes.half_x, boxes.half_y, boxes.half_z};
        Projected projected;
        std::uint32_t bits = all;
        const MF far = project_from_afar(centre, half, rows_, view_.buffer_relative.near_m, projected);
        if ((all & ~bits_of(far)) != 0) bits = keep_in_view(boxes, bits, far, projected);
        bits = kept(bits, in_picture(projected, view_.buffer_relative), counters_.outside);
        bits = kept(bits, meets_sample(projected, view_.buffer_relative), counters_.between_samples);
        if (bits == 0) return 0;
        const MF away = turned_away(clusters_.cone_row(0) + first, clusters_.cone_stride(), placement_);
        bits = kept(bits, hn::Not(away), counters_.turned_away);
        if (view_.least_size_per_distance > 0.0F && bits != 0) {
            const BoxVector relative = placed(boxes, placement_.relative_from_object_rows);
            bits = kept(bits, large_enough(relative, {}, view_.least_size_per_distance), counters_.too_small);
        }
        if (view_.occlusion != nullptr) bits = not_hidden(projected, bits);
        return bits;
    }

private:
    static HWY_INLINE std::uint32_t kept(std::uint32_t bits, MF keep, std::uint64_t& left_out) {
        const std::uint32_t kept_bits = bits & bits_of(keep);
        left_out += static_cast<std::uint64_t>(std::popcount(bits & ~kept_bits));
        return kept_bits;
    }

    /// Near the eye a rectangle around a cluster says little.
    std::uint32_t keep_in_view(const BoxVector& boxes, std::uint32_t bits, MF far, Projected& projected) {
        const BoxVector relative = placed(boxes, placement_.relative_from_object_rows);
        projected = chosen(far, projected, project(relative, view_.buffer_relative, bits));
        const MF inside = in_frustum(relative, view_.frustum_relative, FloatFrustum::kAllPlanes);
        return kept(bits, hn::Or(far, inside), counters_.outside);
    }

    HWY_INLINE std::uint32_t not_hidden(const Projected& projected, std::uint32_t bits) {
        const std::uint32_t worth = bits & bits_of(worth_a_test(projected));
        if (worth == 0) return bits;
        const std::uint32_t hidden = hidden_of(*view_.occlusion, projected, worth);
        counters_.occluded += static_cast<std::uint64_t>(std::popcount(hidden));
        return bits & ~hidden;
    }

    const Clusters& clusters_;
    const Clusters::View& view_;
    const ClusterPlacement& placement_;
    ProjectingRows rows_;
    ClusterCounters& counters_;
};

/// @param shown  one bit per cluster; zeros come in
void test_here(const Clusters& clusters, const ClusterRange& range, const ClusterPlacement& placement,
               std::uint64_t* shown, ClusterCounters& counters) {
    InstanceTest test{clusters, range, placement, counters};
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(DF{}));
    for (std::uint32_t i = 0; i < range.count; i += lanes) {
        const std::uint32_t bits = test.seen(range.first + i, lowest_bits(std::min(lanes, range.count - i)));
        shown[i / 64] |= std::uint64_t{bits} << (i % 64);
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
        bounds_.push_back(bounds);
        end_indices_.push_back(static_cast<std::uint32_t>(next));
    }
    range.count = static_cast<std::uint32_t>(meshlets.size());
    for (const scene::Vertex& vertex : vertices) {
        range.reach_object = glm::max(range.reach_object, glm::abs(vertex.position_object));
    }
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

void Clusters::test(const ClusterRange& range, const glm::dmat4& world_from_object, std::vector<std::uint64_t>& shown) {
    const std::size_t first_word = shown.size();
    shown.resize(first_word + (range.count + 63) / 64, 0);
    counters_.tested += range.count;
    HWY_DYNAMIC_DISPATCH(test_here)(*this, range, placement(world_from_object), shown.data() + first_word, counters_);
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
