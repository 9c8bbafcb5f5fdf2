#include "core/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/separable_filter.h"

namespace lw {
namespace {

constexpr int kWindowRadius_px = 5;
constexpr double kWindowSigma_px = 1.5;
constexpr float kC1 = 0.01F * 0.01F;  // (K1 * data range)^2
constexpr float kC2 = 0.03F * 0.03F;

void check_equal_sizes(const ColourImage& a, const ColourImage& b) {
    LW_CHECK(a.size_px() == b.size_px(),
             fmt::format("{}x{} against {}x{} pixels", a.width(), a.height(), b.width(), b.height()));
}

// Shifted to be centred on 0: variances do not change, and their differences of squares keep more bits.
constexpr float kLumaShift = 0.5F;
float shifted_luma(Rgba8 c) {
    return (0.299F * static_cast<float>(c.r) + 0.587F * static_cast<float>(c.g) + 0.114F * static_cast<float>(c.b)) /
               255.0F -
           kLumaShift;
}

// `length` is the extent of the image along the window.
Kernel gaussian_window(int length) {
    const int radius = std::min(kWindowRadius_px, (length - 1) / 2);
    std::vector<double> weights;
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        weights.push_back(std::exp(-0.5 * i * i / (kWindowSigma_px * kWindowSigma_px)));
        sum += weights.back();
    }
    Kernel kernel;
    for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
    return kernel;
}

struct Planes {
    Image<float> a, b, sum_of_squares, product;
};

Planes planes_of(const ColourImage& a, const ColourImage& b) {
    Planes planes{Image<float>{a.size_px()}, Image<float>{a.size_px()}, Image<float>{a.size_px()},
                  Image<float>{a.size_px()}};
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const float luma_a = shifted_luma(a.pixels()[i]);
        const float luma_b = shifted_luma(b.pixels()[i]);
        planes.a.pixels()[i] = luma_a;
        planes.b.pixels()[i] = luma_b;
        planes.sum_of_squares.pixels()[i] = luma_a * luma_a + luma_b * luma_b;
        planes.product.pixels()[i] = luma_a * luma_b;
    }
    return planes;
}

// The arguments are Gaussian means in one row. Written so that equal images give exactly 1.
double ssim_sum(std::size_t begin, std::size_t end, std::span<const float> mean_a, std::span<const float> mean_b,
                std::span<const float> mean_squares, std::span<const float> mean_product) {
    double sum = 0.0;
    for (std::size_t x = begin; x < end; ++x) {
        const float covariance = mean_product[x] - mean_a[x] * mean_b[x];
        const float variances = mean_squares[x] - (mean_a[x] * mean_a[x] + mean_b[x] * mean_b[x]);
        const float luma_a = mean_a[x] + kLumaShift;
        const float luma_b = mean_b[x] + kLumaShift;
        const float luminance = (2.0F * (luma_a * luma_b) + kC1) / (luma_a * luma_a + luma_b * luma_b + kC1);
        sum += static_cast<double>(luminance * ((2.0F * covariance + kC2) / (variances + kC2)));
    }
    return sum;
}

}  // namespace

std::optional<double> psnr_db(const ColourImage& a, const ColourImage& b) {
    check_equal_sizes(a, b);
    std::uint64_t sum_of_squares = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        const Rgba8 pa = a.pixels()[i];
        const Rgba8 pb = b.pixels()[i];
        const int r = pa.r - pb.r;
        const int g = pa.g - pb.g;
        const int blue = pa.b - pb.b;
        sum_of_squares += static_cast<std::uint64_t>(r * r + g * g + blue * blue);
    }
    if (sum_of_squares == 0) return std::nullopt;
    const double mean_square = static_cast<double>(sum_of_squares) / (3.0 * static_cast<double>(a.pixels().size()));
    return 10.0 * std::log10(255.0 * 255.0 / mean_square);
}

double ssim(const ColourImage& a, const ColourImage& b) {
    check_equal_sizes(a, b);
    if (a.empty()) return 1.0;
    const Planes planes = planes_of(a, b);
    const Kernel horizontal = gaussian_window(a.width());
    const Kernel vertical = gaussian_window(a.height());
    Image<float> scratch, mean_a, mean_b, mean_squares, mean_product;
    filter_separable(planes.a, horizontal, vertical, scratch, mean_a);
    filter_separable(planes.b, horizontal, vertical, scratch, mean_b);
    filter_separable(planes.sum_of_squares, horizontal, vertical, scratch, mean_squares);
    filter_separable(planes.product, horizontal, vertical, scratch, mean_product);

    const int margin_x = static_cast<int>(horizontal.size() / 2);
    const int margin_y = static_cast<int>(vertical.size() / 2);
    double sum = 0.0;
    for (int y = margin_y; y < a.height() - margin_y; ++y) {
        sum += ssim_sum(static_cast<std::size_t>(margin_x), static_cast<std::size_t>(a.width() - margin_x),
                        mean_a.row(y), mean_b.row(y), mean_squares.row(y), mean_product.row(y));
    }
    return sum / (static_cast<double>(a.width() - 2 * margin_x) * (a.height() - 2 * margin_y));
}

}  // namespace lw
