#include "client_renderer/shell_budget.h"

#include <algorithm>

namespace lw {
namespace {

// Follows a change within a few draws and halves what the machine adds by chance.
constexpr double kNewest = 0.4;

bool comes_before(const DrawCandidate& a, const DrawCandidate& b, double max_age_s) {
    const bool a_overdue = a.waiting_s > max_age_s;
    const bool b_overdue = b.waiting_s > max_age_s;
    if (a_overdue != b_overdue) return a_overdue;
    if (a_overdue && a.waiting_s != b.waiting_s) return a.waiting_s > b.waiting_s;
    const double a_value = a.priority * b.cost_ms;
    const double b_value = b.priority * a.cost_ms;
    return a_value != b_value ? a_value > b_value : a.item < b.item;
}

}  // namespace

void CostBook::learn(std::size_t item, double measured_ms) {
    std::optional<double>& cost_ms = costs_ms_[item];
    cost_ms = cost_ms ? *cost_ms + kNewest * (measured_ms - *cost_ms) : measured_ms;
}

std::vector<std::size_t> choose_items(const std::vector<DrawCandidate>& candidates, const BudgetSettings& settings) {
    std::vector<DrawCandidate> wanted;
    for (const DrawCandidate& candidate : candidates) {
        if (candidate.priority >= settings.least_error_px) wanted.push_back(candidate);
    }
    std::sort(wanted.begin(), wanted.end(),
              [&](const DrawCandidate& a, const DrawCandidate& b) { return comes_before(a, b, settings.max_age_s); });
    std::vector<std::size_t> chosen;
    double left_ms = settings.budget_ms;
    for (const DrawCandidate& candidate : wanted) {
        if (candidate.cost_ms > left_ms) continue;
        left_ms -= candidate.cost_ms;
        chosen.push_back(candidate.item);
    }
    if (!wanted.empty() && wanted.front().waiting_s > settings.max_age_s &&
        wanted.front().cost_ms > settings.budget_ms) {
        return {wanted.front().item};
    }
    return chosen;
}

double modelled_cost_ms(double triangles, double samples, double covered_samples) {
    constexpr double kFixed_ms = 0.5;
    constexpr double kMsPerTriangle = 0.11e-3;
    constexpr double kMsPerSample = 0.04e-3;
    constexpr double kMsPerCoveredSample = 0.10e-3;
    return kFixed_ms + kMsPerTriangle * triangles + kMsPerSample * samples + kMsPerCoveredSample * covered_samples;
}

}  // namespace lw
