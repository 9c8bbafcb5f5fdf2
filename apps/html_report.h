#pragma once
/// One self-contained HTML page: tables, line plots as inline SVG, embedded pictures. Nothing is loaded from elsewhere.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "apps/svg_lanes.h"
#include "apps/svg_plot.h"
#include "core/result.h"

namespace lw {

/// One curve. A value that is not finite interrupts it.
struct PlotSeries {
    std::string label;
    std::vector<double> values;  ///< as many as the plot has x values
};

struct LinePlot {
    std::string title;
    std::string x_label;
    std::string y_label;
    std::vector<double> x;  ///< ascending
    std::vector<PlotSeries> series;
};

/// Gathers a page from top to bottom. Texts are escaped. One thread.
class HtmlReport {
public:
    explicit HtmlReport(const std::string& title);

    void add_heading(const std::string& text);
    void add_paragraph(const std::string& text);
    /// The first row holds the column titles; the first column is aligned left, all others right.
    void add_table(const std::vector<std::vector<std::string>>& rows);
    /// Plots with fewer than two x values are left out.
    void add_plot(const LinePlot& plot);
    /// With the plot's title as its heading.
    void add_plot(const SvgPlot& plot);
    void add_lanes(const SvgLanes& lanes);
    void add_png(std::span<const std::uint8_t> png_bytes, const std::string& caption);

    [[nodiscard]] std::string text() const;

private:
    std::string title_;
    std::string body_;
};

/// Three significant digits, "-" for what is not finite: how the tables show numbers.
[[nodiscard]] std::string short_number(double number);

}  // namespace lw
