#pragma once
/// What storing depth in another format than ours costs.

#include <span>
#include <string_view>
#include <vector>

namespace lw::stability {

/// How a picture's depth may be stored. Reversed is near / distance, forward is 1 - near / distance; both with the far
/// plane at infinity, as a finite one moves no error by more than near / far.
enum class DepthFormat {
    float32_reversed,  ///< ours
    float32_forward,
    float32_distance,  ///< metres, as a frame folder may hold (depth_encoding distance_m), made ours when it is read
    unorm24_reversed,
    unorm24_forward,
    unorm16_reversed,
    unorm16_forward,
    float16_reversed,
};
[[nodiscard]] std::span<const DepthFormat> depth_formats();
[[nodiscard]] std::string_view name_of(DepthFormat format);

/// What comes back when a distance is stored in the format: reversed depth, near / distance. Pure.
/// @param distance_m  at least near_m
[[nodiscard]] double stored_depth(DepthFormat format, double distance_m, double near_m);

/// The largest relative error of the distance that rounding to nearest can leave, from the format's step alone:
/// half a step of the stored value over its slope there. 1 where nothing is left of it.
[[nodiscard]] double predicted_relative_error(DepthFormat format, double distance_m, double near_m);

/// Errors at one distance, measured over distances up to 1.4 times nearer and farther.
struct DepthError {
    double distance_m = 0.0;
    double relative = 0.0;            ///< of the distance, largest
    double predicted_relative = 0.0;  ///< of the same range
    double place_px = 0.0;            ///< where the pixel goes when the head moves sideways by kHeadTravel_m
};
inline constexpr double kHeadTravel_m = 0.1;
/// Pixels per unit tangent of 1024 px over 90 degrees.
inline constexpr double kFocal_px = 512.0;

/// Deterministic.
[[nodiscard]] DepthError measure_depth_error(DepthFormat format, double distance_m, double near_m);

}  // namespace lw::stability
