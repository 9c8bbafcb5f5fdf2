#pragma once
/// A head moved by mouse and keys.

#include <glm/glm.hpp>

#include "core/clock.h"
#include "core/pose.h"

namespace lw {

/// What mouse and keys asked for since the last time.
struct HeadInput {
    glm::dvec3 move{0.0};     ///< right, up, back; each in [-1, 1]
    glm::dvec2 turn_px{0.0};  ///< mouse travel, right and down positive
    bool fast = false;

    [[nodiscard]] bool empty() const { return move == glm::dvec3{0.0} && turn_px == glm::dvec2{0.0}; }
};

/// Follows a trace until the first input, then is the user's. One thread.
class UserHead {
public:
    /// Once the user has it, `input` moves it over `step`; before that it is `follow`.
    void advance(const HeadInput& input, Duration step, const Pose& follow);

    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] bool is_taken() const { return is_taken_; }

private:
    Pose pose_;
    bool is_taken_ = false;
    double yaw_rad_ = 0.0;
    double pitch_rad_ = 0.0;
};

}  // namespace lw
