#pragma once
/// Cars drive around groups of blocks, keeping right and turning right: lanes of different groups never meet, so no two
/// cars collide. All cars of a loop have the same speed profile, one behind the other.

#include <vector>

#include "scene/city_layout.h"
#include "scene/scene.h"

namespace lw::scene {

/// Where a car is on its loop.
struct CarState {
    glm::dvec3 position_m{0.0};
    glm::dvec3 velocity_m_per_s{0.0};
    double heading_turns = 0.0;  ///< about +Y; 0 drives towards +Z; falls by one turn per round
};

/// The closed drive around one group: straights with acceleration and braking, quarter circles at constant speed.
class TrafficLoop {
public:
    TrafficLoop(const CityLayout& layout, const BlockGroup& group);

    [[nodiscard]] double round_s() const { return round_s_; }
    /// `time_s` in [0, round_s()].
    [[nodiscard]] CarState at(double time_s) const;
    /// Cars that fit with a safe gap.
    [[nodiscard]] int capacity() const;
    [[nodiscard]] const glm::dvec3& centre_m() const { return centre_m_; }

    /// Adds translation and rotation channels for a car that starts `phase_s` into its round.
    void animate(int node, double phase_s, std::vector<AnimationChannel>& channels) const;

private:
    /// A stretch of the drive with constant acceleration and constant turn rate.
    struct Leg {
        double start_s;
        double duration_s;
        glm::dvec3 start_m;
        double heading_turns;
        double speed;
        double acceleration;
        bool turns_right;
    };

    std::vector<Leg> legs_;
    double round_s_ = 0.0;
    glm::dvec3 centre_m_{0.0};
};

}  // namespace lw::scene
