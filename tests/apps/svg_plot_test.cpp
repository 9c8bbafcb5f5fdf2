/// Plots: what is on them, and where.

#include "apps/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

namespace lw::test {

namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// "M72.0 316.0L..." as numbers.
std::vector<double> numbers_of_first_path(const std::string& svg) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(svg, found, std::regex{"<path d=\"([^\"]*)\" fill=\"none\""}));
    std::vector<double> numbers;
    const std::string path = found[1];
    const std::regex number{"-?[0-9.]+"};
    for (std::sregex_iterator it{path.begin(), path.end(), number}, end; it != end; ++it) {
        numbers.push_back(std::stod(it->str()));
    }
    return numbers;
}

TEST(SvgPlot, PutsValuesInProportion) {
    SvgPlot plot{"t", "x", "y"};
    plot.series = {{"a", {0, 1, 2}, {0, 5, 10}, SvgMarks::line}};
    const std::vector<double> p = numbers_of_first_path(svg_of(plot, SvgUse::inside_html));
    ASSERT_EQ(p.size(), 6u);
    // Written to a tenth of a pixel.
    EXPECT_NEAR(p[2], (p[0] + p[4]) / 2, 0.11);
    EXPECT_NEAR(p[3], (p[1] + p[5]) / 2, 0.11);
    EXPECT_LT(p[0], p[4]);
    EXPECT_GT(p[1], p[5]) << "y grows upwards";
}

TEST(SvgPlot, ALogarithmicAxisGivesEqualRatiosEqualSpace) {
    SvgPlot plot{"t", "x", "y"};
    plot.log_x = true;
    plot.series = {{"a", {1, 10, 100}, {1, 2, 3}, SvgMarks::line}};
    const std::string svg = svg_of(plot, SvgUse::inside_html);
    const std::vector<double> p = numbers_of_first_path(svg);
    ASSERT_EQ(p.size(), 6u);
    EXPECT_NEAR(p[2], (p[0] + p[4]) / 2, 0.11);
    for (const char* tick : {">1<", ">2<", ">5<", ">10<", ">20<", ">50<", ">100<"}) EXPECT_THAT(svg, HasSubstr(tick));
}

TEST(SvgPlot, AxesEndAtRoundNumbersAroundTheValues) {
    SvgPlot plot{"t", "x", "y"};
    plot.series = {{"a", {3, 97}, {0.012, 0.088}}};
    const std::string svg = svg_of(plot, SvgUse::inside_html);
    for (const char* tick : {">0<", ">20<", ">100<", ">0.02<", ">0.1<"}) EXPECT_THAT(svg, HasSubstr(tick));
}

TEST(SvgPlot, LeavesOutWhatHasNoPlaceAndInterruptsTheCurve) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    SvgPlot plot{"t", "x", "y"};
    plot.log_x = true;
    plot.series = {{"a", {-1, 0, 1, 2, 3, 4}, {1, 1, 1, kNan, 2, 3}, SvgMarks::both}};
    const std::string svg = svg_of(plot, SvgUse::inside_html);
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_EQ(count_of(svg, "<circle"), 3u + 1u) << "three points and the legend";
    EXPECT_EQ(numbers_of_first_path(svg).size(), 6u);
}

TEST(SvgPlot, WithoutPointsHasEmptyAxes) {
    for (const bool logarithmic : {false, true}) {
        SvgPlot plot{"t", "x", "y"};
        plot.log_x = plot.log_y = logarithmic;
        const std::string svg = svg_of(plot, SvgUse::standalone);
        EXPECT_THAT(svg, HasSubstr("</svg>"));
        EXPECT_THAT(svg, Not(HasSubstr("nan")));
    }
}

TEST(SvgPlot, OneValueHasAnAxisAroundIt) {
    for (const double value : {0.0, 1.0, 1e9, -3.0}) {
        SvgPlot plot{"t", "x", "y"};
        plot.series = {{"a", {value}, {value}}};
        EXPECT_THAT(svg_of(plot, SvgUse::inside_html), Not(HasSubstr("nan"))) << value;
    }
    SvgPlot plot{"t", "x", "y"};
    plot.log_x = plot.log_y = true;
    plot.series = {{"a", {10.0}, {1e-3}}};
    EXPECT_THAT(svg_of(plot, SvgUse::inside_html), Not(HasSubstr("nan")));
}

TEST(SvgPlot, TextIsEscaped) {
    SvgPlot plot{"a < b", "x & y", "\"y\""};
    plot.series = {{"<label>", {1}, {1}, SvgMarks::both, false, std::nullopt, {"<note>"}}};
    const std::string svg = svg_of(plot, SvgUse::standalone);
    for (const char* text : {"a &lt; b", "x &amp; y", "&quot;y&quot;", "&lt;label&gt;", "&lt;note&gt;"}) {
        EXPECT_THAT(svg, HasSubstr(text));
    }
}

TEST(SvgPlot, AFileNamesItsNamespaceAndAPageLoadsNothing) {
    SvgPlot plot{"t", "x", "y"};
    EXPECT_THAT(svg_of(plot, SvgUse::standalone), HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_THAT(svg_of(plot, SvgUse::inside_html), Not(HasSubstr("http")));
}

}  // namespace

}  // namespace lw::test
