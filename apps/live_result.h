#pragma once
/// What a live run leaves behind.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/injection.h"
#include "apps/steal_watch.h"
#include "apps/thread_priority.h"
#include "client_renderer/client_loop.h"
#include "frame_link/trace.h"
#include "warp_server/display_record.h"
#include "warp_server/photon_watch.h"

namespace lw {

/// What a rendered frame was drawn for; enough to draw it again.
struct SourceView {
    Camera camera;
    double scene_time_s = 0.0;
};

struct LiveResult {
    std::vector<DisplayRecord> refreshes;  ///< since the first picture; of each its worst strip
    std::vector<DisplayRecord> parts;      ///< the same by strips; equal to `refreshes` where pictures are whole
    std::vector<Duration> warp_times;      ///< of refreshes whose strips were all made: theirs added up
    int strips = 1;                        ///< in the end: a key of the window changes it
    std::vector<SeenPart> seen;  ///< what the display scanned out; empty in a window, which nobody can read back
    /// What the head did; null where a viewer's hands moved it.
    std::shared_ptr<const ForeseeingHeadPoseFeed> true_head;
    InjectionPlan injection;
    StealWatch steal;
    std::string app_failure;  ///< what ended the client early; empty if nothing did
    std::vector<ClientFrameRecord> app_frames;
    std::vector<SourceView> source_views;  ///< of rendered frame i + 1: its first layer
    std::vector<ShellFrameRecord> shells;  ///< none without shells
    std::uint64_t app_frames_shown = 0;
    std::uint64_t bad_head_poses = 0;
    std::uint64_t bad_placements = 0;  ///< of movers, over all pictures
    std::uint64_t bad_layers = 0;
    Scheduling scheduling = Scheduling::none;
    Camera display_camera;               ///< its pose is that of the last picture
    std::vector<ColourImage> last_eyes;  ///< left and right of the last picture; empty with one eye
    bool in_window = false;
    bool interrupted = false;
};

}  // namespace lw
