#include "warp_server/pacer.h"

#include <algorithm>
#include <functional>

namespace lw {

PacerPlan Pacer::next_wake(TimePoint now, const Refresh& next) const {
    if (settings_.fixed_lead) return {next, std::max(now, next.scanout_begin - *settings_.fixed_lead)};
    Refresh refresh = next;
    const bool too_slow = is_too_slow_for(next.period);
    const Duration slow_needs = ordinary_work_ + margin(next.period);
    const Duration least = too_slow ? slow_needs : ordinary_work_;
    const int step = too_slow ? settings_.strips : 1;
    while (refresh.scanout_begin - now < least) {
        refresh.number += static_cast<std::uint64_t>(step);
        refresh.scanout_begin += next.period * step;
    }
    const Duration needed = too_slow ? slow_needs : lead(next.period);
    return {refresh, std::max(now, refresh.scanout_begin - needed)};
}

Duration Pacer::lead(Duration period) const {
    if (settings_.fixed_lead) return *settings_.fixed_lead;
    const Duration longest = period * settings_.strips;
    if (work_count_ < kEnough) return from_seconds(kUnlearntLead * to_seconds(longest));
    return std::min(expected_work_ + fast_growth_ + margin(period), longest);
}

void Pacer::finished(const PacerOutcome& outcome) {
    const Duration work = outcome.presented - outcome.planned_wake;
    const std::size_t at = work_count_ % kWindow;
    work_[at] = work;
    growth_[at] = work_count_ == 0 ? Duration{} : work - expected_work_;
    ++work_count_;
    expected_work_ = std::max(work, last_work_);
    last_work_ = work;
    const std::size_t known = std::min(work_count_, kWindow);
    ordinary_work_ = largest_but(work_, known / 2);
    const std::size_t left_out = std::max<std::size_t>(known * kLeftOut_percent / 100, 1);
    fast_growth_ = std::max(largest_but(growth_, left_out), Duration{});

    const Duration period = outcome.refresh.period;
    const Duration longest_lead = period * settings_.strips;
    const bool missed = outcome.presented > outcome.refresh.scanout_begin && work <= longest_lead;
    const Duration change = missed ? settings_.miss_step : -settings_.miss_step / kHitsPerMiss;
    const Duration smallest = smallest_margin(period);
    margin_ = std::clamp(margin(period) + change, smallest, std::max(smallest, longest_lead));
}

Duration Pacer::smallest_margin(Duration period) const {
    const PacerSettings::Margin& margin = settings_.strips == 1 ? settings_.whole_margin : settings_.strip_margin;
    return std::clamp(from_seconds(margin.share * to_seconds(period)), margin.least, margin.most);
}

Duration Pacer::largest_but(const Window& window, std::size_t larger) const {
    Window sorted = window;
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(work_count_, kWindow));
    const auto place = sorted.begin() + std::min(static_cast<std::ptrdiff_t>(larger), end - sorted.begin() - 1);
    std::nth_element(sorted.begin(), place, end, std::greater<>{});
    return *place;
}

}  // namespace lw
