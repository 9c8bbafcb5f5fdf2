#include "apps/replay_shells.h"

#include <utility>

namespace lw {

ReplayShells::ReplayShells(SceneRenderer& renderer, const Camera& display, const Options& options)
    : renderer_{renderer}, display_{display}, source_{options.source}, settings_{options.shells} {
    begin();
}

void ReplayShells::begin() {
    client_ = std::make_unique<ShellClient>(renderer_, display_, source_, settings_,
                                            [this](const std::shared_ptr<Layer>& layer) { drawn_.push_back(layer); });
    next_frame_ = 0;
    reports_taken_ = 0;
}

void ReplayShells::draw(std::uint64_t frame, const MomentOf& moment_of) {
    drawn_.clear();
    if (frame + 1 < next_frame_) begin();
    for (; next_frame_ <= frame; ++next_frame_) {
        const ShellMoment moment = moment_of(next_frame_);
        for (; reports_taken_ < reports_.size(); ++reports_taken_) {
            if (seconds_of(reports_[reports_taken_].shown) > moment.now_s) break;
            client_->take(reports_[reports_taken_]);
        }
        layers_ = client_->draw(moment);
    }
}

void ReplayShells::report(HoleFeedback feedback) {
    if (!reports_.empty() && feedback.shown <= reports_.back().shown) return;
    reports_.push_back(std::move(feedback));
}

}  // namespace lw
