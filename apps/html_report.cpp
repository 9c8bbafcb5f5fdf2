#include "apps/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lw {

namespace {

// Dark enough on white, and apart in lightness too, so that curves differ without colour.
constexpr std::array<const char*, 8> kPalette = {"#0b5fa5", "#d1495b", "#e08e1b", "#2e8b57",
                                                 "#7b4ea3", "#6b6b6b", "#00a2b8", "#8a5a2b"};
constexpr double kWidth = 900;
constexpr double kHeight = 260;
constexpr double kLeft = 64;
constexpr double kRight = 10;
constexpr double kTop = 10;
constexpr double kBottom = 40;

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:960px;margin:2em auto;padding:0 1em;color:#1b1b1b}"
    "h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
    "td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}"
    "td:first-child,th:first-child{text-align:left}"
    "svg text{font:12px system-ui,sans-serif;fill:#444}img{max-width:100%}figcaption{color:#555}figure{margin:1em 0}"
    ".key span{display:inline-block;margin-right:1.4em}.key i{display:inline-block;width:1.6em;height:.25em;"
    "margin-right:.4em;vertical-align:middle}";

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

struct Span {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();
};

/// The values' range, widened to whole steps of 1, 2 or 5 times a power of ten.
struct Axis {
    double min = 0.0;
    double max = 1.0;
    double step = 0.2;
};

Axis axis_of(Span span) {
    if (!(span.min <= span.max)) return {};
    if (span.max - span.min < 1e-12) span = {span.min - 0.5, span.max + 0.5};
    const double raw = (span.max - span.min) / 5.0;
    const double decade = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * decade;
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * decade >= raw) {
            step = factor * decade;
            break;
        }
    }
    return {std::floor(span.min / step) * step, std::ceil(span.max / step) * step, step};
}

class PlotWriter {
public:
    explicit PlotWriter(const LinePlot& plot) : plot_{plot} {
        Span values;
        for (const PlotSeries& series : plot.series) {
            for (const double value : series.values) {
                if (!std::isfinite(value)) continue;
                values.min = std::min(values.min, value);
                values.max = std::max(values.max, value);
            }
        }
        y_ = axis_of(values);
        x_ = {plot.x.front(), plot.x.back()};
    }

    std::string svg() const {
        std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", kWidth, kHeight,
                                      escaped(plot_.title));
        out += grid();
        for (std::size_t i = 0; i < plot_.series.size(); ++i) out += curve(i);
        out += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n", (kLeft + kWidth) / 2,
                           kHeight - 4, escaped(plot_.x_label));
        return out + "</svg>\n";
    }

    std::string key() const {
        std::string out = "<p class=\"key\">";
        for (std::size_t i = 0; i < plot_.series.size(); ++i) {
            out += fmt::format("<span><i style=\"background:{}\"></i>{}</span>", kPalette[i % kPalette.size()],
                               escaped(plot_.series[i].label));
        }
        return out + "</p>\n";
    }

private:
    double x_px(double x) const {
        return kLeft + (x - x_.min) / std::max(x_.max - x_.min, 1e-12) * (kWidth - kLeft - kRight);
    }
    double y_px(double y) const { return kTop + (y_.max - y) / (y_.max - y_.min) * (kHeight - kTop - kBottom); }

    std::string grid() const {
        std::string out;
        const int lines = static_cast<int>(std::lround((y_.max - y_.min) / y_.step));
        for (int i = 0; i <= lines; ++i) {
            const double y = y_.min + i * y_.step;
            out += fmt::format(
                "<line x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#e3e3e3\"/>"
                "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>\n",
                kLeft, kWidth - kRight, y_px(y), y_px(y), kLeft - 6, y_px(y) + 4, y + 0.0);
        }
        const Axis x_axis = axis_of(x_);
        for (double x = std::ceil(x_.min / x_axis.step) * x_axis.step; x <= x_.max + 1e-9; x += x_axis.step) {
            out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:.4g}</text>\n", x_px(x),
                               kHeight - kBottom + 18, x);
        }
        return out;
    }

    std::string curve(std::size_t index) const {
        const PlotSeries& series = plot_.series[index];
        std::string path;
        bool pen_down = false;
        for (std::size_t i = 0; i < std::min(series.values.size(), plot_.x.size()); ++i) {
            if (!std::isfinite(series.values[i])) {
                pen_down = false;
                continue;
            }
            path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x_px(plot_.x[i]), y_px(series.values[i]));
            pen_down = true;
        }
        return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", path,
                           kPalette[index % kPalette.size()], index == 0 ? 2.4 : 1.4);
    }

    const LinePlot& plot_;
    Axis y_;
    Span x_;
};

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

void HtmlReport::add_heading(const std::string& text) { body_ += fmt::format("<h2>{}</h2>\n", escaped(text)); }
void HtmlReport::add_paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", escaped(text)); }

void HtmlReport::add_table(const std::vector<std::vector<std::string>>& rows) {
    body_ += "<table>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const char* tag = i == 0 ? "th" : "td";
        body_ += "<tr>";
        for (const std::string& cell : rows[i]) body_ += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
        body_ += "</tr>\n";
    }
    body_ += "</table>\n";
}

void HtmlReport::add_plot(const LinePlot& plot) {
    if (plot.x.size() < 2) return;
    const PlotWriter writer{plot};
    body_ += fmt::format("<h2>{}{}</h2>\n", escaped(plot.title),
                         plot.y_label.empty() ? "" : fmt::format(" ({})", escaped(plot.y_label)));
    body_ += writer.key() + writer.svg();
}

void HtmlReport::add_png(std::span<const std::uint8_t> png_bytes, const std::string& caption) {
    body_ +=
        fmt::format("<figure><img src=\"data:image/png;base64,{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
                    base64(png_bytes), escaped(caption), escaped(caption));
}

std::string HtmlReport::text() const {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
        "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
        escaped(title_), kStyle, body_);
}

std::string short_number(double number) { return std::isfinite(number) ? fmt::format("{:.3g}", number) : "-"; }

}  // namespace lw
