#include "client_renderer/view_plan.h"

#include <array>
#include <cmath>
#include <vector>

#include "client_renderer/shell_budget.h"

namespace lw {
namespace {

// Densities in steps: the picture's size changes seldom, and 3 % of the budget are left on average. With steps of a
// sixteenth FLIP was 1 % higher.
constexpr double kDensityStep = 1.0 / 32.0;
// With a hidden layer where the picture stays as dense as this.
constexpr double kDenseEnough = 1.5;
// One side at a time where that is as dense as this. A hidden layer with it gave less than the density that it took:
// of `user103` along `city` FLIP 0.0369 instead of 0.0366.
constexpr double kDenserAtLeast = 1.25;
constexpr std::array<double, 3> kLessAround{0.66, 0.33, 0.0};

std::vector<ViewPlan> make_plans() {
    std::vector<ViewPlan> plans;
    const auto add = [&](double most, double least, bool hidden) {
        for (int i = 0; most - i * kDensityStep >= least; ++i) plans.push_back({most - i * kDensityStep, hidden});
    };
    const auto add_sides = [&](double most, double least, bool hidden) {
        for (int i = 0; most - i * kDensityStep >= least; ++i) {
            plans.push_back({most - i * kDensityStep, hidden, 1.0, true});
        }
    };
    add(2.0, 2.0, true);
    add_sides(2.0, 2.0, true);
    add(2.0, 2.0, false);
    add_sides(2.0, kDenserAtLeast, false);
    add(2.0, kDenseEnough, true);
    add(2.0, 1.0, false);
    for (const double share : kLessAround) plans.push_back({1.0, false, share});
    return plans;
}

// Before a hidden layer was drawn: few of its pixels hold something.
constexpr double kHiddenCovered = 0.2;
// As costs of items are smoothed (shell_budget.cpp).
constexpr double kNewest = 0.4;

}  // namespace

std::span<const ViewPlan> view_plans() {
    static const std::vector<ViewPlan> plans = make_plans();
    return plans;
}

void ViewCosts::start(double triangles, double covered) {
    triangles_ = triangles;
    hidden_triangles_ = triangles;
    covered_ = covered;
    hidden_covered_ = kHiddenCovered * covered;
}

double ViewCosts::modelled_ms(const Drawn& view) {
    const double layers = view.hidden_triangles ? 2.0 : 1.0;
    return modelled_cost_ms(view.triangles + view.hidden_triangles.value_or(0.0), layers * view.samples,
                            view.covered + view.hidden_covered);
}

void ViewCosts::learn(const Drawn& view, double cost_ms) {
    triangles_ = view.triangles / view.share;
    covered_ = view.covered / view.samples;
    if (view.hidden_triangles) {
        hidden_triangles_ = *view.hidden_triangles / view.share;
        hidden_covered_ = view.hidden_covered / view.samples;
    }
    const double ratio = cost_ms / modelled_ms(view);
    measured_over_modelled_ = measured_ ? measured_over_modelled_ + kNewest * (ratio - measured_over_modelled_) : ratio;
    measured_ = true;
}

double ViewCosts::expected_ms(const ViewPlan& plan, const Planned& view) const {
    return measured_over_modelled_ * predicted_ms(plan.hidden, view);
}

double ViewCosts::predicted_ms(bool hidden, const Planned& planned) const {
    const double samples = planned.samples;
    Drawn view{samples, planned.share * triangles_, planned.covered.value_or(covered_) * samples, {}, 0.0};
    if (hidden) {
        view.hidden_triangles = planned.share * hidden_triangles_;
        view.hidden_covered = hidden_covered_ * samples;
    }
    return modelled_ms(view);
}

}  // namespace lw
