#pragma once
/// What drawing a billboard anew will cost.

#include <cstdint>

namespace lw {

/// Milliseconds per billboard and per triangle, corrected by what was measured. Without measurements it is a fixed
/// model, so that a run under a virtual clock repeats. One thread at a time.
class UpdateCost {
public:
    /// For one billboard of so many triangles.
    [[nodiscard]] double estimated_ms(std::uint64_t triangles) const {
        return scale_ * (kMsPerBillboard + kMsPerTriangle * static_cast<double>(triangles));
    }

    /// `measured_ms` were spent on `billboards` of `triangles` in all. Follows changes within some ten frames.
    void observe(std::uint64_t triangles, std::uint64_t billboards, double measured_ms) {
        if (billboards == 0) return;
        const double model_ms =
            kMsPerBillboard * static_cast<double>(billboards) + kMsPerTriangle * static_cast<double>(triangles);
        scale_ += 0.2 * (measured_ms / model_ms - scale_);
    }

private:
    // A software GL on two cores draws a million triangles in 100-130 ms.
    static constexpr double kMsPerTriangle = 1.15e-4;
    static constexpr double kMsPerBillboard = 0.01;
    double scale_ = 1.0;
};

}  // namespace lw
