#pragma once
/// What client, server and display did when, as a picture.

#include "apps/live_session.h"
#include "apps/svg_lanes.h"

namespace lw {

/// During at least `span` in the middle of the run: the life of the frames that are first shown then, from head sample
/// to photons; when the client draws and prepares them, when the server warps which, and what the display shows. Every
/// rendered frame has a colour. A refresh that was missed shows the last picture again and is hollow. Pure.
[[nodiscard]] SvgLanes timeline_of(const LiveResult& result, Duration span);

}  // namespace lw
