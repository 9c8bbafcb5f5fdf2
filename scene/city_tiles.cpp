#include "scene/city_tiles.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/city_materials.h"

namespace lw::scene {

namespace {

constexpr double kTileWidth_m = 0.38;
constexpr double kTileLength_m = 0.48;
constexpr double kTileRise_m = 0.075;  ///< of the arch in the middle of a tile's lower edge

glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(glm::dot(v, v)); }

/// The plane of a slope: u runs along the eaves, s up the slope, h out of it; metres.
class TiledSlope {
public:
    TiledSlope(const glm::dvec3& eaves_left, const glm::dvec3& eaves_right, const glm::dvec3& ridge_right,
               const glm::dvec3& ridge_left)
        : origin_{eaves_left}, across_{unit(eaves_right - eaves_left)} {
        const glm::dvec3 to_left = ridge_left - eaves_left;
        ridge_left_ = glm::dot(to_left, across_);
        ridge_right_ = glm::dot(ridge_right - eaves_left, across_);
        width_ = glm::dot(eaves_right - eaves_left, across_);
        const glm::dvec3 up_slope = to_left - across_ * ridge_left_;
        length_ = std::sqrt(glm::dot(up_slope, up_slope));
        up_ = up_slope / length_;
        out_ = glm::cross(across_, up_);
        rows_ = std::max(1, static_cast<int>(length_ / kTileLength_m + 0.5));
        columns_ = std::max(1, static_cast<int>(width_ / kTileWidth_m + 0.5));
        pitch_ = length_ / rows_;
        tile_ = width_ / columns_;
    }

    void add_to(MeshBuilder& builder) const {
        for (int row = 0; row < rows_; ++row) add_row(builder, row);
    }

    [[nodiscard]] const glm::dvec3& out() const { return out_; }

private:
    /// Where two tiles of a row meet; vertices of the upper side and of the open end below.
    struct Joint {
        double low_u;
        double high_u;
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t end;
    };

    [[nodiscard]] glm::dvec3 point(double u, double s, double h) const {
        return origin_ + across_ * u + up_ * s + out_ * h;
    }
    [[nodiscard]] double left_at(double s) const { return ridge_left_ * s / length_; }
    [[nodiscard]] double right_at(double s) const {
        return std::max(left_at(s), width_ + (ridge_right_ - width_) * s / length_);
    }
    /// The texture holds 8 x 8 tiles; rows take different ones of its columns.
    [[nodiscard]] glm::dvec2 uv(double u, double s, int row) const {
        return {u / (8.0 * tile_) + 0.375 * (row % 8), -s / (8.0 * pitch_)};
    }

    Joint add_joint(MeshBuilder& builder, int row, int column) const {
        const double s0 = row * pitch_;
        const double s1 = s0 + pitch_;
        Joint joint{};
        joint.low_u = std::clamp(column * tile_, left_at(s0), right_at(s0));
        joint.high_u = std::clamp(column * tile_, left_at(s1), right_at(s1));
        // Leaning left here and right in the middle of the tile: light then shows an S, as on pantiles.
        joint.low = builder.vertex(point(joint.low_u, s0, 0.0), unit(out_ - across_ * 0.45), uv(joint.low_u, s0, row));
        joint.high = builder.vertex(point(joint.high_u, s1, 0.0), out_, uv(joint.high_u, s1, row));
        joint.end = builder.vertex(point(joint.low_u, s0, 0.0), -up_, uv(joint.low_u, s0, row));
        return joint;
    }

    void add_row(MeshBuilder& builder, int row) const {
        const double s0 = row * pitch_;
        std::optional<Joint> left;
        for (int column = 0; column < columns_; ++column) {
            const double low_left = std::max(column * tile_, left_at(s0));
            const double low_right = std::min((column + 1) * tile_, right_at(s0));
            if (low_right - low_left < 1e-3) {
                left.reset();
                continue;
            }
            if (!left) left = add_joint(builder, row, column);
            const Joint right = add_joint(builder, row, column + 1);
            const double middle = 0.5 * (low_left + low_right);
            const auto arch =
                builder.vertex(point(middle, s0, kTileRise_m), unit(out_ + across_ * 0.3), uv(middle, s0, row));
            builder.triangle(left->low, arch, left->high);
            if (right.high_u - left->high_u > 1e-6) {
                builder.triangle(arch, right.high, left->high);
                builder.triangle(arch, right.low, right.high);
            } else {
                builder.triangle(arch, right.low, left->high);
            }
            // The open end of the tile; its foot is the upper edge of the row below.
            const auto end = builder.vertex(point(middle, s0, kTileRise_m), -up_, uv(middle, s0, row));
            builder.triangle(left->end, right.end, end);
            left = right;
        }
    }

    glm::dvec3 origin_;
    glm::dvec3 across_;
    glm::dvec3 up_{0.0};
    glm::dvec3 out_{0.0};
    double width_ = 0.0;
    double length_ = 0.0;
    double ridge_left_ = 0.0;
    double ridge_right_ = 0.0;
    int rows_ = 1;
    int columns_ = 1;
    double pitch_ = 0.0;
    double tile_ = 0.0;
};

}  // namespace

void add_tiled_slope(MeshBuilder& builder, Rgba8 colour, const glm::dvec3& eaves_left, const glm::dvec3& eaves_right,
                     const glm::dvec3& ridge_right, const glm::dvec3& ridge_left) {
    builder.use_material(kRoofTile, texture_size_m(kRoofTile));
    builder.use_colour(colour);
    const TiledSlope slope{eaves_left, eaves_right, ridge_right, ridge_left};
    slope.add_to(builder);
    // The underside, seen below the overhang.
    builder.use_material(kPaint);
    builder.use_colour(tint(0x8A7C6C));
    const glm::dvec3 down = slope.out() * -0.08;
    builder.polygon({eaves_left + down, ridge_left + down, ridge_right + down, eaves_right + down});
    builder.polygon({eaves_left + down, eaves_right + down, eaves_right, eaves_left});
}

}  // namespace lw::scene
