#include "apps/svg_lanes.h"

#include <fmt/format.h>

#include <algorithm>

namespace lw {
namespace {

constexpr double kLane_px = 40.0;
constexpr double kBar_px = 26.0;
constexpr double kLeastWidth_px = 1.0;  // of a bar, so that it is seen
constexpr double kMargin_px = 14.0;

class LanesWriter {
public:
    LanesWriter(const SvgLanes& lanes, SvgUse use) : lanes_{lanes}, use_{use}, axis_{span_of(lanes), false, false} {
        std::size_t longest = 0;
        for (const SvgLane& lane : lanes.lanes) longest = std::max(longest, lane.name.size());
        left_px_ = 2.0 * kMargin_px + kSvgLetter_px * static_cast<double>(longest);
        top_px_ = use == SvgUse::standalone ? 34.0 : 10.0;
        bottom_px_ = top_px_ + kLane_px * static_cast<double>(lanes.lanes.size());
    }

    [[nodiscard]] std::string text() const {
        std::string out = svg_head(lanes_.title, lanes_.width_px, bottom_px_ + 44.0, left_px_, use_) + grid();
        for (std::size_t i = 0; i < lanes_.lanes.size(); ++i) out += lane(i);
        return out + "</svg>\n";
    }

private:
    [[nodiscard]] static SvgSpan span_of(const SvgLanes& lanes) {
        SvgSpan span;
        span.add(lanes.begin);
        span.add(lanes.end);
        return span;
    }

    [[nodiscard]] double x_px(double x) const {
        const double begin = axis_.part(lanes_.begin);
        const double end = axis_.part(lanes_.end);
        return left_px_ + (axis_.part(x) - begin) / (end - begin) * (lanes_.width_px - kMargin_px - left_px_);
    }

    [[nodiscard]] std::string grid() const {
        std::string out;
        for (const double x : axis_.ticks()) {
            if (x < lanes_.begin || x > lanes_.end) continue;
            out += fmt::format(
                "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"#e3e3e3\"/>"
                "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4:.4g}</text>\n",
                x_px(x), top_px_, bottom_px_, bottom_px_ + 16.0, x);
        }
        return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                                 0.5 * (left_px_ + lanes_.width_px - kMargin_px), bottom_px_ + 36.0,
                                 xml_escaped(lanes_.x_label));
    }

    [[nodiscard]] std::string lane(std::size_t index) const {
        const SvgLane& lane = lanes_.lanes[index];
        const double middle_px = top_px_ + kLane_px * (static_cast<double>(index) + 0.5);
        std::string out = fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                                      left_px_ - kMargin_px, middle_px + 4.0, xml_escaped(lane.name));
        for (const SvgBar& one : lane.bars) {
            if (one.end >= lanes_.begin && one.begin <= lanes_.end) out += bar(one, middle_px);
        }
        return out;
    }

    [[nodiscard]] std::string bar(const SvgBar& bar, double middle_px) const {
        const double begin_px = x_px(std::max(bar.begin, lanes_.begin));
        const double width_px = std::max(x_px(std::min(bar.end, lanes_.end)) - begin_px, kLeastWidth_px);
        const char* colour = svg_colour(bar.style);
        std::string out = fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" stroke=\"{}\"/>\n",
            begin_px, middle_px - 0.5 * kBar_px, width_px, kBar_px, bar.hollow ? "#fff" : colour,
            bar.hollow ? colour : "#fff");
        if (kSvgLetter_px * static_cast<double>(bar.text.size()) + 6.0 > width_px) return out;
        return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" style=\"fill:{}\">{}</text>\n",
                                 begin_px + 0.5 * width_px, middle_px + 4.0, bar.hollow ? "#444" : "#fff",
                                 xml_escaped(bar.text));
    }

    const SvgLanes& lanes_;
    SvgUse use_;
    SvgAxis axis_;
    double left_px_ = 0.0;
    double top_px_ = 0.0;
    double bottom_px_ = 0.0;
};

}  // namespace

std::string svg_of(const SvgLanes& lanes, SvgUse use) { return LanesWriter{lanes, use}.text(); }

}  // namespace lw
