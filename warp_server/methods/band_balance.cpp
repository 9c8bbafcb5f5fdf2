#include "warp_server/methods/band_balance.h"

#include <algorithm>
#include <numeric>

namespace lw {

void BandBalance::cut(std::span<const float> cost_until, std::span<RowRange> bands) {
    if (ends_.size() != bands.size()) {
        ends_.resize(bands.size());
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            ends_[i] = static_cast<double>(i + 1) / static_cast<double>(ends_.size());
        }
    }
    const int rows = static_cast<int>(cost_until.size()) - 1;
    int begin = 0;
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const bool is_last = i + 1 == bands.size();
        const auto cost = static_cast<float>(ends_[i] * static_cast<double>(cost_until.back()));
        bands[i] = {begin, is_last ? rows : std::max(begin, row_at_cost(cost_until, cost))};
        begin = bands[i].end;
    }
}

// Within a band time is taken to pass as the estimate does.
void BandBalance::learn(std::span<const double> times) {
    const double total = std::accumulate(times.begin(), times.end(), 0.0);
    if (!(total > 0.0) || times.size() != ends_.size()) return;
    learned_ = ends_;
    std::size_t band = 0;
    double before = 0.0;  // time of the bands before `band`
    for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
        const double wanted = total * static_cast<double>(i + 1) / static_cast<double>(ends_.size());
        while (band + 1 < times.size() && before + times[band] < wanted) before += times[band++];
        const double begin = band == 0 ? 0.0 : ends_[band - 1];
        const double ideal = begin + (ends_[band] - begin) * (wanted - before) / times[band];
        learned_[i] += std::clamp(kTaughtPart * (ideal - ends_[i]), -kLargestStep, kLargestStep);
        if (i > 0) learned_[i] = std::max(learned_[i], learned_[i - 1]);
    }
    std::swap(ends_, learned_);
}

}  // namespace lw
