#include "core/error_attribution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "core/colour.h"

namespace lw {
namespace {

constexpr int kWindowRadius_px = 2;
constexpr int kFewestSamples = 8;
constexpr float kVisibleDifference = 2.0F / 255.0F;  // of sRGB values
constexpr float kStandardErrors = 4.0F;
constexpr float kSameSurface = 0.03F;  // of depth, plus what a slant adds within the window

// What the source shows of each truth pixel's surface, less the truth: sRGB values in [-1, 1].
struct Difference {
    glm::vec3 value{0.0F};
    bool known = false;
};

glm::vec3 srgb_of(Rgba8 colour) { return glm::vec3{colour.r, colour.g, colour.b} / 255.0F; }

glm::vec3 source_srgb(const ColourImage& colour, const SurfacePlace& place) {
    glm::vec3 linear{0.0F};
    for (std::size_t i = 0; i < 4; ++i) {
        if (place.weights[i] == 0.0F) continue;
        linear += place.weights[i] * linear_of(colour.at(place.neighbours[i].x, place.neighbours[i].y));
    }
    return srgb_of(srgb8_of(linear));
}

ErrorCause cause_of(Visibility visibility) {
    switch (visibility) {
        case Visibility::seen:
            return ErrorCause::resampled;
        case Visibility::hidden:
            return ErrorCause::disoccluded;
        case Visibility::outside:
            break;
    }
    return ErrorCause::out_of_frame;
}

bool on_one_surface(const SampledView& view, glm::ivec2 a, glm::ivec2 b) {
    if (view.object_id.at(a.x, a.y) != view.object_id.at(b.x, b.y)) return false;
    const float depth_a = view.depth.at(a.x, a.y);
    const float depth_b = view.depth.at(b.x, b.y);
    return std::abs(depth_a - depth_b) <= kSameSurface * std::max(depth_a, depth_b);
}

bool is_stale(const SampledView& truth, const Image<Difference>& differences, glm::ivec2 pixel) {
    glm::vec3 sum{0.0F};
    glm::vec3 sum_of_squares{0.0F};
    int count = 0;
    const glm::ivec2 first = glm::max(pixel - kWindowRadius_px, glm::ivec2{0});
    const glm::ivec2 last = glm::min(pixel + kWindowRadius_px, truth.depth.size_px() - 1);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const Difference& difference = differences.at(x, y);
            if (!difference.known || !on_one_surface(truth, pixel, {x, y})) continue;
            sum += difference.value;
            sum_of_squares += difference.value * difference.value;
            ++count;
        }
    }
    if (count < kFewestSamples) return false;
    const auto n = static_cast<float>(count);
    const glm::vec3 mean = sum / n;
    const glm::vec3 variance = glm::max(sum_of_squares / n - mean * mean, glm::vec3{0.0F});
    for (int channel = 0; channel < 3; ++channel) {
        const float standard_error = std::sqrt(variance[channel] / n);
        if (std::abs(mean[channel]) > std::max(kVisibleDifference, kStandardErrors * standard_error)) return true;
    }
    return false;
}

double& part_of(AttributedError& error, ErrorCause cause) {
    switch (cause) {
        case ErrorCause::disoccluded:
            return error.disoccluded;
        case ErrorCause::out_of_frame:
            return error.out_of_frame;
        case ErrorCause::stale_shading:
            return error.stale_shading;
        case ErrorCause::resampled:
            break;
    }
    return error.resampled;
}

// Adds up value(i) by cause, over the number of pixels.
template <class Value>
AttributedError mean_by_cause(const Image<ErrorCause>& causes, Value value) {
    AttributedError error;
    const std::span<const ErrorCause> pixels = causes.pixels();
    if (pixels.empty()) return error;
    for (std::size_t i = 0; i < pixels.size(); ++i) part_of(error, pixels[i]) += value(i);
    const auto count = static_cast<double>(pixels.size());
    return {error.resampled / count, error.disoccluded / count, error.out_of_frame / count,
            error.stale_shading / count};
}

}  // namespace

Image<ErrorCause> error_causes(const SampledView& truth, const ColourImage& truth_colour, const SampledView& source,
                               const ColourImage& source_colour, int threads) {
    LW_CHECK(truth_colour.size_px() == truth.camera.size_px && source_colour.size_px() == source.camera.size_px,
             "colours of a view are of its camera's size");
    Image<ErrorCause> causes{truth.camera.size_px};
    Image<Difference> differences{truth.camera.size_px};
    match_surfaces(truth, source, threads, [&](int x, int y, const SurfacePlace& place) {
        causes.at(x, y) = cause_of(place.visibility);
        if (place.visibility != Visibility::seen) return;
        differences.at(x, y) = {source_srgb(source_colour, place) - srgb_of(truth_colour.at(x, y)), true};
    });
    for (int y = 0; y < causes.height(); ++y) {
        for (int x = 0; x < causes.width(); ++x) {
            if (causes.at(x, y) == ErrorCause::resampled && is_stale(truth, differences, {x, y})) {
                causes.at(x, y) = ErrorCause::stale_shading;
            }
        }
    }
    return causes;
}

AttributedError attribute_error(const Image<float>& error_map, const Image<ErrorCause>& causes) {
    LW_CHECK(error_map.size_px() == causes.size_px(), "an error map is attributed by causes of its own size");
    return mean_by_cause(causes, [&](std::size_t i) { return static_cast<double>(error_map.pixels()[i]); });
}

AttributedError shares_of(const Image<ErrorCause>& causes) {
    return mean_by_cause(causes, [](std::size_t) { return 1.0; });
}

}  // namespace lw
