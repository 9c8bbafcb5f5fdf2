#include "apps/live_timeline.h"

#include <fmt/format.h>

#include <algorithm>

namespace lw {
namespace {

// A few colours are enough to tell a frame from the ones before and after.
constexpr std::uint64_t kFrameColours = 4;
std::size_t style_of(std::uint64_t frame) { return static_cast<std::size_t>(frame % kFrameColours); }

// The first part after the middle of the run that shows another frame than the part before.
std::size_t first_of_a_frame(const std::vector<DisplayRecord>& parts) {
    const std::size_t middle = parts.size() / 2;
    for (std::size_t i = middle + 1; i < parts.size(); ++i) {
        if (parts[i].presented && parts[i].frame_index > parts[i - 1].frame_index) return i;
    }
    return middle;
}

class Timeline {
public:
    Timeline(const LiveResult& result, TimePoint from, TimePoint to)
        : from_{from},
          picture_{"What each thread did when", "time, ms (every rendered frame has its colour)", 0.0,
                   to_ms(to - from)} {
        add_lives(result.parts);
        add_client(result.app_frames);
        add_server(result.parts);
        add_display(result.parts);
    }

    [[nodiscard]] const SvgLanes& picture() const { return picture_; }

private:
    [[nodiscard]] SvgBar bar(TimePoint begin, TimePoint end, std::uint64_t frame, std::string text = {}) const {
        return {to_ms(begin - from_), to_ms(end - from_), style_of(frame), std::move(text)};
    }
    [[nodiscard]] bool is_inside(TimePoint time) const { return time >= from_ && to_ms(time - from_) <= picture_.end; }

    // One below the other, since a frame is sampled before the one before it was shown.
    void add_lives(const std::vector<DisplayRecord>& parts) {
        SvgLane lanes[2] = {{"head sample to"}, {"first photon"}};
        std::uint64_t newest = 0;
        for (const DisplayRecord& part : parts) {
            if (!part.presented || part.frame_index == newest) continue;
            newest = part.frame_index;
            if (!is_inside(part.photon) && !is_inside(part.frame_pose_sampled)) continue;
            const double ms = to_ms(part.photon - part.frame_pose_sampled);
            lanes[newest % 2].bars.push_back(
                bar(part.frame_pose_sampled, part.photon, newest, fmt::format("{:.0f} ms", ms)));
        }
        for (SvgLane& lane : lanes) picture_.lanes.push_back(std::move(lane));
    }

    void add_client(const std::vector<ClientFrameRecord>& frames) {
        SvgLane draws{"client draws"};
        SvgLane prepares{"client prepares"};
        for (const ClientFrameRecord& frame : frames) {
            draws.bars.push_back(bar(frame.times.render_begin, frame.times.render_end, frame.index,
                                     fmt::format("frame {}", frame.index)));
            prepares.bars.push_back(bar(frame.times.render_end, frame.times.published, frame.index));
        }
        picture_.lanes.push_back(std::move(draws));
        picture_.lanes.push_back(std::move(prepares));
    }

    void add_server(const std::vector<DisplayRecord>& parts) {
        SvgLane warps{"server warps"};
        for (const DisplayRecord& part : parts) {
            if (part.presented) warps.bars.push_back(bar(part.latched, *part.presented, part.frame_index));
        }
        picture_.lanes.push_back(std::move(warps));
    }

    void add_display(const std::vector<DisplayRecord>& parts) {
        SvgLane shows{"display shows"};
        for (const DisplayRecord& part : parts) {
            const Duration half = part.photon - part.scanout_begin;
            shows.bars.push_back(bar(part.scanout_begin, part.photon + half, part.frame_index));
            shows.bars.back().hollow = part.missed();
        }
        picture_.lanes.push_back(std::move(shows));
    }

    TimePoint from_;
    SvgLanes picture_;
};

}  // namespace

SvgLanes timeline_of(const LiveResult& result, Duration span) {
    if (result.parts.empty()) return Timeline{result, {}, TimePoint{} + span}.picture();
    const DisplayRecord& first_shown = result.parts[first_of_a_frame(result.parts)];
    const TimePoint to = first_shown.photon + span / 4;
    return Timeline{result, std::min(first_shown.frame_pose_sampled - span / 20, to - span), to}.picture();
}

}  // namespace lw
