#pragma once
/// A time line as SVG: lanes below each other, each with bars from one time to another.
///
///     SvgLanes lanes{"What each thread did when", "time, ms", 0.0, 250.0};
///     lanes.lanes.push_back({"client draws", {{12.0, 98.0, 0, "frame 7"}}});

#include <cstddef>
#include <string>
#include <vector>

#include "apps/svg_parts.h"

namespace lw {

struct SvgBar {
    double begin = 0.0;
    double end = 0.0;
    std::size_t style = 0;  ///< its colour: what belongs together has one number
    std::string text = {};  ///< written into the bar where it has room
    bool hollow = false;    ///< an outline alone
};

struct SvgLane {
    std::string name;
    std::vector<SvgBar> bars = {};
};

/// Bars are cut to [begin, end]; those that lie outside are left out.
struct SvgLanes {
    std::string title;
    std::string x_label;
    double begin = 0.0;
    double end = 1.0;
    std::vector<SvgLane> lanes = {};  ///< from top to bottom
    double width_px = 900.0;          ///< > 300
};

/// The whole <svg> element, ending with a line break. Equal lanes give equal bytes. Pure, any thread.
[[nodiscard]] std::string svg_of(const SvgLanes& lanes, SvgUse use);

}  // namespace lw
