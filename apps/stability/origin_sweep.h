#pragma once
/// What is lost far from the world's origin, with our composition and with two that others use.

#include <cstdint>

namespace lw::stability {

/// Largest errors of places in the picture, px, over random cases with the camera at one distance from the origin.
struct OriginErrors {
    double distance_m = 0.0;
    double ours_px = 0.0;             ///< matrices relative to the source eye, in double
    double absolute_double_px = 0.0;  ///< view and world matrices multiplied in double
    double absolute_float_px = 0.0;   ///< the same in float
};

/// Heads that move up to 10 cm before something 0.5 to 10 m away, 1024 x 1024 px over 90 degrees. Deterministic.
[[nodiscard]] OriginErrors measure_origin_errors(double distance_m, int cases);

}  // namespace lw::stability
