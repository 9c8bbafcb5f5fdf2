#include "apps/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lw {

namespace {

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:960px;margin:2em auto;padding:0 1em;color:#1b1b1b}"
    "h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
    "td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}"
    "td:first-child,th:first-child{text-align:left}"
    "svg text{font:12px system-ui,sans-serif;fill:#444}img{max-width:100%}figcaption{color:#555}figure{margin:1em 0}";

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

}  // namespace

HtmlReport::HtmlReport(const std::string& title) : title_{title} {}

void HtmlReport::add_heading(const std::string& text) { body_ += fmt::format("<h2>{}</h2>\n", xml_escaped(text)); }
void HtmlReport::add_paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", xml_escaped(text)); }

void HtmlReport::add_table(const std::vector<std::vector<std::string>>& rows) {
    body_ += "<table>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const char* tag = i == 0 ? "th" : "td";
        body_ += "<tr>";
        for (const std::string& cell : rows[i]) body_ += fmt::format("<{0}>{1}</{0}>", tag, xml_escaped(cell));
        body_ += "</tr>\n";
    }
    body_ += "</table>\n";
}

void HtmlReport::add_plot(const SvgPlot& plot) {
    body_ += fmt::format("<h2>{}</h2>\n{}", xml_escaped(plot.title), svg_of(plot, SvgUse::inside_html));
}

void HtmlReport::add_lanes(const SvgLanes& lanes) {
    body_ += fmt::format("<h2>{}</h2>\n{}", xml_escaped(lanes.title), svg_of(lanes, SvgUse::inside_html));
}

void HtmlReport::add_plot(const LinePlot& plot) {
    if (plot.x.size() < 2) return;
    SvgPlot svg{plot.title, plot.x_label, plot.y_label};
    for (const PlotSeries& series : plot.series) {
        const std::size_t count = std::min(series.values.size(), plot.x.size());
        const auto end = [count](const std::vector<double>& all) {
            return all.begin() + static_cast<std::ptrdiff_t>(count);
        };
        svg.series.push_back(
            {series.label, {plot.x.begin(), end(plot.x)}, {series.values.begin(), end(series.values)}, SvgMarks::line});
    }
    add_plot(svg);
}

void HtmlReport::add_png(std::span<const std::uint8_t> png_bytes, const std::string& caption) {
    body_ +=
        fmt::format("<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                    base64(png_bytes), xml_escaped(caption), xml_escaped(caption));
}

std::string HtmlReport::text() const {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
        "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
        xml_escaped(title_), kStyle, body_);
}

std::string short_number(double number) { return std::isfinite(number) ? fmt::format("{:.3g}", number) : "-"; }

}  // namespace lw
