#include "apps/demo_controls.h"

#include "core/check.h"
#include "warp_server/methods/registry.h"

namespace lw {
namespace {

constexpr Rgba8 kHoleColour{255, 0, 255, 255};

class DemoFill final : public Fill {
public:
    DemoFill(std::unique_ptr<Fill> fill, const DemoControls& controls) : fill_{std::move(fill)}, controls_{controls} {}
    [[nodiscard]] std::string_view name() const override { return fill_->name(); }
    void work_on(TaskPool* threads) override { fill_->work_on(threads); }
    void apply(DisplayFrame& frame, const FillGuide& guide) override {
        if (!controls_.holes_shown.load(std::memory_order_relaxed)) return fill_->apply(frame, guide);
        const auto coverage = frame.coverage.pixels();
        for (std::size_t i = 0; i < coverage.size(); ++i) {
            if (coverage[i] == Coverage::hole) frame.colour.pixels()[i] = kHoleColour;
        }
    }

private:
    std::unique_ptr<Fill> fill_;
    const DemoControls& controls_;
};

std::string_view name_in(std::string_view specification) { return specification.substr(0, specification.find(':')); }

}  // namespace

SwitchingMethod::SwitchingMethod(std::vector<std::unique_ptr<WarpMethod>> methods, const DemoControls& controls)
    : methods_{std::move(methods)}, controls_{controls} {
    LW_CHECK(!methods_.empty(), "no method to switch to");
}

WarpMethod& SwitchingMethod::active() const {
    return *methods_[controls_.method.load(std::memory_order_relaxed) % methods_.size()];
}

void SwitchingMethod::warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) {
    WarpMethod& method = active();
    method.warp(layer, target, out);
    counters_ = method.counters();
}

TaskPool* SwitchingMethod::threads() {
    for (const auto& method : methods_) {
        if (TaskPool* threads = method->threads()) return threads;
    }
    return nullptr;
}

std::vector<std::string> SwitchingMethod::labels() const {
    std::vector<std::string> labels;
    for (const auto& method : methods_) labels.emplace_back(method->label());
    return labels;
}

Result<std::unique_ptr<SwitchingMethod>> make_demo_method(const std::string& first, const DemoControls& controls) {
    std::vector<std::string> specifications{first};
    for (const char* other : {"stale", "rotation", "splat:threads=2", "surface:threads=2,flatten=1", "inverse"}) {
        const MethodEntry* entry = find_warp_method(other);
        if (entry == nullptr || entry->needs_gl || name_in(first) == name_in(other)) continue;
        specifications.emplace_back(other);
    }
    std::vector<std::unique_ptr<WarpMethod>> methods;
    for (const std::string& specification : specifications) {
        auto method = make_warp_method(specification);
        if (!method) return method.error();
        methods.push_back(*std::move(method));
    }
    return std::make_unique<SwitchingMethod>(std::move(methods), controls);
}

std::unique_ptr<Fill> make_demo_fill(std::unique_ptr<Fill> fill, const DemoControls& controls) {
    return std::make_unique<DemoFill>(std::move(fill), controls);
}

}  // namespace lw
