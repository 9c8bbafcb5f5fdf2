#include "core/flicker.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {
namespace {

glm::ivec3 values_of(Rgba8 colour) { return {colour.r, colour.g, colour.b}; }

}  // namespace

Image<int> pixels_before(const SampledView& now, const SampledView& before, int threads) {
    Image<int> indices{now.camera.size_px, -1};
    const int width = before.camera.size_px.x;
    match_surfaces(now, before, threads, [&](int x, int y, const SurfacePlace& place) {
        if (place.visibility != Visibility::seen) return;
        const auto best = std::max_element(place.weights.begin(), place.weights.end()) - place.weights.begin();
        const glm::ivec2 pixel = place.neighbours[static_cast<std::size_t>(best)];
        indices.at(x, y) = pixel.y * width + pixel.x;
    });
    return indices;
}

std::optional<double> flicker(const ColourImage& truth_now, const ColourImage& shown_now,
                              const ColourImage& truth_before, const ColourImage& shown_before,
                              const Image<int>& pixels_before) {
    const glm::ivec2 size_px = truth_now.size_px();
    LW_CHECK(shown_now.size_px() == size_px && truth_before.size_px() == size_px && shown_before.size_px() == size_px &&
                 pixels_before.size_px() == size_px,
             "flicker compares images of one size");
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixels_before.pixels().size(); ++i) {
        const int before = pixels_before.pixels()[i];
        if (before < 0) continue;
        const auto j = static_cast<std::size_t>(before);
        const glm::ivec3 error_now = values_of(shown_now.pixels()[i]) - values_of(truth_now.pixels()[i]);
        const glm::ivec3 error_before = values_of(shown_before.pixels()[j]) - values_of(truth_before.pixels()[j]);
        const glm::dvec3 change{error_now - error_before};
        sum += std::sqrt(glm::dot(change, change) / 3.0) / 255.0;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

}  // namespace lw
