#pragma once
/// The four pictures that explain the project: what one refresh of a live run would have shown with each method, beside
/// the truth.

#include <optional>

#include "apps/live_session.h"
#include "core/image.h"

namespace lw {

/// A refresh of a run that is worth a picture: its frame of about the median age, the head moved more than in most.
/// @return null when no picture was shown in time
[[nodiscard]] const DisplayRecord* telling_refresh(const LiveResult& result);

/// Draws the refresh's rendered frame again and warps it: stale, rotation, options.method, and the truth; each with its
/// error below. `renderer`'s context is current.
[[nodiscard]] Result<ColourImage> live_strip(const Options& options, const LiveResult& result,
                                             const DisplayRecord& refresh, SceneRenderer& renderer);

}  // namespace lw
