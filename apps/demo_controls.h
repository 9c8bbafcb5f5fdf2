#pragma once
/// What the keys of the demo change while it runs: the warp method, what is shown in holes, the client's rate.

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "warp_server/fill.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Written by the main thread, read by both sides' threads.
class DemoControls {
public:
    /// Rates of the client that the keys step through, 0 being as fast as it can.
    static constexpr std::array<double, 8> kAppRates_hz{1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 0.0};

    /// Strips of a picture double with their key up to so many, and are one again.
    static constexpr int kMostStrips = 8;

    std::atomic<std::size_t> method{0};  ///< index in the list of SwitchingMethod
    std::atomic<bool> holes_shown{false};
    std::atomic<bool> false_colours{false};  ///< which shell each pixel comes from
    std::atomic<bool> renderer_frozen{false};
    std::atomic<std::size_t> app_rate{kAppRates_hz.size() - 1};
    std::atomic<int> strips{1};
    std::atomic<bool> overlay_shown{true};
    std::atomic<bool> recording{false};
};

/// Several warp methods as one; which of them works is read anew at every call.
class SwitchingMethod final : public WarpMethod {
public:
    /// `methods` is not empty; `controls` outlives this.
    SwitchingMethod(std::vector<std::unique_ptr<WarpMethod>> methods, const DemoControls& controls);

    [[nodiscard]] std::string_view label() const override { return active().label(); }
    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return active().prepare(layer);
    }
    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override;
    /// Of whichever method has some: they are idle between warps.
    [[nodiscard]] TaskPool* threads() override;

    [[nodiscard]] std::vector<std::string> labels() const;

private:
    [[nodiscard]] WarpMethod& active() const;

    std::vector<std::unique_ptr<WarpMethod>> methods_;
    const DemoControls& controls_;
};

/// The methods that the demo steps through: `first`, then the CPU methods that can be shown live and differ from it.
[[nodiscard]] Result<std::unique_ptr<SwitchingMethod>> make_demo_method(const std::string& first,
                                                                        const DemoControls& controls);

/// Fills holes with `fill`, or paints them magenta when they are to be seen.
[[nodiscard]] std::unique_ptr<Fill> make_demo_fill(std::unique_ptr<Fill> fill, const DemoControls& controls);

}  // namespace lw
