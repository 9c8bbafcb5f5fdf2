#include "client_renderer/reveal_margin.h"

#include <algorithm>

namespace lw {

double reveal_margin_m(std::optional<double> given, HeadPosePredictor& predictor, const HeadPoseFeed& feed,
                       TimePoint now, const Pose& drawn_from, TimePoint shown_from, TimePoint shown_until) {
    if (given) return *given;
    constexpr double kUnforeseen = 1.5;
    constexpr double kStill_m = 0.005;
    double farthest_m = 0.0;
    for (const TimePoint shown : {shown_from, shown_until}) {
        const Pose head = predictor.predict(feed, now, shown).world_from_head;
        farthest_m = std::max(farthest_m, glm::distance(head.position_m, drawn_from.position_m));
    }
    return kUnforeseen * farthest_m + kStill_m;
}

bool viewer_moves(HeadPosePredictor& predictor, const HeadPoseFeed& feed, TimePoint now, TimePoint shown_until) {
    constexpr double kSlow_m_per_s = 0.02;
    constexpr double kSlow_rad_per_s = 0.035;
    const double seconds = to_seconds(shown_until - now);
    if (!(seconds > 0.0)) return false;
    const Pose here = predictor.predict(feed, now, now).world_from_head;
    const Pose there = predictor.predict(feed, now, shown_until).world_from_head;
    return glm::distance(here.position_m, there.position_m) > kSlow_m_per_s * seconds ||
           angle_between_rad(here.orientation, there.orientation) > kSlow_rad_per_s * seconds;
}

}  // namespace lw
