// FLIP, written from the paper: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. D.
// Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and
// Interactive Techniques 3 (2), 2020. Section numbers below are the paper's.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/colour.h"
#include "core/metrics.h"
#include "core/separable_filter.h"

namespace lw {
namespace {

// Section 4.1.3: exponent, and the two ends of the piecewise linear map of colour differences.
constexpr float kColourExponent = 0.7F;
constexpr float kKneeIn = 0.4F;    // p_c
constexpr float kKneeOut = 0.95F;  // p_t
// Section 4.2: width of the feature detectors in degrees, and the exponent of feature differences.
constexpr double kFeatureWidth_deg = 0.082;
constexpr float kFeatureExponent = 0.5F;

// Linear BT.709 RGB to CIE XYZ under D65, rows.
constexpr std::array<std::array<double, 3>, 3> kXyzFromRgb{{
    {0.4124564, 0.3575761, 0.1804375},
    {0.2126729, 0.7151522, 0.0721750},
    {0.0193339, 0.1191920, 0.9503041},
}};

using Plane = Image<float>;
using Planes = std::array<Plane, 3>;
using Matrix = std::array<std::array<float, 3>, 3>;
struct Triple {
    float x, y, z;
};

Triple apply(const Matrix& m, float x, float y, float z) {
    return {m[0][0] * x + m[0][1] * y + m[0][2] * z, m[1][0] * x + m[1][1] * y + m[1][2] * z,
            m[2][0] * x + m[2][1] * y + m[2][2] * z};
}

// XYZ divided by that of white, from linear RGB: rows that sum to 1.
Matrix make_relative_xyz_from_rgb() {
    Matrix m{};
    for (std::size_t row = 0; row < 3; ++row) {
        const double white = kXyzFromRgb[row][0] + kXyzFromRgb[row][1] + kXyzFromRgb[row][2];
        for (std::size_t column = 0; column < 3; ++column) {
            m[row][column] = static_cast<float>(kXyzFromRgb[row][column] / white);
        }
    }
    return m;
}

Matrix inverse_of(const Matrix& m) {
    glm::dmat3 columns{1.0};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            columns[column][row] = m[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        }
    }
    columns = glm::inverse(columns);
    Matrix result{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            result[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
                static_cast<float>(columns[column][row]);
        }
    }
    return result;
}

// Cube root of a value in [0, 2] to 1e-6 relative, without a call so that loops over it vectorise. The exponent divided
// by 3 (in the bits) is within 5 %; each Halley step cubes the error.
inline float cube_root(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    float y = std::bit_cast<float>(bits / 3 + 0x2A5137A0);
    for (int step = 0; step < 2; ++step) {
        const float cube = y * y * y;
        y = y * (cube + x + x) / (cube + cube + x);
    }
    return y;
}

// CIE 1976 lightness function.
inline float lab_function(float t) {
    constexpr float kDelta = 6.0F / 29.0F;
    const float root = cube_root(t);
    const float line = t * (1.0F / (3.0F * kDelta * kDelta)) + 4.0F / 29.0F;
    return t > kDelta * kDelta * kDelta ? root : line;
}

// CIELAB with the Hunt adjustment: chroma scaled by lightness (section 4.1.2).
inline Triple hunt_lab_of(const Triple& relative_xyz) {
    const float fx = lab_function(relative_xyz.x);
    const float fy = lab_function(relative_xyz.y);
    const float fz = lab_function(relative_xyz.z);
    const float lightness = 116.0F * fy - 16.0F;
    const float adjust = 0.01F * lightness;
    return {lightness, adjust * 500.0F * (fx - fy), adjust * 200.0F * (fy - fz)};
}

// Distance of "hybrid" form: city block in lightness, Euclidean in chroma (section 4.1.2).
inline float hyab(const Triple& a, const Triple& b) {
    const float da = a.y - b.y;
    const float db = a.z - b.z;
    return std::abs(a.x - b.x) + std::sqrt(da * da + db * db);
}

// Opponent space YyCxCz (section 4.1.1), the space of the contrast sensitivity functions.
Planes opponent_of(const ColourImage& image, const Matrix& relative_xyz_from_rgb) {
    Planes planes{Plane{image.size_px()}, Plane{image.size_px()}, Plane{image.size_px()}};
    const std::array<float, 256>& linear = linear_from_srgb8_table();
    const auto pixels = image.pixels();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Triple xyz = apply(relative_xyz_from_rgb, linear[pixels[i].r], linear[pixels[i].g], linear[pixels[i].b]);
        planes[0].pixels()[i] = 116.0F * xyz.y - 16.0F;
        planes[1].pixels()[i] = 500.0F * (xyz.x - xyz.y);
        planes[2].pixels()[i] = 200.0F * (xyz.y - xyz.z);
    }
    return planes;
}

// A contrast sensitivity function as a Gaussian sum, a * sqrt(pi / b) * exp(-pi^2 x^2 / b), x in degrees (table 1).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities{{
    {1.0, 0.0047, 0.0, 1e-5},   // achromatic
    {1.0, 0.0053, 0.0, 1e-5},   // red-green
    {34.1, 0.04, 13.5, 0.025},  // blue-yellow
}};
constexpr double kLargestB = 0.04;

// Weights exp(-factor i^2) and their sum. Ends that carry less than 1e-7 of the middle are cut: 8-bit input cannot
// tell.
struct Gaussian {
    std::vector<double> weights;
    double sum = 0.0;
};
Gaussian gaussian(double factor, int radius) {
    while (radius > 0 && std::exp(-factor * radius * radius) < 1e-7) --radius;
    Gaussian result;
    for (int i = -radius; i <= radius; ++i) {
        result.weights.push_back(std::exp(-factor * i * i));
        result.sum += result.weights.back();
    }
    return result;
}

Kernel scaled(const std::vector<double>& weights, double scale) {
    Kernel kernel;
    for (const double weight : weights) kernel.push_back(static_cast<float>(weight * scale));
    return kernel;
}

// Filters a channel with its sensitivity, normalised to sum 1. Each Gaussian of the sum is separable.
void filter_sensitivity(Plane& channel, const Sensitivity& s, double pixels_per_degree, Plane& scratch) {
    const double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kLargestB / (2.0 * pi * pi)) * pixels_per_degree));
    const double scale = pi * pi / (pixels_per_degree * pixels_per_degree);
    const Gaussian first = gaussian(scale / s.b1, radius);
    const Gaussian second = gaussian(scale / s.b2, radius);
    const double share_first = s.a1 * std::sqrt(pi / s.b1) * first.sum * first.sum;
    const double share_second = s.a2 * std::sqrt(pi / s.b2) * second.sum * second.sum;
    const double total = share_first + share_second;

    Plane filtered;
    filter_separable(channel, scaled(first.weights, share_first / total / first.sum),
                     scaled(first.weights, 1.0 / first.sum), scratch, filtered);
    if (share_second > 0.0) {
        Plane filtered_second;
        filter_separable(channel, scaled(second.weights, share_second / total / second.sum),
                         scaled(second.weights, 1.0 / second.sum), scratch, filtered_second);
        for (std::size_t i = 0; i < filtered.pixels().size(); ++i) filtered.pixels()[i] += filtered_second.pixels()[i];
    }
    channel = std::move(filtered);
}

// Filtered opponent colours -> Hunt-adjusted CIELAB, in place; what left the RGB cube is clamped to it (section 4.1.1).
void to_hunt_lab(Planes& planes, const Matrix& relative_xyz_from_rgb, const Matrix& rgb_from_relative_xyz) {
    float* c0 = planes[0].pixels().data();
    float* c1 = planes[1].pixels().data();
    float* c2 = planes[2].pixels().data();
    const std::size_t count = planes[0].pixels().size();
    for (std::size_t i = 0; i < count; ++i) {
        const float y = (c0[i] + 16.0F) * (1.0F / 116.0F);
        Triple rgb = apply(rgb_from_relative_xyz, y + c1[i] * (1.0F / 500.0F), y, y - c2[i] * (1.0F / 200.0F));
        rgb.x = std::min(std::max(rgb.x, 0.0F), 1.0F);
        rgb.y = std::min(std::max(rgb.y, 0.0F), 1.0F);
        rgb.z = std::min(std::max(rgb.z, 0.0F), 1.0F);
        const Triple lab = hunt_lab_of(apply(relative_xyz_from_rgb, rgb.x, rgb.y, rgb.z));
        c0[i] = lab.x;
        c1[i] = lab.y;
        c2[i] = lab.z;
    }
}

// Kernels of section 4.2: a Gaussian, and its first and second derivatives with positive and negative weights each
// scaled to sum to 1 (in two dimensions, which the products below keep).
struct FeatureKernels {
    Kernel smooth, edge, point;
};
FeatureKernels feature_kernels(double pixels_per_degree) {
    const double sigma_px = 0.5 * kFeatureWidth_deg * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma_px));
    std::vector<double> smooth, edge, point;
    double smooth_sum = 0.0, edge_sum = 0.0, point_positive = 0.0, point_negative = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        const double g = std::exp(-0.5 * i * i / (sigma_px * sigma_px));
        smooth.push_back(g);
        edge.push_back(-i * g);
        point.push_back((i * i / (sigma_px * sigma_px) - 1.0) * g);
        smooth_sum += g;
        edge_sum += std::max(edge.back(), 0.0);
        point_positive += std::max(point.back(), 0.0);
        point_negative -= std::min(point.back(), 0.0);
    }
    for (double& weight : point) {
        const double sum = weight > 0.0 ? point_positive : point_negative;
        weight = sum > 0.0 ? weight / sum : 0.0;
    }
    return {scaled(smooth, 1.0 / smooth_sum), scaled(edge, edge_sum > 0.0 ? 1.0 / edge_sum : 0.0), scaled(point, 1.0)};
}

struct FeatureStrength {
    Plane edge, point;
};

void length_of(const Plane& x, Plane& y_and_length) {
    float* out = y_and_length.pixels().data();
    const float* in = x.pixels().data();
    const std::size_t count = x.pixels().size();
    for (std::size_t i = 0; i < count; ++i) out[i] = std::sqrt(in[i] * in[i] + out[i] * out[i]);
}

// `achromatic` is the unfiltered first opponent channel.
FeatureStrength features_of(const Plane& achromatic, const FeatureKernels& kernels) {
    Plane luminance{achromatic.size_px()};
    for (std::size_t i = 0; i < luminance.pixels().size(); ++i) {
        luminance.pixels()[i] = (achromatic.pixels()[i] + 16.0F) * (1.0F / 116.0F);
    }
    FeatureStrength features;
    Plane rows, along_x;
    filter_rows(luminance, kernels.edge, rows);
    filter_columns(rows, kernels.smooth, along_x);
    Plane smooth_rows;
    filter_rows(luminance, kernels.smooth, smooth_rows);
    filter_columns(smooth_rows, kernels.edge, features.edge);
    length_of(along_x, features.edge);

    filter_rows(luminance, kernels.point, rows);
    filter_columns(rows, kernels.smooth, along_x);
    filter_columns(smooth_rows, kernels.point, features.point);
    length_of(along_x, features.point);
    return features;
}

// Section 4.1.3: differences up to the knee use most of the range, since larger ones hardly differ to the eye.
inline float redistributed(float difference, float largest) {
    const float knee = kKneeIn * largest;
    if (difference < knee) return kKneeOut / knee * difference;
    return kKneeOut + (difference - knee) / (largest - knee) * (1.0F - kKneeOut);
}

// The largest difference the adjusted space holds: from pure green to pure blue.
float largest_colour_difference(const Matrix& relative_xyz_from_rgb) {
    const Triple green = hunt_lab_of(apply(relative_xyz_from_rgb, 0.0F, 1.0F, 0.0F));
    const Triple blue = hunt_lab_of(apply(relative_xyz_from_rgb, 0.0F, 0.0F, 1.0F));
    return std::pow(hyab(green, blue), kColourExponent);
}

struct Perceived {
    Planes hunt_lab;
    FeatureStrength features;
};

}  // namespace

FlipResult flip(const ColourImage& reference, const ColourImage& test, double pixels_per_degree) {
    LW_CHECK(reference.size_px() == test.size_px(), fmt::format("{}x{} against {}x{} pixels", reference.width(),
                                                                reference.height(), test.width(), test.height()));
    LW_CHECK(pixels_per_degree > 0.0 && std::isfinite(pixels_per_degree), fmt::format("{}", pixels_per_degree));
    if (reference.empty()) return {};

    const Matrix relative_xyz_from_rgb = make_relative_xyz_from_rgb();
    const Matrix rgb_from_relative_xyz = inverse_of(relative_xyz_from_rgb);
    const FeatureKernels kernels = feature_kernels(pixels_per_degree);
    const auto perceive = [&](const ColourImage& image) {
        Perceived perceived{opponent_of(image, relative_xyz_from_rgb), {}};
        perceived.features = features_of(perceived.hunt_lab[0], kernels);
        Plane scratch;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            filter_sensitivity(perceived.hunt_lab[channel], kSensitivities[channel], pixels_per_degree, scratch);
        }
        to_hunt_lab(perceived.hunt_lab, relative_xyz_from_rgb, rgb_from_relative_xyz);
        return perceived;
    };
    const Perceived a = perceive(reference);
    const Perceived b = perceive(test);

    FlipResult result{0.0, Image<float>{reference.size_px()}};
    const float largest = largest_colour_difference(relative_xyz_from_rgb);
    const auto lab_at = [](const Planes& planes, std::size_t i) {
        return Triple{planes[0].pixels()[i], planes[1].pixels()[i], planes[2].pixels()[i]};
    };
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.pixels().size(); ++i) {
        const float distance = hyab(lab_at(a.hunt_lab, i), lab_at(b.hunt_lab, i));
        const float edge = std::abs(a.features.edge.pixels()[i] - b.features.edge.pixels()[i]);
        const float point = std::abs(a.features.point.pixels()[i] - b.features.point.pixels()[i]);
        float error = 0.0F;
        if (distance > 0.0F) {
            const float colour = redistributed(std::pow(distance, kColourExponent), largest);
            const float feature = std::sqrt(std::max(edge, point) * (1.0F / std::numbers::sqrt2_v<float>));
            static_assert(kFeatureExponent == 0.5F, "the square root above");
            error = std::min(std::pow(colour, 1.0F - feature), 1.0F);
        }
        result.error_map.pixels()[i] = error;
        sum += static_cast<double>(error);
    }
    result.mean = sum / static_cast<double>(reference.pixels().size());
    return result;
}

}  // namespace lw
