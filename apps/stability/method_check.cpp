#include "apps/stability/method_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/stability/fixed_point_oracle.h"
#include "core/colour.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_footprint.h"

namespace lw::stability {
namespace {

// How sure a place may be missed before it counts as a hole: the bound itself.
constexpr Exact kBound_px = 0.02L;
// A sample takes its depth along when its place is off. A steep surface, 2 % per pixel, then shows 1e-5 of its depth
// for half a thousandth of a pixel, so depths are compared with those of this surrounding.
constexpr Exact kBeside_px = 1e-3L;

// An 8-bit value stands for an interval: half a step of rounding, 0.1 of the curve's approximation. Bilinear reads in
// 15 bits round twice.
constexpr double kColourSteps = 0.6;
constexpr double kFixedPoint = 1e-4;

struct Interval {
    double low;
    double high;
};

Interval linear_interval(std::uint8_t value) {
    const auto linear = [](double steps) { return linear_from_srgb(std::clamp(steps / 255.0, 0.0, 1.0)); };
    return {linear(value - kColourSteps) - kFixedPoint, linear(value + kColourSteps) + kFixedPoint};
}

const std::array<Interval, 256>& linear_intervals() {
    static const std::array<Interval, 256> intervals = [] {
        std::array<Interval, 256> made{};
        for (int i = 0; i < 256; ++i) made[static_cast<std::size_t>(i)] = linear_interval(static_cast<std::uint8_t>(i));
        return made;
    }();
    return intervals;
}

// The lattice rises and falls by 1 per pixel. Signed distance from the expected place to the nearest one that the
// colour allows, source pixels.
Exact lattice_excess_px(std::uint8_t value, Exact place_px, int size) {
    const Exact u = std::clamp(place_px - 0.5L, Exact{0}, Exact(size - 1));
    const Exact below = std::floor(u);
    const bool rises = static_cast<std::int64_t>(below) % 2 == 0;
    const Exact part = u - below;
    const Exact expected = rises ? part : 1 - part;
    const Interval shown = linear_intervals()[value];
    Exact difference = 0;
    if (expected < shown.low) difference = shown.low - expected;
    if (expected > shown.high) difference = shown.high - expected;
    return rises ? difference : -difference;
}

constexpr int kComparedPixels = 400;

class Checker {
public:
    Checker(const PictureOracle& oracle, const Layer& layer, MethodKind kind, const DisplayFrame& frame)
        : oracle_{oracle}, layer_{layer}, pixels_{layer.cpu()}, kind_{kind}, frame_{frame} {}

    MethodErrors check() {
        errors_.cases = 1;
        const int width = frame_.colour.width();
        const int count = width * frame_.colour.height();
        for (int i = 0; i < count; ++i) check_depth(i % width, i / width);
        // Of large pictures a part, evenly: exact places take a microsecond each.
        const int step = std::max(1, count / kComparedPixels) | 1;
        for (int i = static_cast<int>(oracle_.of_case().seed % static_cast<std::uint64_t>(step)); i < count;
             i += step) {
            check_pixel(i % width, i / width);
        }
        errors_.faulty_cases = errors_.faults() > 0 ? 1 : 0;
        return errors_;
    }

private:
    [[nodiscard]] bool reached(int x, int y) const { return frame_.coverage.at(x, y) == Coverage::reached; }

    void fault(std::uint64_t& count, int x, int y) {
        ++count;
        errors_.first_fault.take(1.0, oracle_.of_case().seed, x, y);
    }
    void place_error(Exact error_px, int x, int y) {
        errors_.place_px.take(static_cast<double>(error_px), oracle_.of_case().seed, x, y);
    }
    void depth_error(Exact shown, Exact expected, int x, int y) {
        const Exact error = expected > 0 ? std::abs(shown - expected) / expected : std::abs(shown);
        errors_.depth.take(static_cast<double>(error), oracle_.of_case().seed, x, y);
    }

    void check_depth(int x, int y) {
        if (reached(x, y) && !is_usable_depth(frame_.depth.at(x, y))) fault(errors_.unusable, x, y);
    }

    void check_pixel(int x, int y) {
        const ExpectedPixel expected = oracle_.at(x, y);
        if (expected.kind == ExpectedPixel::Kind::unclear) return;
        if (expected.kind == ExpectedPixel::Kind::nothing) {
            // A search goes inwards from the image's edge; sheets are stretched over nothing.
            if (kind_ == MethodKind::fixed_point || kind_ == MethodKind::sheets) return;
            ++errors_.pixels;
            if (reached(x, y)) fault(errors_.invented, x, y);
            return;
        }
        if (expected.largest_stretch > kLargestStretch || expected.smallest_stretch < kSmallestStretch) return;
        switch (kind_) {
            case MethodKind::points:
            case MethodKind::squares:
                check_point(expected, x, y);
                return;
            case MethodKind::lattice:
                check_lattice(expected, expected.source_px, nearest_depth(expected, x, y), x, y);
                return;
            case MethodKind::sheets:
                check_sheet(expected, x, y);
                return;
            case MethodKind::turned:
            case MethodKind::unturned:
                check_turned(expected, x, y);
                return;
            case MethodKind::fixed_point:
                check_search(expected, x, y);
                return;
        }
    }

    void check_point(const ExpectedPixel& expected, int x, int y) {
        ++errors_.pixels;
        if (!reached(x, y)) {
            if (must_be_reached(expected, x, y)) fault(errors_.missing, x, y);
            return;
        }
        const auto index = static_cast<int>(index_of_colour(frame_.colour.at(x, y)));
        const int width = pixels_.depth.width();
        const int source_x = index % width;
        const int source_y = index / width;
        if (source_y >= pixels_.depth.height() || oracle_.region_of(source_x, source_y) != expected.region) {
            // Points of a steep surface leave cracks, through which what is behind shows.
            if (must_be_reached(expected, x, y)) fault(errors_.wrong_surface, x, y);
            return;
        }
        const ExactVec2 centre{source_x + 0.5L, source_y + 0.5L};
        const auto placed = oracle_.place(expected.region, centre, pixels_.depth.at(source_x, source_y));
        if (!placed) {
            fault(errors_.wrong_surface, x, y);
            return;
        }
        const ExactVec2 half = half_extents(expected.region, source_x, source_y, *placed);
        Exact excess = std::max(std::abs(x + 0.5L - placed->position_px.x) - half.x,
                                std::abs(y + 0.5L - placed->position_px.y) - half.y);
        if (placed->depth == 0) {
            // Background may also be looked up: the source pixel in whose square the place is.
            const Exact beside =
                std::max(std::abs(expected.source_px.x - centre.x), std::abs(expected.source_px.y - centre.y)) - 0.5L;
            excess = std::min(excess, beside * expected.largest_stretch);
        }
        place_error(excess, x, y);
        depth_error(frame_.depth.at(x, y), placed->depth, x, y);
    }

    // The exact counterpart of footprint_of().
    [[nodiscard]] ExactVec2 half_extents(int region, int source_x, int source_y, const ExactPlace& placed) const {
        const DepthGradient gradient = depth_gradient(pixels_.depth, pixels_.object_id, source_x, source_y);
        const Exact step = 1.0L / 1024;
        const ExactVec2 centre{source_x + 0.5L, source_y + 0.5L};
        const Exact depth = pixels_.depth.at(source_x, source_y);
        const auto along_x = oracle_.place(region, {centre.x + step, centre.y}, depth + step * gradient.x);
        const auto along_y = oracle_.place(region, {centre.x, centre.y + step}, depth + step * gradient.y);
        if (!along_x || !along_y) return {kLargestHalfExtentPx, kLargestHalfExtentPx};
        const auto half = [&](Exact ExactVec2::*axis) {
            const Exact sum = std::abs(along_x->position_px.*axis - placed.position_px.*axis) +
                              std::abs(along_y->position_px.*axis - placed.position_px.*axis);
            // One-sided differences over a thousandth of a pixel: their bend is far below the bound.
            return std::clamp(0.5L * sum / step, 0.5L, Exact{kLargestHalfExtentPx});
        };
        const ExactVec2 halves{half(&ExactVec2::x), half(&ExactVec2::y)};
        const Exact larger = std::max(halves.x, halves.y);
        return kind_ == MethodKind::squares ? ExactVec2{larger, larger} : halves;
    }

    // Does the point of a source pixel around the expected place cover the pixel's centre for certain?
    [[nodiscard]] bool must_be_reached(const ExpectedPixel& expected, int x, int y) const {
        const int middle_x = static_cast<int>(expected.source_px.x);
        const int middle_y = static_cast<int>(expected.source_px.y);
        for (int source_y = middle_y - 1; source_y <= middle_y + 1; ++source_y) {
            for (int source_x = middle_x - 1; source_x <= middle_x + 1; ++source_x) {
                if (oracle_.region_of(source_x, source_y) != expected.region) continue;
                const auto placed = oracle_.place(expected.region, {source_x + 0.5L, source_y + 0.5L},
                                                  pixels_.depth.at(source_x, source_y));
                if (!placed || placed->depth > 0.999L) continue;
                if (kind_ == MethodKind::squares && !in_picture(placed->position_px)) continue;
                const ExactVec2 half = half_extents(expected.region, source_x, source_y, *placed);
                if (std::abs(x + 0.5L - placed->position_px.x) < half.x - kBound_px &&
                    std::abs(y + 0.5L - placed->position_px.y) < half.y - kBound_px) {
                    return true;
                }
            }
        }
        return false;
    }

    [[nodiscard]] bool in_picture(const ExactVec2& place_px) const {
        return place_px.x > kBound_px && place_px.x < frame_.colour.width() - kBound_px && place_px.y > kBound_px &&
               place_px.y < frame_.colour.height() - kBound_px;
    }

    // The source place that the colour tells, against the one it must be.
    void check_lattice(const ExpectedPixel& expected, const ExactVec2& source_px, Exact depth, int x, int y) {
        ++errors_.pixels;
        if (!reached(x, y)) {
            fault(errors_.missing, x, y);
            return;
        }
        const Rgba8 colour = frame_.colour.at(x, y);
        const ExactVec2 excess{lattice_excess_px(colour.r, source_px.x, pixels_.depth.width()),
                               lattice_excess_px(colour.g, source_px.y, pixels_.depth.height())};
        const auto jacobian = oracle_.jacobian_at(expected.region, source_px);
        if (!jacobian) return;
        const Exact off_x = jacobian->along_x.x * excess.x + jacobian->along_y.x * excess.y;
        const Exact off_y = jacobian->along_x.y * excess.x + jacobian->along_y.y * excess.y;
        place_error(std::hypot(off_x, off_y), x, y);
        depth_error(frame_.depth.at(x, y), depth, x, y);
    }

    // What has another depth is a sheet.
    void check_sheet(const ExpectedPixel& expected, int x, int y) {
        const Exact off = std::abs(frame_.depth.at(x, y) - expected.depth);
        if (!reached(x, y) || off > 1e-4L * expected.depth) return;
        check_lattice(expected, expected.source_px, nearest_depth(expected, x, y), x, y);
    }

    // The depth around the pixel's centre that is nearest to the shown one.
    [[nodiscard]] Exact nearest_depth(const ExpectedPixel& expected, int x, int y) const {
        const auto around = oracle_.depth_around(expected.region, {x + 0.5L, y + 0.5L}, kBeside_px);
        return std::clamp(Exact{frame_.depth.at(x, y)}, around.low, std::max(around.low, around.high));
    }

    // Depth comes from the nearest source pixel, so places beside a pixel's edge are left out.
    void check_turned(const ExpectedPixel& expected, int x, int y) {
        const ExactVec2& place = expected.source_px;
        if (near_pixel_edge(place.x) || near_pixel_edge(place.y)) return;
        const float depth = pixels_.depth.at(static_cast<int>(place.x), static_cast<int>(place.y));
        const auto placed = oracle_.place(expected.region, place, depth);
        if (!placed || placed->depth > 1) return;
        check_lattice(expected, place, placed->depth, x, y);
    }

    void check_search(const ExpectedPixel& expected, int x, int y) {
        const auto found = search_fixed_point(oracle_, pixels_, x, y);
        if (!found || near_pixel_edge(found->source_px.x) || near_pixel_edge(found->source_px.y)) return;
        if (!reached(x, y)) {
            fault(errors_.missing, x, y);
            return;
        }
        ExpectedPixel searched = expected;
        searched.region = found->region;
        const float own = pixels_.depth.at(static_cast<int>(found->source_px.x), static_cast<int>(found->source_px.y));
        Exact nearest = found->depth;
        const Exact shown = frame_.depth.at(x, y);
        for (const ExactVec2& step : {ExactVec2{kBeside_px, 0}, {-kBeside_px, 0}, {0, kBeside_px}, {0, -kBeside_px}}) {
            const ExactVec2 place{found->source_px.x + step.x, found->source_px.y + step.y};
            const auto beside = oracle_.place(found->region, place, own);
            if (!beside) continue;
            const Exact low = std::min(found->depth, beside->depth);
            const Exact high = std::max(found->depth, beside->depth);
            const Exact closest = std::clamp(shown, low, high);
            if (std::abs(closest - shown) < std::abs(nearest - shown)) nearest = closest;
        }
        check_lattice(searched, found->source_px, nearest, x, y);
    }

    [[nodiscard]] static bool near_pixel_edge(Exact place) { return std::abs(place - std::round(place)) < kBound_px; }

    const PictureOracle& oracle_;
    const Layer& layer_;
    const CpuPixels& pixels_;
    MethodKind kind_;
    const DisplayFrame& frame_;
    MethodErrors errors_;
};

}  // namespace

void MethodErrors::add(const MethodErrors& other) {
    cases += other.cases;
    faulty_cases += other.faulty_cases;
    pixels += other.pixels;
    place_px.take(other.place_px);
    depth.take(other.depth);
    wrong_surface += other.wrong_surface;
    missing += other.missing;
    invented += other.invented;
    unusable += other.unusable;
    first_fault.take(other.first_fault);
}

MethodKind kind_of(std::string_view method) {
    const std::string_view name = method.substr(0, method.find(':'));
    if (name == "stale") return MethodKind::unturned;
    if (name == "rotation") return MethodKind::turned;
    if (name == "inverse" || name == "inverse-gl") return MethodKind::fixed_point;
    if (name == "surface" || name == "surface-gl") return MethodKind::lattice;
    if (name == "points") return MethodKind::squares;
    if (name == "mesh") return MethodKind::sheets;
    return MethodKind::points;
}

OracleMotion motion_of(MethodKind kind) {
    if (kind == MethodKind::turned) return OracleMotion::rotation;
    return kind == MethodKind::unturned ? OracleMotion::none : OracleMotion::full;
}

CasePattern pattern_of(MethodKind kind) {
    const bool shows_pixels = kind == MethodKind::points || kind == MethodKind::squares;
    return shows_pixels ? CasePattern::index : CasePattern::lattice;
}

MethodErrors check_picture(const PictureOracle& oracle, const Layer& layer, MethodKind kind,
                           const DisplayFrame& frame) {
    return Checker{oracle, layer, kind, frame}.check();
}

}  // namespace lw::stability
