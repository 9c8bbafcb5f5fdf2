#pragma once
/// When to wake for a refresh: as late as the time from waking to presenting allows, because every millisecond of lead
/// is a millisecond of latency. That time changes little from one refresh to the next, and threefold within a frame's
/// life, as the head turns away from where the frame was drawn: so what is learnt is by how much it grows at once. Pure
/// logic; time is an argument.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/clock.h"
#include "warp_server/presenter.h"

namespace lw {

struct PacerSettings {
    /// Latch exactly this long before each scan-out (--lead); learnt when empty. >= 0.
    std::optional<Duration> fixed_lead;
    /// Each refresh is made in so many strips, and the periods that the pacer is told of are theirs. The lead is at
    /// most so many of them, one refresh: an earlier picture would overtake the one before.
    int strips = 1;
    /// The lead is never less than what the work is expected to take and may grow by, plus the share's part of a
    /// period, within these bounds. Of whole pictures in runs of a minute no growth went beyond the 99th percentile by
    /// more than a millisecond and a half. A strip follows its latch sooner, and spends part of what that gains on
    /// being ready: work that takes thrice as long once a minute. Halves miss next to nothing with this margin, and are
    /// 2 to 3 ms younger than whole pictures all the same (docs/latency.md).
    struct Margin {
        double share;
        Duration least;
        Duration most;
    };
    Margin whole_margin{0.125, from_ms(0.3), from_ms(1.5)};
    Margin strip_margin{1.0, from_ms(0.3), from_ms(4.5)};
    /// What a missed refresh adds to the margin, where more lead would have helped: work longer than the longest lead
    /// is nothing to be ready for.
    Duration miss_step = from_ms(0.25);
};

/// What the server does next.
struct PacerPlan {
    Refresh refresh;  ///< the refresh to make a picture for
    TimePoint wake;   ///< when to latch; not before `now`
};

/// How the work for one refresh went.
struct PacerOutcome {
    Refresh refresh;
    TimePoint planned_wake;
    TimePoint presented;
};

/// One thread.
class Pacer {
public:
    explicit Pacer(const PacerSettings& settings = {}) : settings_{settings} {}

    /// `next` is the first refresh that still lacks a picture (Presenter::next_refresh). The plan is made for it, or,
    /// when the time left is less than the work ordinarily takes, for the first refresh that can still be reached: a
    /// picture predicted to the time it is really shown is worth more than an attempt that is bound to be late, and a
    /// single overrun then costs one refresh more instead of delaying all that follow. Where the work is too slow for
    /// every strip, that is the same strip of a later refresh. `next.scanout_begin` > `now`.
    [[nodiscard]] PacerPlan next_wake(TimePoint now, const Refresh& next) const;

    /// Learns from a finished refresh. A late wake-up counts as work: on a machine that wakes threads late the lead has
    /// to cover it. A miss that more lead would have prevented widens the margin by `miss_step`; every other picture
    /// takes 1/kHitsPerMiss of that back.
    void finished(const PacerOutcome& outcome);

    /// Time from waking to scan-out that next_wake() uses for a display of this period. At most a refresh, where it is
    /// learnt.
    [[nodiscard]] Duration lead(Duration period) const;

    /// The work ordinarily takes longer than a period of this length: not every refresh can get a picture.
    [[nodiscard]] bool is_too_slow_for(Duration period) const { return ordinary_work_ > period; }

    static constexpr int kHitsPerMiss = 500;
    /// Work times, and growths, remembered: 6 s at 90 Hz, so that one disturbance is forgotten after that. Half as
    /// many, and twice the share left out, missed 14 of 30,000 refreshes of recorded runs instead of 9: the largest
    /// growths come once per frame of the client, as it begins to draw, and too few of them were kept.
    static constexpr std::size_t kWindow = 512;
    /// Until this many are known the lead is kUnlearntLead of a period.
    static constexpr std::size_t kEnough = 8;
    static constexpr double kUnlearntLead = 0.8;
    /// So many growths in a hundred, but one at least, are left out as too large: disturbances come in threes and fours
    /// (the first pictures of all are one), which must not keep the lead at a whole period.
    static constexpr std::size_t kLeftOut_percent = 1;

private:
    using Window = std::array<Duration, kWindow>;

    [[nodiscard]] Duration smallest_margin(Duration period) const;
    [[nodiscard]] Duration margin(Duration period) const { return std::max(margin_, smallest_margin(period)); }
    /// The value that `larger` others in the window are larger than, or as large.
    [[nodiscard]] Duration largest_but(const Window& window, std::size_t larger) const;

    PacerSettings settings_;
    Duration margin_{};  ///< after misses; at least the smallest
    Window work_{};
    Window growth_{};  ///< of each work beyond what was expected of it
    std::size_t work_count_ = 0;
    Duration last_work_{};
    Duration expected_work_{};  ///< the longer of the last two
    Duration ordinary_work_{};  ///< median of the window
    Duration fast_growth_{};    ///< the largest of the window but those left out, not below 0
};

}  // namespace lw
