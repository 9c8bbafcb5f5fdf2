#include "apps/latency_harness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/statistics.h"

namespace lw {
namespace {

/// Pictures (or strips) by what their code says.
class PicturesByCode {
public:
    explicit PicturesByCode(const std::vector<DisplayRecord>& parts) {
        for (const DisplayRecord& part : parts) {
            if (part.presented) by_code_[key_of(code_of(part))] = &part;
        }
    }
    [[nodiscard]] const DisplayRecord* find(const PhotonCode& code) const {
        const auto found = by_code_.find(key_of(code));
        return found == by_code_.end() ? nullptr : found->second;
    }
    [[nodiscard]] static PhotonCode code_of(const DisplayRecord& part) {
        return {static_cast<std::uint32_t>(part.pose_sample), static_cast<std::uint16_t>(part.frame_index)};
    }

private:
    static std::uint64_t key_of(const PhotonCode& code) { return std::uint64_t{code.pose_sample} << 16 | code.frame; }
    std::unordered_map<std::uint64_t, const DisplayRecord*> by_code_;
};

/// What the display should have shown at each strip of each refresh by the server's own account: the newest picture
/// that was there when its scan-out began. One that was just being handed over then may have been seen or not.
class ExpectedCodes {
public:
    explicit ExpectedCodes(const LiveResult& result) : strips_{static_cast<std::uint64_t>(result.strips)} {
        std::vector<std::optional<PhotonCode>> shown(strips_);
        std::vector<std::vector<const DisplayRecord*>> waiting(strips_);
        for (const DisplayRecord& part : result.parts) {
            const auto strip = static_cast<std::size_t>(part.refresh % strips_);
            if (part.presented) waiting[strip].push_back(&part);
            std::vector<const DisplayRecord*> later;
            for (const DisplayRecord* picture : waiting[strip]) {
                if (*picture->presented <= part.scanout_begin) {
                    shown[strip] = PicturesByCode::code_of(*picture);
                } else {
                    later.push_back(picture);
                }
            }
            waiting[strip] = later;
            if (shown[strip]) expected_[part.refresh].certain = *shown[strip];
            for (const DisplayRecord* picture : later) {
                if (picture->warp_end > part.scanout_begin) continue;
                expected_[part.refresh].handed_over = PicturesByCode::code_of(*picture);
            }
        }
    }
    /// Nothing where the server does not know.
    [[nodiscard]] std::optional<bool> agrees(const SeenPart& part) const {
        const auto found = expected_.find(part.refresh * strips_ + static_cast<std::uint64_t>(part.strip));
        if (found == expected_.end()) return std::nullopt;
        return part.code == found->second.certain || part.code == found->second.handed_over;
    }

private:
    struct Expected {
        std::optional<PhotonCode> certain;
        std::optional<PhotonCode> handed_over;
    };
    std::uint64_t strips_;
    std::unordered_map<std::uint64_t, Expected> expected_;
};

/// How far the picture's turn between two refreshes is from what the head did between their photons.
double judder_deg(const ForeseeingHeadPoseFeed& head, const SeenRefresh& before, const Pose& shown_before,
                  const SeenRefresh& now, const Pose& shown) {
    const auto error = [&](const SeenRefresh& refresh, const Pose& pose) {
        return rotation_vector(glm::conjugate(head.pose_at(refresh.photon).orientation) * pose.orientation);
    };
    return glm::length(error(now, shown) - error(before, shown_before)) / kRadPerDeg;
}

/// Mean of the middle nine tenths: a missed refresh is no part of a delay.
std::optional<double> trimmed_mean(std::vector<double> values) {
    if (values.empty()) return std::nullopt;
    std::sort(values.begin(), values.end());
    const std::size_t cut = values.size() / 20;
    double sum = 0.0;
    for (std::size_t i = cut; i < values.size() - cut; ++i) sum += values[i];
    return sum / static_cast<double>(values.size() - 2 * cut);
}

std::optional<double> recovered_from_age(const std::vector<SeenRefresh>& refreshes, Injected what) {
    std::vector<double> with;
    std::vector<double> without;
    for (const SeenRefresh& refresh : refreshes) {
        if (refresh.injected == what) with.push_back(to_ms(refresh.motion_to_photon));
        if (refresh.injected == Injected::nothing) without.push_back(to_ms(refresh.motion_to_photon));
    }
    if (with.size() < LatencyHarness::kFewestCodes || without.size() < LatencyHarness::kFewestCodes) {
        return std::nullopt;
    }
    return *trimmed_mean(with) - *trimmed_mean(without);
}

/// The stamp of the newest head sample of a picture says when it was latched, to a tracker's period.
TimePoint latched(const SeenRefresh& refresh) { return refresh.photon - refresh.motion_to_photon; }

std::vector<DelayInterval> publication_delays(const LiveResult& result, const std::vector<SeenRefresh>& refreshes,
                                              Injected what) {
    std::unordered_map<std::uint64_t, TimePoint> published;
    for (const ClientFrameRecord& frame : result.app_frames) published[frame.index] = frame.times.published;
    std::vector<DelayInterval> intervals;
    for (std::size_t i = 1; i < refreshes.size(); ++i) {
        const SeenRefresh& first = refreshes[i];
        const SeenRefresh& before = refreshes[i - 1];
        if (first.frame == before.frame || first.refresh != before.refresh + 1) continue;
        const auto found = published.find(first.frame);
        if (found == published.end() || result.injection.settled_at(found->second) != what) continue;
        intervals.push_back({to_ms(latched(before) - found->second), to_ms(latched(first) - found->second)});
    }
    return intervals;
}

/// Fewer frames do not fix a delay to a millisecond: the interval that n of them leave is a refresh divided by n.
constexpr std::size_t kFewestFrames = 20;

std::optional<double> recovered_from_frames(const LiveResult& result, const std::vector<SeenRefresh>& refreshes) {
    const auto with = publication_delays(result, refreshes, Injected::app);
    const auto without = publication_delays(result, refreshes, Injected::nothing);
    if (with.size() < kFewestFrames || without.size() < kFewestFrames) return std::nullopt;
    return *most_common_delay_ms(with) - *most_common_delay_ms(without);
}

void read_codes(const LiveResult& result, LatencyHarness& harness) {
    const PicturesByCode pictures{result.parts};
    const ExpectedCodes expected{result};
    std::uint64_t expected_count = 0;
    std::uint64_t as_expected = 0;
    std::optional<Pose> shown_before;
    for (const SeenPart& part : result.seen) {
        const DisplayRecord* picture = part.code ? pictures.find(*part.code) : nullptr;
        if (picture == nullptr) {
            // Before the first counted picture the display shows what the server warmed up with, or nothing.
            if (harness.codes_read > 0) ++harness.codes_bad;
            continue;
        }
        ++harness.codes_read;
        if (const auto agrees = expected.agrees(part)) {
            ++expected_count;
            if (*agrees) ++as_expected;
        }
        SeenRefresh seen;
        seen.refresh = part.refresh;
        seen.photon = part.photon;
        seen.frame = picture->frame_index;
        seen.motion_to_photon = part.photon - picture->pose_sampled;
        seen.frame_age = part.photon - picture->frame_pose_sampled;
        seen.injected = result.injection.settled_at(part.photon);
        auto& refreshes = harness.refreshes;
        if (!refreshes.empty() && refreshes.back().refresh == part.refresh) {
            // A refresh reports its worst strip; jitter and judder are those of its first.
            SeenRefresh& worst = refreshes.back();
            worst.motion_to_photon = std::max(worst.motion_to_photon, seen.motion_to_photon);
            worst.frame_age = std::max(worst.frame_age, seen.frame_age);
            continue;
        }
        if (!refreshes.empty() && refreshes.back().refresh + 1 == part.refresh) {
            seen.jitter_ms = std::abs(to_ms(seen.motion_to_photon - refreshes.back().motion_to_photon));
            if (result.true_head && shown_before) {
                seen.judder_deg =
                    judder_deg(*result.true_head, refreshes.back(), *shown_before, seen, picture->world_from_head);
            }
        }
        shown_before = picture->world_from_head;
        refreshes.push_back(seen);
    }
    harness.in_phase_share =
        expected_count == 0 ? 0.0 : static_cast<double>(as_expected) / static_cast<double>(expected_count);
    harness.in_phase = harness.in_phase_share >= LatencyHarness::kInPhase;
}

std::string reason_for_suspicion(const LiveResult& result, const LatencyHarness& harness) {
    if (result.in_window) return "a window cannot be read back: latencies are those of time stamps";
    if (harness.codes_read + harness.codes_bad == 0) return "no picture was seen";
    if (harness.codes_bad * 100 > harness.codes_read) {
        return fmt::format("{} of {} codes could not be read", harness.codes_bad,
                           harness.codes_read + harness.codes_bad);
    }
    if (harness.codes_read < LatencyHarness::kFewestCodes) {
        return fmt::format("only {} codes were read", harness.codes_read);
    }
    if (!harness.in_phase) {
        return fmt::format("display and server are not in phase: {:.1f} % of the refreshes show the expected picture",
                           100.0 * harness.in_phase_share);
    }
    return {};
}

}  // namespace

std::optional<double> most_common_delay_ms(const std::vector<DelayInterval>& intervals) {
    struct Edge {
        double at_ms;
        int change;
    };
    std::vector<Edge> edges;
    for (const DelayInterval& interval : intervals) {
        edges.push_back({interval.from_ms, 1});
        edges.push_back({interval.to_ms, -1});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.at_ms < b.at_ms; });
    std::optional<double> middle;
    int depth = 0;
    int most = 0;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        depth += edges[i].change;
        if (depth <= most) continue;
        most = depth;
        middle = 0.5 * (edges[i].at_ms + edges[i + 1].at_ms);
    }
    return middle;
}

LatencyHarness latency_of(const LiveResult& result) {
    LatencyHarness harness;
    read_codes(result, harness);
    harness.suspect = reason_for_suspicion(result, harness);
    if (!harness.suspect.empty()) return harness;
    harness.recovered.tracker_ms = recovered_from_age(harness.refreshes, Injected::tracker);
    harness.recovered.present_ms = recovered_from_age(harness.refreshes, Injected::present);
    harness.recovered.app_ms = recovered_from_frames(result, harness.refreshes);
    return harness;
}

}  // namespace lw
