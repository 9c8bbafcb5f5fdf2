#pragma once
/// The search of `inverse`, repeated exactly.

#include <optional>

#include "apps/stability/picture_oracle.h"
#include "frame_link/rendered_frame.h"

namespace lw::stability {

struct SearchedPlace {
    ExactVec2 source_px;
    int region = 0;
    Exact depth = 0;  ///< in the target
};

/// Three steps of s += p - q(s) from the rotation's place, as `inverse` does by default. Nothing where the search ends
/// on nothing, and where a step ends so close to a pixel's edge, or to the limit of what is accepted, that rounding
/// may decide.
[[nodiscard]] std::optional<SearchedPlace> search_fixed_point(const PictureOracle& oracle, const CpuPixels& pixels,
                                                              int x, int y);

}  // namespace lw::stability
