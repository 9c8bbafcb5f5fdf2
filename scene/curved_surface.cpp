#include "scene/curved_surface.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

/// The grid's points by column and row, both clamped or wrapped.
class Grid {
public:
    Grid(std::span<const glm::dvec3> points, int columns, bool closed)
        : points_{points}, columns_{columns}, rows_{static_cast<int>(points.size()) / columns}, closed_{closed} {}

    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] const glm::dvec3& at(int column, int row) const {
        const int c = closed_ ? (column + columns_) % columns_ : std::clamp(column, 0, columns_ - 1);
        return points_[static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1) * columns_ + c)];
    }
    [[nodiscard]] glm::dvec3 normal(int column, int row) const {
        // One row further on where a row is a point and so has no direction of its own.
        for (const int step : {0, 1, -1}) {
            const glm::dvec3 along = at(column + 1, row + step) - at(column - 1, row + step);
            const glm::dvec3 up = at(column, row + 1) - at(column, row - 1);
            const glm::dvec3 normal = glm::cross(along, up);
            const double length2 = glm::dot(normal, normal);
            if (length2 > 1e-18) return normal / std::sqrt(length2);
        }
        return {0.0, 1.0, 0.0};
    }

private:
    std::span<const glm::dvec3> points_;
    int columns_;
    int rows_;
    bool closed_;
};

}  // namespace

void add_sheet(MeshBuilder& builder, std::span<const glm::dvec3> points, int columns, bool closed) {
    LW_CHECK(columns >= 2 && points.size() >= 2 * static_cast<std::size_t>(columns) &&
                 points.size() % static_cast<std::size_t>(columns) == 0,
             "a sheet needs whole rows");
    const Grid grid{points, columns, closed};
    std::vector<std::uint32_t> indices;
    for (int row = 0; row < grid.rows(); ++row) {
        for (int column = 0; column < columns; ++column) {
            indices.push_back(builder.vertex(grid.at(column, row), grid.normal(column, row)));
        }
    }
    const auto index_of = [&](int column, int row) {
        return indices[static_cast<std::size_t>(row * columns + column % columns)];
    };
    for (int row = 0; row + 1 < grid.rows(); ++row) {
        for (int column = 0; column + (closed ? 0 : 1) < columns; ++column) {
            builder.triangle(index_of(column, row), index_of(column + 1, row), index_of(column + 1, row + 1));
            builder.triangle(index_of(column, row), index_of(column + 1, row + 1), index_of(column, row + 1));
        }
    }
}

std::vector<glm::dvec3> rounded_section(const glm::dvec3& centre, const glm::dvec3& across, const glm::dvec3& up,
                                        double half_width_m, double half_height_m, double roundness, int sides) {
    std::vector<glm::dvec3> points;
    for (int k = 0; k < sides; ++k) {
        const Direction2 d = direction_of_turns(static_cast<double>(k) / sides);
        // Towards the square along the same direction: its boundary is where the larger coordinate is 1.
        const double to_square = 1.0 / std::max(std::abs(d.cosine), std::abs(d.sine));
        const double reach = roundness + (1.0 - roundness) * to_square;
        points.push_back(centre + across * (half_width_m * reach * d.cosine) + up * (half_height_m * reach * d.sine));
    }
    return points;
}

glm::dvec3 on_curve(std::span<const glm::dvec3> points, double t) {
    const int segments = static_cast<int>(points.size()) - 1;
    const double place = std::clamp(t, 0.0, 1.0) * segments;
    const int i = std::min(static_cast<int>(place), segments - 1);
    const double u = place - i;
    const auto point = [&](int k) { return points[static_cast<std::size_t>(std::clamp(k, 0, segments))]; };
    const glm::dvec3 a = point(i - 1);
    const glm::dvec3 b = point(i);
    const glm::dvec3 c = point(i + 1);
    const glm::dvec3 d = point(i + 2);
    return b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
}

std::vector<glm::dvec3> curve(std::span<const glm::dvec3> points, int count) {
    std::vector<glm::dvec3> places;
    for (int i = 0; i < count; ++i) places.push_back(on_curve(points, static_cast<double>(i) / (count - 1)));
    return places;
}

}  // namespace lw::scene
