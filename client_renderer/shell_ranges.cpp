#include "client_renderer/shell_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace lw {
namespace {

constexpr double kLeastRatio = 2.5;
constexpr double kOutdatedRatio = 2.0;
// Of a shell's inner distance: how far the eye may move before its draws and those of the shell before it gape.
constexpr double kOverlapPart = 0.2;
constexpr double kLeastOverlap_m = 0.2;
constexpr int kMostShells = 4;

double quantile(const std::vector<double>& sorted, double share) {
    const auto last = static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::lround(share * last))];
}

// Share of the distances up to `distance_m`.
double share_within(const std::vector<double>& sorted, double distance_m) {
    const auto end = std::upper_bound(sorted.begin(), sorted.end(), distance_m);
    return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

std::vector<double> cuts_of(const ShellRangeSettings& settings, std::vector<double> distances_m) {
    std::erase_if(distances_m, [](double d) { return !std::isfinite(d) || d <= 0.0; });
    std::sort(distances_m.begin(), distances_m.end());
    const double allowed_m = settings.pixels_per_tangent * settings.head_motion_m / settings.allowed_parallax_px;
    if (distances_m.empty()) distances_m = {allowed_m};
    std::vector<double> cuts{std::clamp(allowed_m, quantile(distances_m, 0.2), quantile(distances_m, 0.9))};
    const int most = settings.shells == 0 ? 3 : settings.shells;
    while (static_cast<int>(cuts.size()) + 1 < most) {
        const double farther = share_within(distances_m, cuts.back());
        const double middle_m = quantile(distances_m, 0.5 * (farther + 1.0));
        const bool worth_it = middle_m > kLeastRatio * cuts.back();
        if (settings.shells == 0 && !worth_it) break;
        cuts.push_back(std::max(middle_m, kLeastRatio * cuts.back()));
    }
    return cuts;
}

}  // namespace

std::vector<ShellRange> shell_ranges(const ShellRangeSettings& settings, std::span<const double> distances_m) {
    LW_CHECK(settings.shells == 0 || (settings.shells >= 2 && settings.shells <= kMostShells),
             fmt::format("{} shells", settings.shells));
    std::vector<ShellRange> ranges;
    double nearest_m = 0.0;
    for (const double cut_m : cuts_of(settings, {distances_m.begin(), distances_m.end()})) {
        ranges.push_back({nearest_m, cut_m, std::max(kOverlapPart * cut_m, kLeastOverlap_m)});
        nearest_m = cut_m;
    }
    ranges.push_back({nearest_m, std::numeric_limits<double>::infinity(), 0.0});
    return ranges;
}

bool ranges_outdated(std::span<const ShellRange> present, std::span<const ShellRange> wanted) {
    if (present.size() != wanted.size()) return true;
    for (std::size_t i = 1; i < present.size(); ++i) {
        const double ratio = wanted[i].nearest_m / present[i].nearest_m;
        if (!(ratio < kOutdatedRatio && ratio > 1.0 / kOutdatedRatio)) return true;
    }
    return false;
}

}  // namespace lw
