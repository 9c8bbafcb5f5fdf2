#include "apps/stability/origin_sweep.h"

#include <algorithm>
#include <cmath>

#include "apps/stability/case_random.h"
#include "apps/stability/exact_reprojection.h"
#include "core/reprojection.h"

namespace lw::stability {
namespace {

double off_px(const ExactPlace& exact, double x_px, double y_px) {
    return static_cast<double>(std::hypot(exact.position_px.x - x_px, exact.position_px.y - y_px));
}

// The textbook chain: clip_from_eye * eye_from_world * world_from_eye * eye_from_px, with world coordinates in it.
template <class Matrix>
Matrix absolute_chain(const Camera& source, const Camera& target) {
    return Matrix{target_px_from_target_clip(target).matrix} * Matrix{target_clip_from_target_eye(target).matrix} *
           Matrix{inverse_matrix_of(target.world_from_eye)} * Matrix{matrix_of(source.world_from_eye)} *
           Matrix{source_eye_from_source_px(source).matrix};
}

}  // namespace

OriginErrors measure_origin_errors(double distance_m, int cases) {
    CaseRandom random{5};
    OriginErrors errors{distance_m, 0.0, 0.0, 0.0};
    Camera source;
    source.size_px = {1024, 1024};
    for (int i = 0; i < cases; ++i) {
        source.world_from_eye = {random.direction() * distance_m, random.rotation()};
        Camera target = source;
        target.world_from_eye.position_m += random.direction() * random.uniform(0.0, 0.1);
        const glm::dquat turn = glm::angleAxis(random.uniform(0.0, 0.2), random.direction());
        target.world_from_eye.orientation = glm::normalize(turn * source.world_from_eye.orientation);
        const glm::dvec2 place_px{random.uniform(256.0, 768.0), random.uniform(256.0, 768.0)};
        const double depth = source.near_m / random.log_uniform(0.5, 10.0);
        const auto exact = ExactReprojection{source, target, nullptr}.place(place_px.x, place_px.y, depth);
        const auto ours = reproject(static_target_px_from_source_px(source, target), place_px, depth);
        if (!exact || !ours) continue;
        errors.ours_px = std::max(errors.ours_px, off_px(*exact, ours->position_px.x, ours->position_px.y));
        const glm::dvec4 wide = absolute_chain<glm::dmat4>(source, target) * glm::dvec4{place_px, 1.0, depth};
        errors.absolute_double_px =
            std::max(errors.absolute_double_px, off_px(*exact, wide.x / wide.w, wide.y / wide.w));
        const glm::vec4 narrow =
            absolute_chain<glm::mat4>(source, target) * glm::vec4{glm::dvec4{place_px, 1.0, depth}};
        // A w of 0 puts the place nowhere: as far off as the picture is wide.
        const double narrow_px =
            off_px(*exact, static_cast<double>(narrow.x / narrow.w), static_cast<double>(narrow.y / narrow.w));
        errors.absolute_float_px =
            std::max(errors.absolute_float_px, std::isfinite(narrow_px) ? std::min(narrow_px, 1024.0) : 1024.0);
    }
    return errors;
}

}  // namespace lw::stability
