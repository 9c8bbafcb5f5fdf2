#include "client_renderer/occluder_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace lw {

namespace {

// Surfaces closer than this leave no gap to see through.
constexpr double kTouch_m = 1e-4;
// A row goes on while its cross-section keeps this share of what the next one has.
constexpr double kLeastShare = 0.5;

/// An occluder whose planes follow the world's axes. `open_sides` in world order: bit 2 * axis + upper.
struct AlignedBox {
    scene::Bounds box;
    scene::Bounds surface;
    unsigned open_sides = 0;
};

std::optional<AlignedBox> aligned(const Occluder& occluder) {
    AlignedBox box{occluder.bounds_world, occluder.surface_bounds_world, 0};
    for (std::size_t side = 0; side < 6; ++side) {
        const glm::dvec3 normal{occluder.solid.planes_world[side]};
        int axis = 0;
        while (axis < 3 && std::abs(normal[axis]) < 1.0 - 1e-12) ++axis;
        if (axis == 3) return std::nullopt;
        const unsigned world_side = 2U * static_cast<unsigned>(axis) + (normal[axis] > 0.0 ? 1U : 0U);
        box.open_sides |= (occluder.open_sides >> side & 1U) << world_side;
    }
    return box;
}

double cross_section(const scene::Bounds& box, int axis) {
    const glm::dvec3 size = box.max - box.min;
    return std::max(size[(axis + 1) % 3], 0.0) * std::max(size[(axis + 2) % 3], 0.0);
}

/// `a` and, behind it on `axis`, `b` as one; nothing unless they touch and have most of their cross-section in common.
std::optional<AlignedBox> joined(const AlignedBox& a, const AlignedBox& b, int axis) {
    const double gap = b.box.min[axis] - a.box.max[axis];
    if (gap > kTouch_m) return std::nullopt;
    AlignedBox row;
    row.box.min = glm::max(a.box.min, b.box.min);
    row.box.max = glm::min(a.box.max, b.box.max);
    row.box.min[axis] = a.box.min[axis];
    row.box.max[axis] = b.box.max[axis];
    if (cross_section(row.box, axis) < kLeastShare * cross_section(b.box, axis)) return std::nullopt;
    row.surface = a.surface;
    row.surface.include(b.surface);
    const unsigned lower = 1U << (2 * axis);
    const unsigned upper = 2U << (2 * axis);
    row.open_sides =
        ((a.open_sides | b.open_sides) & ~(lower | upper)) | (a.open_sides & lower) | (b.open_sides & upper);
    return row;
}

Occluder occluder_of(const AlignedBox& row) {
    Occluder occluder;
    occluder.open_sides = row.open_sides;
    occluder.bounds_world = row.box;
    occluder.surface_bounds_world = row.surface;
    for (int side = 0; side < 6; ++side) {
        glm::dvec3 normal{0.0};
        const bool upper = side % 2 == 1;
        normal[side / 2] = upper ? 1.0 : -1.0;
        const double offset = upper ? row.box.max[side / 2] : -row.box.min[side / 2];
        occluder.solid.planes_world[static_cast<std::size_t>(side)] = {normal, offset};
    }
    return occluder;
}

class RowFinder {
public:
    RowFinder(const std::vector<AlignedBox>& boxes, int axis) : boxes_{boxes}, axis_{axis} {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for_each_cell(boxes[i].box, [&](std::int64_t u, std::int64_t v) {
                by_start_[key(start_of(boxes[i].box.min[axis]), u, v)].push_back(i);
            });
        }
    }

    /// Every pair that touches, and every whole row of three and more.
    void append_to(std::vector<Occluder>& occluders) const {
        std::vector<std::optional<std::size_t>> next(boxes_.size());
        std::vector<bool> has_previous(boxes_.size(), false);
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            next[i] = neighbour(i);
            if (!next[i]) continue;
            has_previous[*next[i]] = true;
            occluders.push_back(occluder_of(*joined(boxes_[i], boxes_[*next[i]], axis_)));
        }
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            if (has_previous[i]) continue;
            append_row(i, next, occluders);
        }
    }

private:
    static std::int64_t start_of(double place_m) { return std::llround(place_m * 100.0); }

    /// Equal keys of different places only cost time.
    static std::uint64_t key(std::int64_t start, std::int64_t u, std::int64_t v) {
        return static_cast<std::uint64_t>(start) * 0x9E3779B97F4A7C15ULL +
               static_cast<std::uint64_t>(u) * 0xBF58476D1CE4E5B9ULL +
               static_cast<std::uint64_t>(v) * 0x94D049BB133111EBULL;
    }

    /// The cells across the axis that the box lies in; of a large box those at its corner and no others.
    template <class Visit>
    void for_each_cell(const scene::Bounds& box, Visit visit) const {
        constexpr double kCell_m = 8.0;
        constexpr std::int64_t kMostCells = 16;  // per axis
        const int u_axis = (axis_ + 1) % 3;
        const int v_axis = (axis_ + 2) % 3;
        const auto cell = [](double place_m) { return static_cast<std::int64_t>(std::floor(place_m / kCell_m)); };
        const std::int64_t u0 = cell(box.min[u_axis]);
        const std::int64_t v0 = cell(box.min[v_axis]);
        for (std::int64_t u = u0; u <= std::min(cell(box.max[u_axis]), u0 + kMostCells); ++u) {
            for (std::int64_t v = v0; v <= std::min(cell(box.max[v_axis]), v0 + kMostCells); ++v) visit(u, v);
        }
    }

    [[nodiscard]] std::optional<std::size_t> neighbour(std::size_t i) const {
        std::optional<std::size_t> best;
        double best_section = 0.0;
        const auto consider = [&](std::size_t j) {
            if (j == i || std::abs(boxes_[j].box.min[axis_] - boxes_[i].box.max[axis_]) > kTouch_m) return;
            const auto row = joined(boxes_[i], boxes_[j], axis_);
            if (!row || cross_section(row->box, axis_) <= best_section) return;
            best = j;
            best_section = cross_section(row->box, axis_);
        };
        const std::int64_t end = start_of(boxes_[i].box.max[axis_]);
        for_each_cell(boxes_[i].box, [&](std::int64_t u, std::int64_t v) {
            for (std::int64_t k = end - 1; k <= end + 1; ++k) {
                const auto found = by_start_.find(key(k, u, v));
                if (found != by_start_.end()) std::ranges::for_each(found->second, consider);
            }
        });
        return best;
    }

    void append_row(std::size_t first, const std::vector<std::optional<std::size_t>>& next,
                    std::vector<Occluder>& occluders) const {
        AlignedBox row = boxes_[first];
        int count = 1;
        for (std::optional<std::size_t> i = next[first]; i; i = next[*i]) {
            const auto longer = joined(row, boxes_[*i], axis_);
            if (!longer) {
                if (count > 2) occluders.push_back(occluder_of(row));
                row = boxes_[*i];
                count = 1;
                continue;
            }
            row = *longer;
            ++count;
        }
        if (count > 2) occluders.push_back(occluder_of(row));
    }

    const std::vector<AlignedBox>& boxes_;
    int axis_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> by_start_;
};

}  // namespace

void append_rows(std::vector<Occluder>& occluders) {
    std::vector<AlignedBox> boxes;
    for (const Occluder& occluder : occluders) {
        if (const auto box = aligned(occluder)) boxes.push_back(*box);
    }
    for (int axis = 0; axis < 3; ++axis) RowFinder{boxes, axis}.append_to(occluders);
}

}  // namespace lw
