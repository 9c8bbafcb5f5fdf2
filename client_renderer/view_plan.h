#pragma once
/// How finely the nearest shell is drawn where the head looks, and with how much around and behind it: as the budget
/// allows.

#include <array>
#include <optional>
#include <span>

namespace lw {

struct ViewPlan {
    double density = 1.0;       ///< times the source's density
    bool hidden = true;         ///< with a hidden layer
    double extent_share = 1.0;  ///< of what is needed around the display (view_extent.h)
    bool one_side = false;      ///< the other one is shown from the frame before (view_sides.h)
};

/// From best to cheapest. All that the eye is expected to see comes first: past the view's edge older tiles of the
/// shell stand in. Then density: of a walk through `city` 1.5 takes a fifth of FLIP off, and 2 three tenths
/// (`replay city --trace walk --source-density`); so what the view hides is left to older tiles where it would cost
/// that. One side at a time is as good as the whole where that may be drawn at all, and denser.
[[nodiscard]] std::span<const ViewPlan> view_plans();

/// What plans will cost, from what the last view held. One thread.
class ViewCosts {
public:
    /// One picture of everything was drawn.
    /// @param covered  share of its samples that show a surface
    void start(double triangles, double covered);

    /// A view was drawn: its first layer, and what is hidden behind it, where that was drawn.
    struct Drawn {
        double samples = 0.0;  ///< of one layer
        double triangles = 0.0;
        double covered = 0.0;  ///< samples that show a surface
        std::optional<double> hidden_triangles{};
        double hidden_covered = 0.0;
        double share = 1.0;  ///< of the view that was drawn
    };
    void learn(const Drawn& view, double cost_ms);

    /// What will be drawn of a view.
    struct Planned {
        double samples = 0.0;             ///< of one layer
        double share = 1.0;               ///< of the view
        std::optional<double> covered{};  ///< share of the samples that will show a surface; nothing: as before
    };
    [[nodiscard]] double expected_ms(const ViewPlan& plan, const Planned& view) const;

    /// What the view that was drawn is modelled to cost.
    [[nodiscard]] static double modelled_ms(const Drawn& view);

private:
    [[nodiscard]] double predicted_ms(bool hidden, const Planned& planned) const;

    double triangles_ = 0.0;
    double covered_ = 1.0;  // shares of the samples
    double hidden_triangles_ = 0.0;
    double hidden_covered_ = 0.0;
    double measured_over_modelled_ = 1.0;
    bool measured_ = false;
};

}  // namespace lw
