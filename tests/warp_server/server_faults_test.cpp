/// What the server shows when the client or the tracker fails: the best it has, without a jump, and then a still image.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frame_link/sampled_head_feed.h"
#include "tests/warp_server/simulated_display.h"
#include "warp_server/frame_warper.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

// A head that turns at 60 degrees/s and walks at 0.5 m/s.
constexpr double kTurn_rad_per_s = 1.0472;
constexpr double kWalk_m_per_s = 0.5;
Pose true_head(TimePoint time) {
    const double seconds = seconds_of(time);
    return {{kWalk_m_per_s * seconds, 1.6, 0.0}, glm::angleAxis(kTurn_rad_per_s * seconds, glm::dvec3{0.0, 1.0, 0.0})};
}

/// A server whose tracker of 1 kHz and whose client of 10 Hz are driven by the test.
class FaultRig {
public:
    FaultRig()
        : predictor_{*make_predictor(kDefaultPredictor)},
          warper_{std::make_unique<test::TimedMethod>(clock_, [] { return from_ms(2.0); }),
                  std::make_unique<test::NoFill>()},
          loop_{ServerParts{clock_, exchange_, feed_, movers_, *predictor_, warper_, display_}, settings()} {
        publish();
        run_for(2.0);
    }

    /// Shows pictures for so long; the tracker and the client do what `tracker` and `client_works` say.
    void run_for(double seconds) {
        const TimePoint end = clock_.now() + from_seconds(seconds);
        while (clock_.now() < end) {
            // The server sleeps until its wake-up, up to a refresh ahead: samples until then must be there.
            for (; next_sample_ <= clock_.now() + from_ms(12.0); next_sample_ += from_ms(1.0)) {
                if (tracker) tracker(next_sample_);
            }
            if (client_works && clock_.now() - last_published_ > from_ms(100.0)) publish();
            loop_.show_next();
        }
    }
    void push_true(TimePoint time) { feed_.push(time, true_head(time)); }

    /// Largest turn from one picture to the next since record `first`, degrees.
    [[nodiscard]] double largest_step_deg(std::size_t first) const {
        double largest = 0.0;
        const auto& records = loop_.records();
        for (std::size_t i = std::max<std::size_t>(first, 1); i < records.size(); ++i) {
            largest = std::max(largest, glm::degrees(angle_between_rad(records[i - 1].world_from_head.orientation,
                                                                       records[i].world_from_head.orientation)));
        }
        return largest;
    }
    [[nodiscard]] const std::vector<DisplayRecord>& records() const { return loop_.records(); }
    [[nodiscard]] Rgba8 shown() const { return display_.picture().at(1, 1); }
    [[nodiscard]] SampledHeadFeed& feed() { return feed_; }

    std::function<void(TimePoint)> tracker = [this](TimePoint time) { push_true(time); };
    bool client_works = true;

private:
    static ServerSettings settings() {
        ServerSettings result;
        result.camera.size_px = {4, 4};
        return result;
    }
    void publish() {
        exchange_.publish(test::plain_frame(++index_, clock_.now(), Rgba8{10, 20, 30, 255}));
        last_published_ = clock_.now();
    }

    test::SimulatedClock clock_;
    FrameExchange exchange_;
    SampledHeadFeed feed_;
    test::StillMovers movers_{0};
    std::unique_ptr<HeadPosePredictor> predictor_;
    FrameWarper warper_;
    VirtualDisplay display_{TimePoint{}, 90.0, {4, 4}};
    ServerLoop loop_;
    TimePoint next_sample_ = at_seconds(0.001);
    TimePoint last_published_;
    std::uint64_t index_ = 0;
};

// One refresh of steady turning, and a little for what the prediction learns.
constexpr double kOrdinaryStep_deg = 60.0 / 90.0 * 1.2;

TEST(ServerFaults, AClientThatStallsForTwoSecondsCostsNoRefreshAndNoMotion) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    rig.client_works = false;
    rig.run_for(2.0);
    EXPECT_GE(rig.records().size() - before, 179u);
    for (std::size_t i = before; i < rig.records().size(); ++i) {
        const DisplayRecord& record = rig.records()[i];
        EXPECT_FALSE(record.missed());
        // The head goes on being followed: half a degree is its turn in 8 ms.
        EXPECT_LT(
            glm::degrees(angle_between_rad(record.world_from_head.orientation, true_head(record.photon).orientation)),
            0.5);
    }
    EXPECT_EQ(rig.shown(), (Rgba8{10, 20, 30, 255}));
    rig.client_works = true;
    rig.run_for(0.5);
    EXPECT_GT(rig.records().back().frame_index, rig.records()[before].frame_index);
    EXPECT_LT(rig.largest_step_deg(before), kOrdinaryStep_deg);
}

// The image decays to a still one: it turns on for a while, slower and slower, and never back or by a jump.
TEST(ServerFaults, ATrackerThatStopsLeavesAStillImageAfterADecay) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    rig.tracker = nullptr;
    rig.run_for(2.0);
    EXPECT_LT(rig.largest_step_deg(before), kOrdinaryStep_deg);
    const auto& records = rig.records();
    EXPECT_EQ(records.back().world_from_head, records[records.size() - 90].world_from_head);
    // No farther than the longest horizon of prediction, 192 ms at 60 degrees/s.
    EXPECT_LT(glm::degrees(angle_between_rad(records[before].world_from_head.orientation,
                                             records.back().world_from_head.orientation)),
              12.0);
    for (std::size_t i = before; i < records.size(); ++i) EXPECT_FALSE(records[i].missed());
    EXPECT_EQ(rig.shown(), (Rgba8{10, 20, 30, 255}));
}

TEST(ServerFaults, ATrackerThatRepeatsItsLastPoseHoldsTheImageThere) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    const Pose last = true_head(rig.records().back().photon);
    rig.tracker = [&](TimePoint time) { rig.feed().push(time, last); };
    rig.run_for(1.0);
    EXPECT_LT(glm::degrees(angle_between_rad(rig.records().back().world_from_head.orientation, last.orientation)),
              0.01);
    // The head stops from one sample to the next: the prediction has to come back over what it was ahead, 1.5 degrees.
    EXPECT_LT(rig.largest_step_deg(before), 1.5);
}

TEST(ServerFaults, StampsThatGoBackwardsAreRefused) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    rig.tracker = [&](TimePoint time) {
        rig.push_true(time);
        rig.feed().push(time - from_ms(40.0), true_head(time - from_ms(500.0)));
    };
    rig.run_for(1.0);
    EXPECT_LT(rig.largest_step_deg(before), kOrdinaryStep_deg);
}

TEST(ServerFaults, PosesThatAreNoNumbersAreRefused) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    int count = 0;
    rig.tracker = [&](TimePoint time) {
        Pose pose = true_head(time);
        if (++count % 3 == 0) pose.position_m.x = std::numeric_limits<double>::quiet_NaN();
        if (count % 5 == 0) pose.orientation = {0.0, 0.0, 0.0, 0.0};
        rig.feed().push(time, pose);
    };
    rig.run_for(1.0);
    EXPECT_LT(rig.largest_step_deg(before), kOrdinaryStep_deg);
    for (const DisplayRecord& record : rig.records()) EXPECT_TRUE(sanitised(record.world_from_head).has_value());
}

TEST(ServerFaults, AWildSampleNowAndThenIsNotSeen) {
    FaultRig rig;
    const std::size_t before = rig.records().size();
    int count = 0;
    rig.tracker = [&](TimePoint time) {
        Pose pose = true_head(time);
        if (++count % 37 == 0) {
            pose.orientation = pose.orientation * glm::angleAxis(0.5, glm::dvec3{1.0, 0.0, 0.0});
            pose.position_m.y += 0.4;
        }
        rig.feed().push(time, pose);
    };
    rig.run_for(2.0);
    EXPECT_LT(rig.largest_step_deg(before), kOrdinaryStep_deg);
}

}  // namespace
}  // namespace lw
