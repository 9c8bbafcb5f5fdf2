#pragma once
/// What SVG pictures share: their head, an axis with round steps, colours, escaping.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace lw {

enum class SvgUse {
    standalone,   ///< a file of its own, title included
    inside_html,  ///< an element of a page, which has the title as its heading
};

/// With &, <, > and " as entities: text for SVG and HTML. Pure, any thread.
[[nodiscard]] std::string xml_escaped(const std::string& text);

/// The opening of the <svg> element; of a file of its own also the title, at `title_x_px`.
[[nodiscard]] std::string svg_head(const std::string& title, double width_px, double height_px, double title_x_px,
                                   SvgUse use);

/// Ten colours, dark enough on white, and apart in lightness too; after the last the first comes again.
[[nodiscard]] const char* svg_colour(std::size_t style);

inline constexpr double kSvgLetter_px = 6.4;  ///< mean width of a letter at 12 px, sans-serif

/// The least and the greatest of some values.
struct SvgSpan {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();

    void add(double value);
    [[nodiscard]] bool empty() const { return !(min <= max); }
};

/// Maps values to [0, 1] along an axis, and knows where its grid lines are.
class SvgAxis {
public:
    SvgAxis(SvgSpan values, bool logarithmic, bool from_zero);

    [[nodiscard]] bool shows(double value) const;
    [[nodiscard]] double part(double value) const;
    /// Ascending, at least two; the first and the last are the ends of the axis.
    [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }

private:
    void make_steps(SvgSpan values);
    void make_decades(SvgSpan values);

    bool logarithmic_;
    std::vector<double> ticks_;
};

}  // namespace lw
