#include "core/eye_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"

namespace lw {
namespace {

// Side of the parts whose vertical disparity is measured: small enough to follow a disparity that changes over the
// picture, large enough that aliasing averages out.
constexpr int kTile_px = 64;
// A part says something when so many of its pixels are in pairs, and when their brightness changes by so much from row
// to row, root mean square of values in [0, 1].
constexpr double kFewestPairs = 512.0;
constexpr double kFaintestSlope = 0.02;
// And when its displacement is known so well, as a standard error in pixels: what edges scatter by, aliased or
// interpolated, is no displacement. Parts with one sharp edge and little else read 0.03 px in pictures that lie right.
constexpr double kMostUncertain_px = 0.02;
// Neighbours scatter alike: so many pixels tell as much as one.
constexpr double kPixelsAlike = 4.0;

// Where the other eye sees a pixel's surface.
struct Partner {
    glm::dvec2 position_px{0.0};
    std::array<float, 4> weights{};  // of the four pixels around; all 0 where it is not seen

    [[nodiscard]] bool is_seen() const { return weights[0] + weights[1] + weights[2] + weights[3] > 0.0F; }
};

Image<Partner> partners_in(const SampledView& from, const SampledView& to, int threads) {
    Image<Partner> partners{from.camera.size_px};
    match_surfaces(from, to, threads, [&](int x, int y, const SurfacePlace& place) {
        if (place.visibility == Visibility::seen) partners.at(x, y) = {place.position_px, place.weights};
    });
    return partners;
}

// Bilinear, of the four pixels around a place.
std::array<double, 4> shares_at(const glm::dvec2& position_px) {
    const glm::dvec2 part = position_px - 0.5 - glm::floor(position_px - 0.5);
    return {(1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y};
}

// Does the surface fill all of the place? Beside its edge another one, which lies elsewhere, is read too.
bool is_inside_of_surface(const Partner& partner) {
    const std::array<double, 4> shares = shares_at(partner.position_px);
    return std::equal(shares.begin(), shares.end(), partner.weights.begin(),
                      [](double share, float weight) { return std::abs(share - static_cast<double>(weight)) < 1e-3; });
}

// The four pixels around a place.
class Neighbours {
public:
    Neighbours(const glm::dvec2& position_px, glm::ivec2 size_px)
        : first_{glm::floor(position_px - 0.5)}, last_{size_px - 1} {}
    [[nodiscard]] glm::ivec2 at(std::size_t k) const {
        const glm::ivec2 step{static_cast<int>(k & 1U), static_cast<int>(k >> 1U)};
        return glm::clamp(first_ + step, glm::ivec2{0}, last_);
    }

private:
    glm::ivec2 first_;
    glm::ivec2 last_;
};

glm::dvec3 value_of(Rgba8 colour) { return glm::dvec3{colour.r, colour.g, colour.b} / 255.0; }

// On the surface alone.
glm::dvec3 colour_at(const ColourImage& picture, const Partner& partner) {
    const Neighbours around{partner.position_px, picture.size_px()};
    glm::dvec3 sum{0.0};
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::ivec2 pixel = around.at(k);
        sum += static_cast<double>(partner.weights[k]) * value_of(picture.at(pixel.x, pixel.y));
    }
    return sum;
}

double difference(const glm::dvec3& a, const glm::dvec3& b) { return std::sqrt(glm::dot(a - b, a - b) / 3.0); }

struct PairSums {
    double count = 0.0;
    double colour_excess = 0.0;
    double rivals = 0.0;
};

bool is_invented_at(const ShownEye& eye, const Partner& partner) {
    const auto nearest = std::max_element(partner.weights.begin(), partner.weights.end()) - partner.weights.begin();
    const glm::ivec2 pixel =
        Neighbours{partner.position_px, eye.invented.size_px()}.at(static_cast<std::size_t>(nearest));
    return eye.invented.at(pixel.x, pixel.y) != 0;
}

void add_pairs(const ShownEye& from, const ShownEye& to, const Image<Partner>& partners, PairSums& sums) {
    for (int y = 0; y < partners.height(); ++y) {
        for (int x = 0; x < partners.width(); ++x) {
            const Partner& partner = partners.at(x, y);
            if (!partner.is_seen()) continue;
            const double shown = difference(value_of(from.shown.at(x, y)), colour_at(to.shown, partner));
            const double truth = difference(value_of(from.truth_colour.at(x, y)), colour_at(to.truth_colour, partner));
            sums.count += 1.0;
            sums.colour_excess += std::max(0.0, shown - truth);
            sums.rivals += (from.invented.at(x, y) != 0) != is_invented_at(to, partner) ? 1.0 : 0.0;
        }
    }
}

using Brightness = Image<float>;

Brightness brightness_of(const ColourImage& picture) {
    Brightness brightness{picture.size_px()};
    for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
        const glm::dvec3 value = value_of(picture.pixels()[i]);
        brightness.pixels()[i] = static_cast<float>(glm::dot(value, glm::dvec3{0.299, 0.587, 0.114}));
    }
    return brightness;
}

double slope_at(const Brightness& picture, int x, int y) {
    const int above = std::max(y - 1, 0);
    const int below = std::min(y + 1, picture.height() - 1);
    return 0.5 * (static_cast<double>(picture.at(x, below)) - picture.at(x, above));
}

// Least squares over pairs of pixels: how much lower the second eye's brightness lies, to first order (Lucas and
// Kanade 1981, in one dimension).
struct Displacement {
    double slopes = 0.0;  // sum of slope^2
    double products = 0.0;
    double differences = 0.0;  // sum of difference^2

    void add(double first, double second, double slope) {
        slopes += slope * slope;
        products += slope * (first - second);
        differences += (first - second) * (first - second);
    }
    Displacement& operator+=(const Displacement& other) {
        slopes += other.slopes;
        products += other.products;
        differences += other.differences;
        return *this;
    }
    [[nodiscard]] double px() const { return products / slopes; }
    // Variance of px() over `count` pairs, from what the displacement does not explain of the differences.
    [[nodiscard]] double variance_px2(double count) const {
        const double unexplained = std::max(differences - products * products / slopes, 0.0);
        return kPixelsAlike * unexplained / (count * slopes);
    }
};

// One part of the picture: the pair as shown, and as it is in truth.
struct Tile {
    double count = 0.0;
    Displacement shown;
    Displacement truth;

    [[nodiscard]] bool has_texture() const {
        const double least = count * kFaintestSlope * kFaintestSlope;
        return count >= kFewestPairs && shown.slopes > least && truth.slopes > least;
    }
    [[nodiscard]] bool tells() const {
        if (!has_texture()) return false;
        return shown.variance_px2(count) + truth.variance_px2(count) <= kMostUncertain_px * kMostUncertain_px;
    }
    [[nodiscard]] double apart_px() const { return std::abs(shown.px() - truth.px()); }

    Tile& operator+=(const Tile& other) {
        count += other.count;
        shown += other.shown;
        truth += other.truth;
        return *this;
    }
};

struct EyeBrightness {
    Brightness shown;
    Brightness truth;
};

void add_pair(const Brightness& from, const Brightness& to, glm::ivec2 pixel, const glm::dvec2& position_px,
              Displacement& displacement) {
    const Neighbours around{position_px, to.size_px()};
    const std::array<double, 4> shares = shares_at(position_px);
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::ivec2 at = around.at(k);
        value += shares[k] * static_cast<double>(to.at(at.x, at.y));
        slope += shares[k] * slope_at(to, at.x, at.y);
    }
    displacement.add(from.at(pixel.x, pixel.y), value, 0.5 * (slope + slope_at(from, pixel.x, pixel.y)));
}

// A pixel that a fill made up is nobody's place.
std::optional<double> vertical_disparity_px(const ShownEye& left, const ShownEye& right,
                                            const Image<Partner>& partners) {
    const EyeBrightness from{brightness_of(left.shown), brightness_of(left.truth_colour)};
    const EyeBrightness to{brightness_of(right.shown), brightness_of(right.truth_colour)};
    const glm::ivec2 tiles = (partners.size_px() + kTile_px - 1) / kTile_px;
    Image<Tile> sums{tiles};
    for (int y = 0; y < partners.height(); ++y) {
        for (int x = 0; x < partners.width(); ++x) {
            const Partner& partner = partners.at(x, y);
            if (!partner.is_seen() || !is_inside_of_surface(partner) || left.invented.at(x, y) != 0 ||
                is_invented_at(right, partner))
                continue;
            Tile& tile = sums.at(x / kTile_px, y / kTile_px);
            tile.count += 1.0;
            add_pair(from.shown, to.shown, {x, y}, partner.position_px, tile.shown);
            add_pair(from.truth, to.truth, {x, y}, partner.position_px, tile.truth);
        }
    }
    double sum_px = 0.0;
    double count = 0.0;
    Tile whole;
    for (const Tile& tile : sums.pixels()) {
        whole += tile;
        if (!tile.tells()) continue;
        sum_px += tile.apart_px();
        count += 1.0;
    }
    if (count > 0.0) return sum_px / count;
    if (whole.has_texture()) return whole.apart_px();
    return std::nullopt;
}

}  // namespace

std::optional<EyeConsistency> eye_consistency(const ShownEye& left, const ShownEye& right, int threads) {
    for (const ShownEye* eye : {&left, &right}) {
        const glm::ivec2 size_px = eye->truth.camera.size_px;
        LW_CHECK(eye->shown.size_px() == size_px && eye->truth_colour.size_px() == size_px &&
                     eye->invented.size_px() == size_px && left.shown.size_px() == size_px,
                 "both eyes' pictures are of one size");
    }
    const Image<Partner> in_right = partners_in(left.truth, right.truth, threads);
    PairSums sums;
    add_pairs(left, right, in_right, sums);
    add_pairs(right, left, partners_in(right.truth, left.truth, threads), sums);
    if (sums.count == 0.0) return std::nullopt;
    return EyeConsistency{sums.colour_excess / sums.count, sums.rivals / sums.count,
                          vertical_disparity_px(left, right, in_right)};
}

}  // namespace lw
