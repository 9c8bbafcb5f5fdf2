#include "warp_server/pacer.h"

#include <algorithm>
#include <cmath>

namespace lw {

PacerPlan Pacer::next_wake(TimePoint now, const Refresh& next) const {
    Refresh refresh = next;
    const bool too_slow = is_too_slow_for(next.period);
    if (!settings_.fixed_lead) {
        const Duration least = too_slow ? ordinary_work_ + margin_ : ordinary_work_;
        while (refresh.scanout_begin - now < least) {
            ++refresh.number;
            refresh.scanout_begin += next.period;
        }
    }
    const Duration needed = too_slow ? ordinary_work_ + margin_ : lead(next.period);
    return {refresh, std::max(now, refresh.scanout_begin - needed)};
}

Duration Pacer::lead(Duration period) const {
    if (settings_.fixed_lead) return *settings_.fixed_lead;
    const Duration longest = period * settings_.longest_lead_periods;
    if (work_count_ < kEnough) return from_seconds(kUnlearntLead * to_seconds(longest));
    return std::min(slow_work_ + margin_, longest);
}

void Pacer::finished(const PacerOutcome& outcome) {
    work_[work_count_ % kWindow] = outcome.presented - outcome.planned_wake;
    ++work_count_;
    slow_work_ = work_quantile(kQuantile);
    ordinary_work_ = work_quantile(0.5);

    const bool missed = outcome.presented > outcome.refresh.scanout_begin;
    const Duration change = missed ? settings_.miss_step : -settings_.miss_step / kHitsPerMiss;
    margin_ = std::clamp(margin_ + change, settings_.smallest_margin,
                         std::max(settings_.smallest_margin, outcome.refresh.period * settings_.longest_lead_periods));
}

Duration Pacer::work_quantile(double quantile) const {
    std::array<Duration, kWindow> sorted = work_;
    const std::size_t count = std::min(work_count_, kWindow);
    const auto rank = static_cast<std::size_t>(std::ceil(quantile * static_cast<double>(count))) - 1;
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), place, sorted.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
}

}  // namespace lw
