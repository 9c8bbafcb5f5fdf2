/// The oracle of the tests: the splat in double precision, one pixel at a time, with the code of the formulas.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/reprojection.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_footprint.h"
#include "warp_server/methods/winner_rule.h"

namespace lw {
namespace {

using Matrix = Transform<TargetPx, SourcePx>;

// d(target place) / d(source place) on the pixel's surface: place the neighbours of the tangent plane and subtract.
struct Jacobian {
    glm::dvec2 along_x{1.0, 0.0};
    glm::dvec2 along_y{0.0, 1.0};
};

Jacobian jacobian_at(const Matrix& matrix, const glm::dvec2& place_px, double depth, const DepthGradient& gradient) {
    constexpr double kStepPx = 1.0 / 1024.0;  // second-order error below 1e-9 px on any slant a pixel can show
    const auto difference = [&](const glm::dvec2& direction, double slope) {
        const auto before = reproject(matrix, place_px - kStepPx * direction, depth - kStepPx * slope);
        const auto after = reproject(matrix, place_px + kStepPx * direction, depth + kStepPx * slope);
        if (!before || !after) return direction;
        return (after->position_px - before->position_px) / (2.0 * kStepPx);
    };
    return {difference({1.0, 0.0}, gradient.x), difference({0.0, 1.0}, gradient.y)};
}

class ReferenceMethod final : public WarpMethod {
public:
    explicit ReferenceMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        table_.build(layer.camera, target.camera, layer.movers, target.movers);
        out.resize(target.camera.size_px);
        keys_.resize(target.camera.size_px);
        std::fill(keys_.pixels().begin(), keys_.pixels().end(), WinnerKey{0});
        std::fill(out.coverage.pixels().begin(), out.coverage.pixels().end(), Coverage::hole);
        std::fill(out.colour.pixels().begin(), out.colour.pixels().end(), Rgba8{});
        std::fill(out.depth.pixels().begin(), out.depth.pixels().end(), 0.0F);
        for (int y = 0; y < pixels.depth.height(); ++y) {
            for (int x = 0; x < pixels.depth.width(); ++x) place_pixel(pixels, x, y, out);
        }
    }

private:
    void place_pixel(const CpuPixels& pixels, int x, int y, DisplayFrame& out) {
        const float depth = pixels.depth.at(x, y);
        const Matrix* matrix = table_.find(pixels.object_id.at(x, y));
        if (matrix == nullptr) {
            ++counters_.unknown_object;
            return;
        }
        if (!is_usable_depth(depth)) {
            ++counters_.bad_depth;
            return;
        }
        const glm::dvec2 place_px{x + 0.5, y + 0.5};
        const auto placed = reproject(*matrix, place_px, depth);
        if (!placed || snapped(placed->depth) > 1.0F) return;
        const Jacobian jacobian =
            jacobian_at(*matrix, place_px, depth, depth_gradient(pixels.depth, pixels.object_id, x, y));
        const double half_x = half_extent(jacobian.along_x.x, jacobian.along_y.x);
        const double half_y = half_extent(jacobian.along_x.y, jacobian.along_y.y);
        const glm::dvec2 low = placed->position_px - glm::dvec2{half_x, half_y};
        const glm::dvec2 high = placed->position_px + glm::dvec2{half_x, half_y};
        for (int row = first_centre(low.y); row < first_centre(high.y) && row < out.depth.height(); ++row) {
            for (int column = first_centre(low.x); column < first_centre(high.x) && column < out.depth.width();
                 ++column) {
                const glm::dvec2 offset = glm::dvec2{column + 0.5, row + 0.5} - placed->position_px;
                const WinnerKey key = winner_key(snapped(placed->depth), static_cast<float>(glm::dot(offset, offset)),
                                                 pixels.colour.at(x, y));
                if (key <= keys_.at(column, row)) continue;
                keys_.at(column, row) = key;
                out.colour.at(column, row) = opaque(pixels.colour.at(x, y));
                out.depth.at(column, row) = snapped(placed->depth);
                out.coverage.at(column, row) = Coverage::reached;
            }
        }
    }

    // To float, without the negative zero or 1e-18 that composing a mover's matrix can leave of a background depth.
    static float snapped(double depth) { return static_cast<float>(std::max(depth, 0.0)); }

    static double half_extent(double along_x, double along_y) {
        const double half = 0.5 * (std::abs(along_x) + std::abs(along_y));
        return std::clamp(half, 0.5, static_cast<double>(kLargestHalfExtentPx));
    }

    // First pixel whose centre is at or after `edge_px`, at least 0. Rounded to 1e-7 px first, so that the 1e-13 px of
    // composing in double do not move a still picture's pixels across their own edges.
    static int first_centre(double edge_px) {
        const double rounded = std::round(edge_px * 1e7) * 1e-7;
        return static_cast<int>(std::clamp(std::ceil(rounded - 0.5), 0.0, 1e6));
    }

    std::string label_;
    ReprojectionTable table_;
    Image<WinnerKey> keys_;
};

}  // namespace

MadeMethod make_reference_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<ReferenceMethod>(std::move(label))};
}

}  // namespace lw
