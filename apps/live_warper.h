#pragma once
/// What makes the pictures of a live run.

#include <memory>

#include "apps/demo_controls.h"
#include "apps/options.h"
#include "core/result.h"
#include "frame_link/trace.h"
#include "warp_server/frame_warper.h"
#include "warp_server/picture_maker.h"
#include "warp_server/stereo_warper.h"

namespace lw {

/// For one eye or for two.
struct LiveWarper {
    std::unique_ptr<PictureMaker> maker;
    FrameWarper* one_eye = nullptr;          ///< the maker, where there is one
    StereoWarper* two_eyes = nullptr;        ///< the maker, where there are two
    SwitchingMethod* demo_method = nullptr;  ///< a warper's, where it follows the keys
};

/// As the options have it; GL methods need a current context.
/// @param keys  what method and holes follow, where they can be switched; outlives the result. Null without keys
[[nodiscard]] Result<LiveWarper> make_live_warper(const Options& options, const Trace& trace, const DemoControls* keys);

}  // namespace lw
