#pragma once
/// Line and scatter plots as SVG: axes with round steps, linear or logarithmic, a legend, notes beside points. For
/// every report and suite that shows numbers; nothing in the picture is loaded from elsewhere.
///
///     SvgPlot plot{"Error against frame age", "frame age, ms", "FLIP"};
///     plot.series.push_back({"surface", {20, 50, 100}, {0.05, 0.06, 0.07}});
///     plot.series.push_back({"rotation", {20, 50, 100}, {0.06, 0.10, 0.17}});
///     page.add_plot(plot);                                                        // in an HtmlReport
///     write_text("age.svg", svg_of(plot, SvgUse::standalone));                    // or as a file

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/svg_parts.h"

namespace lw {

enum class SvgMarks {
    line,    ///< a curve
    points,  ///< a marker at every point
    both,
};

/// One curve or cloud. A point with a coordinate that is not finite, or not positive on a logarithmic axis, is left out
/// and interrupts the curve.
struct SvgSeries {
    std::string label;  ///< empty: not in the legend
    std::vector<double> x;
    std::vector<double> y;  ///< as many as x
    SvgMarks marks = SvgMarks::both;
    bool dashed = false;
    /// Colour and shape of the marker; by default the series' place in the plot. Equal numbers look equal in all plots.
    std::optional<std::size_t> style = std::nullopt;
    std::vector<std::string> notes = {};  ///< written beside the points; as many as x, or none
};

struct SvgPlot {
    std::string title;
    std::string x_label;
    std::string y_label;
    bool log_x = false;
    bool log_y = false;
    bool x_from_zero = false;  ///< the axis begins at 0, linear axes only
    bool y_from_zero = false;
    std::vector<SvgSeries> series = {};
    double width_px = 900.0;  ///< legend included; > 300
    double height_px = 360.0;
};

/// The whole <svg> element, ending with a line break. A plot without a usable point has empty axes. Equal plots give
/// equal bytes. Pure, any thread.
[[nodiscard]] std::string svg_of(const SvgPlot& plot, SvgUse use);

}  // namespace lw
