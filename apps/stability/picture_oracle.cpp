#include "apps/stability/picture_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lw::stability {
namespace {

// Bilinear reads, depth gradients and links between pixels look up to two pixels around.
constexpr Exact kInside_px = 2.0L;

// A surface that reaches this far beyond its region's edge cannot show at the pixel any more: the largest splat is 2
// target pixels to each side, and a method joins neighbours up to a pixel beyond.
Exact reach_px(Exact smallest_stretch) { return 2 + 3 / std::max(smallest_stretch, Exact{1e-6}); }

// A splat reaches 2 pixels; and a pixel has its own half.
constexpr Exact kReach_px = 2.5L;
constexpr Exact kMagnified = 4;

// The nearest that a plane is within the reach of a splat around a target pixel; 1 where it reaches an eye plane.
Exact nearest_around(const ExactHomography& homography, int x, int y) {
    Exact nearest = 0;
    for (const Exact dx : {-kReach_px, kReach_px}) {
        for (const Exact dy : {-kReach_px, kReach_px}) {
            const auto source = homography.source_of(x + 0.5L + dx, y + 0.5L + dy);
            nearest = std::max(nearest, source ? source->target_depth : Exact{1});
        }
    }
    return nearest;
}

}  // namespace

PictureOracle::PictureOracle(const StabilityCase& made, OracleMotion motion) : made_{made}, target_{made.target} {
    if (motion == OracleMotion::none) target_.world_from_eye = made.source.world_from_eye;
    if (motion == OracleMotion::rotation) target_.world_from_eye.position_m = made.source.world_from_eye.position_m;
    if (motion != OracleMotion::full) {
        // All is at infinity: one region.
        CaseRegion all{0, 0, made.source.size_px.x, made.source.size_px.y, 0, {}};
        const ExactReprojection reprojection{made.source, target_, nullptr};
        moved_.push_back(moved_region(all, reprojection));
        return;
    }
    for (const CaseRegion& region : made.regions) {
        const std::optional<MoverMotion> of_region = made.motion_of(region.id);
        const ExactReprojection reprojection{made.source, target_, of_region ? &*of_region : nullptr};
        moved_.push_back(moved_region(region, reprojection));
    }
}

PictureOracle::Moved PictureOracle::moved_region(const CaseRegion& region, const ExactReprojection& reprojection) {
    Moved moved{region, reprojection, ExactHomography::of(reprojection, region.plane), {}, {}, -1};
    bool first = true;
    for (const int x : {region.x0, region.x1}) {
        for (const int y : {region.y0, region.y1}) {
            const auto corner = reprojection.place(x, y, region.plane.at(x, y));
            if (!corner) {
                moved.nearest = -1;
                return moved;
            }
            const ExactVec2& place = corner->position_px;
            moved.low_px =
                first ? place : ExactVec2{std::min(moved.low_px.x, place.x), std::min(moved.low_px.y, place.y)};
            moved.high_px =
                first ? place : ExactVec2{std::max(moved.high_px.x, place.x), std::max(moved.high_px.y, place.y)};
            moved.nearest = std::max(moved.nearest, corner->depth);
            first = false;
        }
    }
    return moved;
}

ExpectedPixel PictureOracle::at(int x, int y) const {
    ExpectedPixel found;
    found.kind = ExpectedPixel::Kind::nothing;
    bool is_magnified = false;
    Exact nearest_other = -1;  // of surfaces whose surroundings reach the pixel
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const Moved& moved = moved_[i];
        if (!moved.homography) return {};  // collapsed: anything may lie on its line
        const auto source = moved.homography->source_of(x + 0.5L, y + 0.5L);
        const bool in_box = moved.box_holds(x + 0.5L, y + 0.5L, kReach_px);
        if (!source) {
            if (in_box) nearest_other = std::max(nearest_other, moved.nearest);
            continue;
        }
        const ExactJacobian jacobian = moved.homography->jacobian_at(source->place_px);
        const Exact smallest = jacobian.smallest_stretch();
        if (!moved.region.contains(source->place_px, -reach_px(smallest))) {
            if (in_box) nearest_other = std::max(nearest_other, moved.nearest);
            const bool close = moved.region.contains(source->place_px, -reach_px(smallest) - kReach_px);
            is_magnified = is_magnified || (close && jacobian.largest_stretch() > kMagnified);
            continue;
        }
        const Exact depth = source->target_depth;
        // From its back a surface may show (as points) or not (as a surface).
        if (jacobian.determinant() <= 0) return {};
        const bool inside = moved.region.contains(source->place_px, kInside_px) && depth >= 0 && depth <= 0.999L;
        if (!inside) {
            nearest_other = std::max(nearest_other, nearest_around(*moved.homography, x, y));
            continue;
        }
        if (found.kind == ExpectedPixel::Kind::surface && depth < found.depth) {
            nearest_other = std::max(nearest_other, nearest_around(*moved.homography, x, y));
            continue;
        }
        if (found.kind == ExpectedPixel::Kind::surface) {
            const Moved& hidden = moved_[static_cast<std::size_t>(found.region)];
            nearest_other = std::max(nearest_other, nearest_around(*hidden.homography, x, y));
        }
        found.kind = ExpectedPixel::Kind::surface;
        found.region = static_cast<int>(i);
        found.source_px = source->place_px;
        found.depth = depth;
        found.largest_stretch = jacobian.largest_stretch();
        found.smallest_stretch = smallest;
    }
    if (is_magnified && found.kind == ExpectedPixel::Kind::nothing) return {};  // rims are as wide as pixels are large
    // 2 %: more than any two samples of one depth step differ.
    if (nearest_other >= 0 && nearest_other >= 0.98L * std::max(found.depth, Exact{0}))
        found.kind = ExpectedPixel::Kind::unclear;
    return found;
}

std::optional<ExactPlace> PictureOracle::place(int region, const ExactVec2& source_px, Exact depth) const {
    return moved_[static_cast<std::size_t>(region)].reprojection.place(source_px.x, source_px.y, depth);
}

std::optional<ExactJacobian> PictureOracle::jacobian_at(int region, const ExactVec2& source_px) const {
    const Moved& moved = moved_[static_cast<std::size_t>(region)];
    if (!moved.homography) return std::nullopt;
    return moved.homography->jacobian_at(source_px);
}

PictureOracle::DepthRange PictureOracle::depth_around(int region, const ExactVec2& target_px, Exact margin_px) const {
    const Moved& moved = moved_[static_cast<std::size_t>(region)];
    DepthRange range{std::numeric_limits<Exact>::max(), 0};
    for (const Exact dx : {-margin_px, margin_px}) {
        for (const Exact dy : {-margin_px, margin_px}) {
            const auto source = moved.homography->source_of(target_px.x + dx, target_px.y + dy);
            if (!source) continue;
            range.low = std::min(range.low, source->target_depth);
            range.high = std::max(range.high, source->target_depth);
        }
    }
    return range;
}

int PictureOracle::region_of(int x, int y) const {
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const CaseRegion& region = moved_[i].region;
        if (x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1) return static_cast<int>(i);
    }
    return -1;
}

}  // namespace lw::stability
