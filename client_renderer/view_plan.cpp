#include "client_renderer/view_plan.h"

#include "client_renderer/shell_budget.h"

namespace lw {
namespace {

constexpr std::array<ViewPlan, 13> kPlans{{{2.0, true, true},
                                           {2.0, false, true},
                                           {1.75, true, true},
                                           {1.75, false, true},
                                           {1.5, true, true},
                                           {1.5, false, true},
                                           {1.5, false, false},
                                           {1.25, false, true},
                                           {1.25, false, false},
                                           {1.1, false, false},
                                           {1.0, false, true},
                                           {1.0, true, false},
                                           {1.0, false, false}}};

// Before a hidden layer was drawn: few of its pixels hold something.
constexpr double kHiddenCovered = 0.2;
// As costs of items are smoothed (shell_budget.cpp).
constexpr double kNewest = 0.4;

}  // namespace

std::span<const ViewPlan> view_plans() { return kPlans; }

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
    triangles_ = view.triangles;
    covered_ = view.covered / view.samples;
    if (view.hidden_triangles) {
        hidden_triangles_ = *view.hidden_triangles;
        hidden_covered_ = view.hidden_covered / view.samples;
    }
    const double ratio = cost_ms / modelled_ms(view);
    measured_over_modelled_ = measured_ ? measured_over_modelled_ + kNewest * (ratio - measured_over_modelled_) : ratio;
    measured_ = true;
}

double ViewCosts::expected_ms(const ViewPlan& plan, double samples) const {
    return measured_over_modelled_ * predicted_ms(plan.hidden, samples);
}

double ViewCosts::predicted_ms(bool hidden, double samples) const {
    Drawn view{samples, triangles_, covered_ * samples, {}, 0.0};
    if (hidden) {
        view.hidden_triangles = hidden_triangles_;
        view.hidden_covered = hidden_covered_ * samples;
    }
    return modelled_ms(view);
}

}  // namespace lw
