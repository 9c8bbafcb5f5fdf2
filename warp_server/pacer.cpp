#include "warp_server/pacer.h"

#include <algorithm>
#include <cmath>

namespace lw {

PacerPlan Pacer::next_wake(TimePoint now, const Refresh& next) const {
    Refresh refresh = next;
    const bool too_slow = is_too_slow_for(next.period);
    const Duration slow_needs = ordinary_work_ + margin(next.period);
    if (!settings_.fixed_lead) {
        const Duration least = too_slow ? slow_needs : ordinary_work_;
        while (refresh.scanout_begin - now < least) {
            ++refresh.number;
            refresh.scanout_begin += next.period;
        }
    }
    const Duration needed = too_slow ? slow_needs : lead(next.period);
    return {refresh, std::max(now, refresh.scanout_begin - needed)};
}

Duration Pacer::lead(Duration period) const {
    if (settings_.fixed_lead) return *settings_.fixed_lead;
    const Duration longest = period * settings_.longest_lead_periods;
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
    ordinary_work_ = quantile_of(work_, 0.5);
    fast_growth_ = std::max(quantile_of(growth_, kQuantile), Duration{});

    const Duration period = outcome.refresh.period;
    const bool missed = outcome.presented > outcome.refresh.scanout_begin;
    const Duration change = missed ? settings_.miss_step : -settings_.miss_step / kHitsPerMiss;
    const Duration smallest = smallest_margin(period);
    margin_ =
        std::clamp(margin(period) + change, smallest, std::max(smallest, period * settings_.longest_lead_periods));
}

Duration Pacer::smallest_margin(Duration period) const {
    return std::clamp(period / 8, settings_.smallest_margin, settings_.enough_margin);
}

Duration Pacer::quantile_of(const Window& window, double quantile) const {
    Window sorted = window;
    const std::size_t count = std::min(work_count_, kWindow);
    const auto rank = static_cast<std::size_t>(std::ceil(quantile * static_cast<double>(count))) - 1;
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), place, sorted.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
}

}  // namespace lw
