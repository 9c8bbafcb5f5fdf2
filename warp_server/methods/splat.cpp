/// Every source pixel is a point, moved by its object's matrix; the winner rule decides each target pixel.

#include <algorithm>
#include <vector>

#include "core/check.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_footprint.h"
#include "warp_server/methods/winner_rule.h"

namespace lw {
namespace {

// A source pixel placed in the target.
struct PlacedPixel {
    float x_px = 0.0F;
    float y_px = 0.0F;
    float depth = 0.0F;
    float inverse_w = 0.0F;
};

class SplatMethod final : public WarpMethod {
public:
    explicit SplatMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        const std::int64_t source_pixels = std::int64_t{pixels.depth.width()} * pixels.depth.height();
        LW_CHECK(source_pixels <= kMaxKeyedPixels, "layer has more pixels than a winner key can tell apart");
        matrices_.build(layer, target);
        out.resize(target.camera.size_px);
        keys_.resize(target.camera.size_px);
        std::fill(keys_.pixels().begin(), keys_.pixels().end(), WinnerKey{0});
        for (int y = 0; y < pixels.depth.height(); ++y) splat_row(pixels, y);
        resolve(pixels, out);
    }

private:
    void splat_row(const CpuPixels& pixels, int y) {
        const float y_px = static_cast<float>(y) + 0.5F;
        const float* depths = pixels.depth.row(y).data();
        const ObjectId* ids = pixels.object_id.row(y).data();
        const int width = pixels.depth.width();
        for (int begin = 0; begin < width;) {  // one run of equal ids at a time: one matrix, one row start
            int end = begin + 1;
            while (end < width && ids[end] == ids[begin]) ++end;
            const PixelMatrix* matrix = matrices_.find(ids[begin]);
            if (matrix == nullptr) {
                counters_.unknown_object += static_cast<std::uint64_t>(end - begin);
            } else {
                const PixelMatrix& m = *matrix;
                const PixelMatrix::Column row_start{m.one.x + y_px * m.y.x, m.one.y + y_px * m.y.y,
                                                    m.one.w + y_px * m.y.w};
                for (int x = begin; x < end; ++x) splat_pixel(pixels, m, row_start, x, y, depths[x]);
            }
            begin = end;
        }
    }

    void splat_pixel(const CpuPixels& pixels, const PixelMatrix& m, const PixelMatrix::Column& row_start, int x, int y,
                     float depth) {
        if (!is_usable_depth(depth)) {
            ++counters_.bad_depth;
            return;
        }
        const float x_px = static_cast<float>(x) + 0.5F;
        const float w = row_start.w + x_px * m.x.w + depth * m.z.w;
        if (!(w > 0.0F)) return;
        PlacedPixel placed;
        placed.inverse_w = 1.0F / w;
        placed.x_px = (row_start.x + x_px * m.x.x + depth * m.z.x) * placed.inverse_w;
        placed.y_px = (row_start.y + x_px * m.x.y + depth * m.z.y) * placed.inverse_w;
        placed.depth = depth * m.depth_scale * placed.inverse_w;
        const bool in_reach = placed.x_px > -kLargestHalfExtentPx && placed.y_px > -kLargestHalfExtentPx &&
                              placed.x_px < static_cast<float>(keys_.width()) + kLargestHalfExtentPx &&
                              placed.y_px < static_cast<float>(keys_.height()) + kLargestHalfExtentPx;
        if (!in_reach || placed.depth > 1.0F) return;
        const Footprint footprint = m.identity ? Footprint{} : footprint_at(pixels, m, placed, x, y);
        write(placed, footprint, static_cast<std::uint32_t>(y * pixels.depth.width() + x));
    }

    static Footprint footprint_at(const CpuPixels& pixels, const PixelMatrix& m, const PlacedPixel& placed, int x,
                                  int y) {
        const DepthGradient gradient = depth_gradient(pixels.depth, pixels.object_id, x, y);
        const auto derivative_x = [&](const PixelMatrix::Column& c) {
            return (c.x - placed.x_px * c.w) * placed.inverse_w;
        };
        const auto derivative_y = [&](const PixelMatrix::Column& c) {
            return (c.y - placed.y_px * c.w) * placed.inverse_w;
        };
        const float z_x = derivative_x(m.z);
        const float z_y = derivative_y(m.z);
        return footprint_of(derivative_x(m.x) + gradient.x * z_x, derivative_x(m.y) + gradient.y * z_x,
                            derivative_y(m.x) + gradient.x * z_y, derivative_y(m.y) + gradient.y * z_y);
    }

    void write(const PlacedPixel& placed, const Footprint& footprint, std::uint32_t source_index) {
        const PixelRange columns = pixels_within(placed.x_px, footprint.half_x_px, keys_.width());
        const PixelRange rows = pixels_within(placed.y_px, footprint.half_y_px, keys_.height());
        for (int row = rows.begin; row < rows.end; ++row) {
            const float dy = static_cast<float>(row) + 0.5F - placed.y_px;
            for (int column = columns.begin; column < columns.end; ++column) {
                const float dx = static_cast<float>(column) + 0.5F - placed.x_px;
                WinnerKey& winner = keys_.at(column, row);
                winner = std::max(winner, winner_key(placed.depth, dx * dx + dy * dy, source_index));
            }
        }
    }

    void resolve(const CpuPixels& pixels, DisplayFrame& out) const {
        const Rgba8* source_colours = pixels.colour.pixels().data();
        const WinnerKey* keys = keys_.pixels().data();
        Rgba8* colours = out.colour.pixels().data();
        float* depths = out.depth.pixels().data();
        Coverage* coverage = out.coverage.pixels().data();
        const std::size_t count = keys_.pixels().size();
        for (std::size_t i = 0; i < count; ++i) {
            const WinnerKey key = keys[i];
            // Without a branch: an empty key reads source pixel 0, which the fill overwrites.
            colours[i] = source_colours[winner_source_index(key)];
            depths[i] = winner_depth(key);
            coverage[i] = key != 0 ? Coverage::reached : Coverage::hole;
        }
    }

    std::string label_;
    ObjectMatrices matrices_;
    Image<WinnerKey> keys_;
};

}  // namespace

MadeMethod make_splat_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<SplatMethod>(std::move(label))};
}

}  // namespace lw
