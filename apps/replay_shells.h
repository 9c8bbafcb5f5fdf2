#pragma once
/// Replay's client where frames consist of shells.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "apps/options.h"
#include "client_renderer/shell_client.h"
#include "frame_link/hole_feedback.h"

namespace lw {

/// Frames depend on those before them, and on what the server reported until their drawing began: so they are drawn in
/// order, and an earlier one is reached by drawing all anew, with the reports of the first time.
class ReplayShells {
public:
    using MomentOf = std::function<ShellMoment(std::uint64_t frame)>;

    /// @param display  as ShellClient has it
    ReplayShells(SceneRenderer& renderer, const Camera& display, const Options& options);
    ReplayShells(const ReplayShells&) = delete;
    ReplayShells& operator=(const ReplayShells&) = delete;

    /// Draws up to client frame `frame`. `moment_of` says what the client knows at a frame.
    void draw(std::uint64_t frame, const MomentOf& moment_of);

    /// Of the last frame drawn.
    [[nodiscard]] const std::vector<std::shared_ptr<const Layer>>& layers() const { return layers_; }
    /// What the last draw() drew, to be prepared for the warp.
    [[nodiscard]] const std::vector<std::shared_ptr<Layer>>& drawn() const { return drawn_; }

    /// The server showed a display frame, scanned out at `feedback.shown`; in ascending order.
    void report(HoleFeedback feedback);

    /// Of frames 0 to the last one drawn.
    [[nodiscard]] const std::vector<ShellFrameRecord>& records() const { return client_->records(); }
    [[nodiscard]] const DrawCounters& counters() const { return client_->counters(); }

private:
    void begin();

    SceneRenderer& renderer_;
    Camera display_;
    SourceSettings source_;
    ShellSettings settings_;
    std::unique_ptr<ShellClient> client_;
    std::vector<std::shared_ptr<const Layer>> layers_;
    std::vector<std::shared_ptr<Layer>> drawn_;
    std::uint64_t next_frame_ = 0;
    std::vector<HoleFeedback> reports_;
    std::size_t reports_taken_ = 0;
};

}  // namespace lw
