#pragma once
/// The distances at which the scene is cut into shells around the viewer.

#include <optional>
#include <span>
#include <vector>

namespace lw {

struct ShellRangeSettings {
    int shells = 0;                    ///< 2 to 4; 0: as many as the scene's distances ask for, 2 or 3
    double pixels_per_tangent = 512;   ///< of the display, at its centre
    double head_motion_m = 0.5;        ///< by which the head moves between two draws of an outer shell, about
    double allowed_parallax_px = 2.0;  ///< by which the content of an outer shell may shift against the sky meanwhile
};

/// One shell: what lies from nearest_m on and nearer than farthest_m. Draws reach beyond by `overlap_m`, so that two
/// shells drawn from eyes up to that far apart leave no gap between them.
struct ShellRange {
    double nearest_m = 0.0;
    double farthest_m = 0.0;
    double overlap_m = 0.0;  ///< added to farthest_m when it is drawn; 0 for the last shell
};

/// Ranges from the viewer outwards; they meet, the first begins at 0, the last ends at infinity.
/// @param distances_m  of what is around the viewer, one for each of equally many pixels; any order, > 0, may be empty
/// The first cut is where the parallax becomes allowed: pixels_per_tangent * head_motion_m / allowed_parallax_px. It
/// stays between the fifth and nine tenths of the distances, so that neither side is empty. Each further one is
/// half-way in pixels between the last cut and the farthest thing, and at least 2.5 times as far.
/// Pure, any thread.
[[nodiscard]] std::vector<ShellRange> shell_ranges(const ShellRangeSettings& settings,
                                                   std::span<const double> distances_m);

/// Whether `wanted` is so different that drawing everything anew is worth it: another number of shells, or a cut that
/// moved by more than a factor of 2. A viewer at a boundary does not make it swing.
[[nodiscard]] bool ranges_outdated(std::span<const ShellRange> present, std::span<const ShellRange> wanted);

}  // namespace lw
