#include "warp_server/fill.h"

#include <algorithm>

#include "warp_server/fill_nearest_background.h"
#include "warp_server/fill_pyramid.h"

namespace lw {
namespace {

class FillNone final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "none"; }

    void apply(DisplayFrame& frame, const FillGuide& /*guide*/) override {
        const std::span<Coverage> coverage = frame.coverage.pixels();
        for (std::size_t i = 0; i < coverage.size(); ++i) {
            if (coverage[i] != Coverage::hole) continue;
            frame.colour.pixels()[i] = kNothingColour;
            frame.depth.pixels()[i] = 0.0F;
            coverage[i] = Coverage::filled;
        }
    }
};

struct FillEntry {
    std::string_view name;
    std::unique_ptr<Fill> (*make)();
};

constexpr FillEntry kFills[] = {
    {"none", []() -> std::unique_ptr<Fill> { return std::make_unique<FillNone>(); }},
    {"nearest-background", make_nearest_background_fill},
    {"pyramid", make_pyramid_fill},
};

}  // namespace

std::vector<std::string_view> fill_names() {
    std::vector<std::string_view> names;
    for (const FillEntry& entry : kFills) names.push_back(entry.name);
    return names;
}

Result<std::unique_ptr<Fill>> make_fill(std::string_view name) {
    for (const FillEntry& entry : kFills) {
        if (entry.name == name) return entry.make();
    }
    std::string known;
    for (const FillEntry& entry : kFills) known += (known.empty() ? "" : ", ") + std::string{entry.name};
    return Error{"unknown fill", std::string{name}, "one of: " + known};
}

double hole_fraction(const DisplayFrame& frame) {
    const std::span<const Coverage> coverage = frame.coverage.pixels();
    if (coverage.empty()) return 0.0;
    const auto unreached =
        std::count_if(coverage.begin(), coverage.end(), [](Coverage value) { return value != Coverage::reached; });
    return static_cast<double>(unreached) / static_cast<double>(coverage.size());
}

}  // namespace lw
