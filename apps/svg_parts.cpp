#include "apps/svg_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lw {

std::string xml_escaped(const std::string& text) {
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

std::string svg_head(const std::string& title, double width_px, double height_px, double title_x_px, SvgUse use) {
    std::string out = "<svg";
    if (use == SvgUse::standalone) out += " xmlns=\"http://www.w3.org/2000/svg\"";
    out += fmt::format(" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width_px, height_px,
                       xml_escaped(title));
    if (use == SvgUse::inside_html) return out;
    return out + fmt::format(
                     "<style>text{{font:12px system-ui,sans-serif;fill:#444}}</style>\n"
                     "<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n"
                     "<text x=\"{}\" y=\"20\" style=\"font-size:14px;font-weight:600\">{}</text>\n",
                     width_px, height_px, title_x_px, xml_escaped(title));
}

const char* svg_colour(std::size_t style) {
    static constexpr std::array<const char*, 10> kPalette = {"#0b5fa5", "#d1495b", "#e08e1b", "#2e8b57", "#7b4ea3",
                                                             "#6b6b6b", "#00a2b8", "#8a5a2b", "#b83fa0", "#5f7d0e"};
    return kPalette[style % kPalette.size()];
}

void SvgSpan::add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
}

SvgAxis::SvgAxis(SvgSpan values, bool logarithmic, bool from_zero) : logarithmic_{logarithmic} {
    if (values.empty()) values = {logarithmic ? 1.0 : 0.0, logarithmic ? 10.0 : 1.0};
    if (logarithmic) {
        make_decades(values);
    } else {
        if (from_zero) values.add(0.0);
        make_steps(values);
    }
}

bool SvgAxis::shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0.0); }

double SvgAxis::part(double value) const {
    if (!logarithmic_) return (value - ticks_.front()) / (ticks_.back() - ticks_.front());
    return std::log(value / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
}

// Steps of 1, 2 or 5 times a power of ten, about five of them.
void SvgAxis::make_steps(SvgSpan values) {
    if (values.max - values.min < 1e-12 * std::max(1.0, std::abs(values.max))) {
        values = {values.min - 0.5, values.max + 0.5};
    }
    const double raw = (values.max - values.min) / 5.0;
    const double decade = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * decade;
    for (const double factor : {5.0, 2.0, 1.0}) {
        if (factor * decade >= raw) step = factor * decade;
    }
    const double first = std::floor(values.min / step + 1e-9);
    const double last = std::max(first + 1.0, std::ceil(values.max / step - 1e-9));
    for (double i = first; i <= last; i += 1.0) ticks_.push_back(i * step + 0.0);
}

// 1, 2 and 5 times the powers of ten; the powers alone where there would be too many.
void SvgAxis::make_decades(SvgSpan values) {
    const int first = static_cast<int>(std::floor(std::log10(values.min)));
    const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(values.max))));
    const bool wide = last - first > 3;
    std::vector<double> all;
    for (int decade = first; decade <= last; ++decade) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            if (factor == 1.0 || !wide) all.push_back(factor * std::pow(10.0, decade));
        }
    }
    constexpr double kRounding = 1e-9;
    auto begin = std::upper_bound(all.begin(), all.end(), values.min * (1.0 + kRounding));
    if (begin != all.begin()) --begin;
    auto end = std::lower_bound(begin, all.end(), values.max * (1.0 - kRounding));
    if (end != all.end()) ++end;
    if (end - begin < 2) {  // one value that is a tick itself
        if (begin != all.begin()) --begin;
        if (end != all.end()) ++end;
    }
    ticks_.assign(begin, end);
}

}  // namespace lw
