#pragma once
/// Edges beside holes: what a surface leaves of a pixel shows what the fill makes of the hole.

#include "warp_server/warp_method.h"

namespace lw {

/// Before the fill: pixels that are covered in part become holes, so that the fill says what is behind them. Those that
/// another layer has covered since stay as they are.
void open_partly_covered(DisplayFrame& frame);

/// After the fill: the surfaces of those pixels over what was filled, by their share, in linear light. What is covered
/// by half or more is `reached` and has the surface's depth, the rest stays `filled`.
void close_partly_covered(DisplayFrame& frame);

}  // namespace lw
