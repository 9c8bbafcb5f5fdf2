/// A vector of clusters of one instance against a view. Included by files that Highway compiles for every instruction
/// set.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_CLIENT_RENDERER_CLUSTER_KERNELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_CLIENT_RENDERER_CLUSTER_KERNELS_H
#undef LW_CLIENT_RENDERER_CLUSTER_KERNELS_H
#else
#define LW_CLIENT_RENDERER_CLUSTER_KERNELS_H
#endif

#include <bit>
#include <cmath>

#include "client_renderer/box_kernels.h"
#include "client_renderer/clusters.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

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
            kPlacingRounding * (glm::dot(glm::abs(glm::vec3{row}), range.reach_object()) + std::abs(row.w));
    }
    return rows;
}

/// Clusters whose triangles are all turned away from every eye within the margin.
HWY_INLINE MF turned_away(const Clusters::Block& block, std::size_t first, const ClusterPlacement& placement) {
    const DF d;
    const auto row = [&](std::size_t which) HWY_ATTR { return hn::Load(d, block.cones[which].data() + first); };
    const VF x = hn::Sub(row(4), hn::Set(d, placement.eye_object.x));
    const VF y = hn::Sub(row(5), hn::Set(d, placement.eye_object.y));
    const VF z = hn::Sub(row(6), hn::Set(d, placement.eye_object.z));
    const VF margin = hn::Set(d, placement.margin_object);
    const VF cutoff = row(3);
    // along - margin >= cutoff * (distance + margin), without the root.
    const VF along = hn::MulAdd(x, row(0), hn::MulAdd(y, row(1), hn::Mul(z, row(2))));
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

/// Where all clusters of an instance lie in the buffer, if they are at least kFar times as far away as deep.
struct InstanceRect {
    InstanceRect(const ClusterRange& range, const ProjectingRows& rows, float near_m)
        : z_row{rows.distance[0], rows.distance[1], rows.distance[2]} {
        const glm::vec3 centre = 0.5F * (range.most_object + range.least_object);
        const glm::vec3 half = 0.5F * (range.most_object - range.least_object);
        distance = glm::dot(z_row, centre) + rows.distance[3];
        depth = glm::dot(glm::abs(z_row), half) + rows.rounding[2];
        known = distance - depth > near_m && distance >= kFar * depth;
        if (!known) return;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::array<float, 4>& from = axis == 0 ? rows.x_px : rows.y_px;
            const glm::vec3 row{from[0], from[1], from[2]};
            place_px[axis] = (glm::dot(row, centre) + from[3]) / distance;
            across[axis] = glm::abs(row - place_px[axis] * z_row);
            rounding[axis] = rows.rounding[axis] + std::abs(place_px[axis]) * rows.rounding[2];
            reach_px[axis] = (glm::dot(across[axis], half) + rounding[axis]) / (distance - depth);
        }
    }

    glm::vec3 z_row;
    bool known = false;
    float distance = 0.0F;
    float depth = 0.0F;  ///< half of it
    std::array<float, 2> place_px{};
    std::array<float, 2> reach_px{};
    std::array<glm::vec3, 2> across{};  ///< |x_row - place * z_row|
    std::array<float, 2> rounding{};
};

/// One instance against the view.
class InstanceTest {
public:
    InstanceTest(const Clusters& clusters, const ClusterPlacement& placement, const ProjectingRows& rows,
                 ClusterCounters& counters)
        : view_{clusters.view()}, placement_{placement}, rows_{rows}, counters_{counters} {}

    /// Bits of the clusters of a block from `first` on that may be seen.
    /// @param all  bits of those that there are
    HWY_INLINE std::uint32_t seen(const Clusters::Block& block, std::size_t first, std::uint32_t all) {
        const BoxVector boxes = load_boxes(block.boxes_object, first);
        const Vector3 centre{boxes.centre_x, boxes.centre_y, boxes.centre_z};
        const Vector3 half{boxes.half_x, boxes.half_y, boxes.half_z};
        Projected projected;
        std::uint32_t bits = all;
        const MF far = project_from_afar(centre, half, rows_, view_.buffer_relative.near_m, projected);
        if ((all & ~bits_of(far)) != 0) bits = keep_in_view(boxes, bits, far, projected);
        bits = kept(bits, in_picture(projected, view_.buffer_relative), counters_.outside);
        bits = kept(bits, meets_sample(projected, view_.buffer_relative), counters_.between_samples);
        if (bits == 0) return 0;
        const MF away = turned_away(block, first, placement_);
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

    const Clusters::View& view_;
    const ClusterPlacement& placement_;
    ProjectingRows rows_;
    ClusterCounters& counters_;
};

/// An instance that lies wholly in the picture and looks so small that no cluster is worth a look at what hides it:
/// nearly all of a large scene. There a box's reach in the picture is a sum of its half sizes with weights that are
/// the instance's, and the directions to the eye differ by an angle that is the instance's: a third of the arithmetic.
class SmallPlacement {
public:
    SmallPlacement(const Clusters::View& view, const ClusterRange& range, const ClusterPlacement& placement,
                   const ProjectingRows& rows, const InstanceRect& rect) {
        applies_ = rect.known && !(view.least_size_per_distance > 0.0F) &&
                   take_axis(0, rows.x_px, view, range, rows, rect) &&
                   take_axis(1, rows.y_px, view, range, rows, rect) && take_direction(range, placement);
        z_row_ = rows.distance;
    }

    [[nodiscard]] bool applies() const { return applies_; }

    /// Clusters whose boxes have a sample of the picture in the rectangle around them.
    HWY_INLINE MF meets_sample(const Vector3& centre, const Vector3& half) const {
        const DF d;
        const VF per_z = hn::Div(hn::Set(d, 1.0F), affine(z_row_, centre));
        const auto meets = [&](std::size_t axis) HWY_ATTR {
            const VF place = affine(rows_[axis], centre);
            const VF reach = affine(weights_[axis], half);
            const VF first = hn::MulAdd(hn::Sub(place, reach), per_z, hn::Set(d, -snap_[axis] - 0.5F));
            const VF last = hn::MulAdd(hn::Add(place, reach), per_z, hn::Set(d, snap_[axis] - 0.5F));
            return hn::Le(hn::Ceil(first), hn::Floor(last));
        };
        return hn::And(meets(0), meets(1));
    }

    /// Clusters whose triangles are all turned away from every eye within the margin.
    HWY_INLINE MF turned_away(const Clusters::Block& block, std::size_t first) const {
        const DF d;
        const auto row = [&](std::size_t which) HWY_ATTR { return hn::Load(d, block.cones[which].data() + first); };
        return hn::Ge(hn::Sub(dot(&direction_object_.x, {row(0), row(1), row(2)}), hn::Set(d, off_)), row(3));
    }

private:
    /// False where the instance is too large.
    bool take_axis(std::size_t axis, const std::array<float, 4>& row, const Clusters::View& view,
                   const ClusterRange& range, const ProjectingRows& rows, const InstanceRect& rect) {
        const float place = rect.place_px[axis];
        const float reach = rect.reach_px[axis];
        if (!(place - reach > 0.0F) || !(place + reach < view.buffer_relative.size_px[axis])) return false;
        // 1 / (z - depth of a cluster), over 1 / z.
        const float nearest = rect.distance - rect.depth;
        const float largest_depth = glm::dot(glm::abs(rect.z_row), range.largest_half_object) + rows.rounding[2];
        const float nearer = nearest / (nearest - largest_depth);
        const glm::vec3 weights = nearer * (rect.across[axis] + reach * glm::abs(rect.z_row));
        if (!(glm::dot(weights, range.largest_half_object) < nearest)) return false;  // two pixels across
        const float scale = view.buffer_relative.samples_per_px[axis];
        for (std::size_t k = 0; k < 4; ++k) rows_[axis][k] = scale * row[k];
        weights_[axis] = {scale * weights.x, scale * weights.y, scale * weights.z,
                          scale * nearer * (rect.rounding[axis] + reach * rows.rounding[2])};
        snap_[axis] = scale * kSnapPx;
        return true;
    }

    /// False where an eye within the margin may be beside any of it.
    bool take_direction(const ClusterRange& range, const ClusterPlacement& placement) {
        const glm::vec3 from_eye = 0.5F * (range.most_object + range.least_object) - placement.eye_object;
        const float distance = glm::length(from_eye);
        const float radius = 0.5F * glm::length(range.most_object - range.least_object) + placement.margin_object;
        if (!(radius < distance)) return false;
        direction_object_ = from_eye / distance;
        off_ = radius / (distance - radius);
        return true;
    }

    bool applies_ = false;
    std::array<float, 4> z_row_{};
    std::array<std::array<float, 4>, 2> rows_{};     ///< of x and y, in samples
    std::array<std::array<float, 4>, 2> weights_{};  ///< of half sizes
    std::array<float, 2> snap_{};
    glm::vec3 direction_object_{0.0F};  ///< from the eye to the middle
    float off_ = 0.0F;                  ///< to any place of it from any eye within the margin, at most so different
};

class SmallInstanceTest {
public:
    SmallInstanceTest(const SmallPlacement& placement, ClusterCounters& counters)
        : placement_{placement}, counters_{counters} {}

    /// As InstanceTest's.
    HWY_INLINE std::uint32_t seen(const Clusters::Block& block, std::size_t first, std::uint32_t all) {
        const BoxVector boxes = load_boxes(block.boxes_object, first);
        const MF meets = placement_.meets_sample({boxes.centre_x, boxes.centre_y, boxes.centre_z},
                                                 {boxes.half_x, boxes.half_y, boxes.half_z});
        const MF away = placement_.turned_away(block, first);
        const std::uint32_t met = all & bits_of(meets);
        const std::uint32_t seen = met & ~bits_of(away);
        counters_.between_samples += static_cast<std::uint64_t>(std::popcount(all & ~met));
        counters_.turned_away += static_cast<std::uint64_t>(std::popcount(met & ~seen));
        return seen;
    }

private:
    SmallPlacement placement_;
    ClusterCounters& counters_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
