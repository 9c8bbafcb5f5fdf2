#pragma once
/// A live run: the client's thread and the server's thread on the real clock, on a window or a virtual display.

#include <functional>

#include "apps/live_result.h"
#include "apps/options.h"
#include "client_renderer/scene_renderer.h"
#include "core/result.h"
#include "frame_link/trace.h"
#include "gl/context.h"
#include "scene/scene.h"

namespace lw {

/// Called on the client's thread with its context current when both loops have ended: what needs the renderer.
using AfterLiveRun = std::function<Status(SceneRenderer&, const gl::Context&, const LiveResult&)>;

/// Runs for options.seconds from the first picture on, or until Ctrl-C, or until the window is closed; a window whose
/// viewer has taken over the head stays until closed. Called on the main thread.
///
/// The client has its own GL display where GL is software, frames travel in CPU memory, and its threads step back
/// unless the server got real-time priority. On a GPU a GL warp method gets the frames as textures.
///
/// @param trace   head motion, placed in the scene; in a window mouse and keys take over at the first touch
/// @param window  show a window when there is a display
[[nodiscard]] Result<LiveResult> run_live(const Options& options, const scene::Scene& scene, const Trace& trace,
                                          bool window, const AfterLiveRun& after);

}  // namespace lw
