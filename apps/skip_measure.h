#pragma once
/// What skipping saves and what it costs, measured: the parts of the suite `skip`.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client_renderer/culling_settings.h"
#include "client_renderer/draw_order.h"
#include "core/result.h"
#include "core/statistics.h"
#include "frame_link/trace.h"
#include "scene/scene.h"

namespace lw {

/// Time per object of finding what a frustum sees among so many boxes, walking through them.
struct FrustumTiming {
    std::size_t objects = 0;
    double seen_fraction = 0.0;  ///< mean over the walk
    double linear_ns = 0.0;      ///< per object, medians
    double hierarchical_ns = 0.0;
    double read_ns = 0.0;        ///< reading the bytes that the linear test reads
    double several_ns = 0.0;     ///< six frusta in one walk, per object
    double one_by_one_ns = 0.0;  ///< the same six, one walk after the other
};
[[nodiscard]] FrustumTiming time_frustum(std::size_t objects);

/// A view drawn with and without skipping.
struct FrameTiming {
    std::string label;
    std::uint64_t objects = 0;
    std::uint64_t triangles = 0;
    std::uint64_t objects_drawn = 0;
    std::uint64_t triangles_drawn = 0;
    std::uint64_t draw_calls = 0;  ///< changes of state
    double frame_ms = 0.0;         ///< medians
    Distribution culling_ms;       ///< finding what is drawn, objects, clusters and the draws for them: processor time
};

/// Draws `frames` frames (after as many again for warming up, one where there is one) at 1024x1024 from steps of 5 cm
/// along the start pose's direction. The current context draws.
[[nodiscard]] Result<FrameTiming> time_frames(const scene::Scene& scene, const CullingSettings& settings,
                                              std::string label, int frames, DrawOrder order = {});

/// What was skipped as hidden, against what is, at a margin.
struct RevealCheck {
    std::string scene;
    std::string trace;
    double margin_m = 0.0;
    std::uint64_t views = 0;
    std::uint64_t in_view = 0;          ///< objects that alone would have a pixel in the frame, over all views
    std::uint64_t hidden = 0;           ///< of those: in no pixel of a picture from any of the eyes within the margin
    std::uint64_t skipped_hidden = 0;   ///< of those: skipped
    std::uint64_t wrongly_skipped = 0;  ///< skipped, but seen from one of the eyes
};
/// Views at `count` times of the trace, `step_s` apart, from the scene's start pose. Eyes: the frame's own and fourteen
/// at the margin's distance around it.
/// @param margin_m  nothing: as far as the head moves in the 0.2 s after each time, half as much again, and 5 mm
[[nodiscard]] Result<RevealCheck> check_reveal(const scene::Scene& scene, const Trace& trace, int count, double step_s,
                                               std::optional<double> margin_m);

}  // namespace lw
