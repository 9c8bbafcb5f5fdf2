#include "apps/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {

namespace {

// Ten colours and seven shapes: no two styles are equal before the seventieth.
constexpr std::size_t kShapes = 7;
constexpr double kMarker_px = 4.0;
constexpr double kLine_px = 18.0;

std::string marker(std::size_t style, double x, double y) {
    const double r = kMarker_px;
    const char* colour = svg_colour(style);
    const auto polygon = [&](std::initializer_list<std::pair<double, double>> corners) {
        std::string points;
        for (const auto& [dx, dy] : corners) points += fmt::format("{:.1f},{:.1f} ", x + dx * r, y + dy * r);
        points.pop_back();
        return fmt::format("<polygon points=\"{}\" fill=\"{}\"/>\n", points, colour);
    };
    switch (style % kShapes) {
        case 0:
            return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, r, colour);
        case 1:
            return polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
        case 2:
            return polygon({{0.0, -1.3}, {1.15, 0.85}, {-1.15, 0.85}});
        case 3:
            return polygon({{0.0, -1.3}, {1.3, 0.0}, {0.0, 1.3}, {-1.3, 0.0}});
        case 4:
            return polygon({{0.0, 1.3}, {1.15, -0.85}, {-1.15, -0.85}});
        case 5:
            return fmt::format(
                "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" "
                "stroke-width=\"2\"/>\n",
                x - r, y - r, x + r, y + r, x - r, y + r, x + r, y - r, colour);
        default:
            return fmt::format(
                "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"#fff\" stroke=\"{}\" "
                "stroke-width=\"2\"/>\n",
                x, y, r - 0.5, colour);
    }
}

class PlotWriter {
public:
    PlotWriter(const SvgPlot& plot, SvgUse use)
        : plot_{plot},
          use_{use},
          x_{span_of(&SvgSeries::x), plot.log_x, plot.x_from_zero},
          y_{span_of(&SvgSeries::y), plot.log_y, plot.y_from_zero} {
        for (const SvgSeries& series : plot.series) LW_CHECK_EQ(series.x.size(), series.y.size());
        top_px_ = use == SvgUse::standalone ? 34.0 : 10.0;
        right_px_ = plot.width_px - 14.0 - legend_width_px();
        bottom_px_ = plot.height_px - 44.0;
    }

    [[nodiscard]] std::string text() const {
        std::string out = svg_head(plot_.title, plot_.width_px, plot_.height_px, kLeft_px, use_) + grid() + labels();
        for (std::size_t i = 0; i < plot_.series.size(); ++i) out += drawn(i);
        return out + legend() + "</svg>\n";
    }

private:
    [[nodiscard]] SvgSpan span_of(std::vector<double> SvgSeries::*values) const {
        const bool logarithmic = values == &SvgSeries::x ? plot_.log_x : plot_.log_y;
        SvgSpan span;
        for (const SvgSeries& series : plot_.series) {
            for (const double value : series.*values) {
                if (std::isfinite(value) && (!logarithmic || value > 0.0)) span.add(value);
            }
        }
        return span;
    }

    [[nodiscard]] double legend_width_px() const {
        std::size_t longest = 0;
        for (const SvgSeries& series : plot_.series) longest = std::max(longest, series.label.size());
        return longest == 0 ? 0.0 : 44.0 + kSvgLetter_px * static_cast<double>(longest);
    }

    [[nodiscard]] double x_px(double x) const { return kLeft_px + x_.part(x) * (right_px_ - kLeft_px); }
    [[nodiscard]] double y_px(double y) const { return bottom_px_ - y_.part(y) * (bottom_px_ - top_px_); }
    [[nodiscard]] std::size_t style_of(std::size_t series) const { return plot_.series[series].style.value_or(series); }

    [[nodiscard]] std::string grid() const {
        std::string out;
        for (const double y : y_.ticks()) {
            out += fmt::format(
                "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#e3e3e3\"/>"
                "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.4g}</text>\n",
                kLeft_px, right_px_, y_px(y), y_px(y), kLeft_px - 6.0, y_px(y) + 4.0, y);
        }
        for (const double x : x_.ticks()) {
            out += fmt::format(
                "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#eeeeee\"/>"
                "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.4g}</text>\n",
                x_px(x), x_px(x), top_px_, bottom_px_, x_px(x), bottom_px_ + 16.0, x);
        }
        return out;
    }

    [[nodiscard]] std::string labels() const {
        const double middle_px = 0.5 * (top_px_ + bottom_px_);
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                           0.5 * (kLeft_px + right_px_), plot_.height_px - 8.0, xml_escaped(plot_.x_label)) +
               fmt::format(
                   "<text x=\"14\" y=\"{0:.1f}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {0:.1f})\">"
                   "{1}</text>\n",
                   middle_px, xml_escaped(plot_.y_label));
    }

    [[nodiscard]] std::string drawn(std::size_t index) const {
        const SvgSeries& series = plot_.series[index];
        std::string out;
        if (series.marks != SvgMarks::points) out += curve(index);
        for (std::size_t i = 0; i < series.x.size(); ++i) {
            if (!x_.shows(series.x[i]) || !y_.shows(series.y[i])) continue;
            const double x = x_px(series.x[i]);
            const double y = y_px(series.y[i]);
            if (series.marks != SvgMarks::line) out += marker(style_of(index), x, y);
            if (i < series.notes.size() && !series.notes[i].empty()) out += note(series.notes[i], x, y);
        }
        return out;
    }

    /// Beside the point on the side that has room.
    [[nodiscard]] std::string note(const std::string& text, double x, double y) const {
        const bool left = x + 8.0 + kSvgLetter_px * static_cast<double>(text.size()) > right_px_;
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", left ? x - 7.0 : x + 7.0, y - 5.0,
                           left ? " text-anchor=\"end\"" : "", xml_escaped(text));
    }

    [[nodiscard]] std::string curve(std::size_t index) const {
        const SvgSeries& series = plot_.series[index];
        std::string path;
        bool pen_down = false;
        for (std::size_t i = 0; i < series.x.size(); ++i) {
            if (!x_.shows(series.x[i]) || !y_.shows(series.y[i])) {
                pen_down = false;
                continue;
            }
            path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", x_px(series.x[i]), y_px(series.y[i]));
            pen_down = true;
        }
        return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", path,
                           svg_colour(style_of(index)), index == 0 ? 2.4 : 1.6,
                           series.dashed ? " stroke-dasharray=\"6 4\"" : "");
    }

    [[nodiscard]] std::string legend() const {
        std::string out;
        double y = top_px_ + 8.0;
        for (std::size_t i = 0; i < plot_.series.size(); ++i) {
            const SvgSeries& series = plot_.series[i];
            if (series.label.empty()) continue;
            const double x = right_px_ + 14.0;
            if (series.marks != SvgMarks::points) {
                out += fmt::format(
                    "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
                    "stroke-width=\"2\"{}/>\n",
                    x, x + 20.0, y, y, svg_colour(style_of(i)), series.dashed ? " stroke-dasharray=\"6 4\"" : "");
            }
            if (series.marks != SvgMarks::line) out += marker(style_of(i), x + 10.0, y);
            out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 26.0, y + 4.0,
                               xml_escaped(series.label));
            y += kLine_px;
        }
        return out;
    }

    static constexpr double kLeft_px = 72.0;

    const SvgPlot& plot_;
    SvgUse use_;
    SvgAxis x_;
    SvgAxis y_;
    double top_px_ = 0.0;
    double right_px_ = 0.0;
    double bottom_px_ = 0.0;
};

}  // namespace

std::string svg_of(const SvgPlot& plot, SvgUse use) { return PlotWriter{plot, use}.text(); }

}  // namespace lw
