#pragma once
/// Which part of a pixel its surface covers, as edges want to know it.

#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/surface_links.h"

namespace lw {

/// What a pixel lacks of its surface lies at the surface's edge. Of a thing one pixel wide both edges run through the
/// pixel: half of what it lacks is on each side, and that is what its alpha in `linear`, which has one, says
/// afterwards.
void halve_lacks_of_thin_things(const SurfaceLinks& links, LinearImage& linear);

}  // namespace lw
