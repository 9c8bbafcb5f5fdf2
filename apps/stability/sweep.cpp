#include "apps/stability/sweep.h"

#include <fmt/format.h>

#include <array>

#include "warp_server/methods/registry.h"

namespace lw::stability {

Result<Sweep> Sweep::create(const std::vector<std::string>& methods, CaseRange range) {
    std::vector<std::unique_ptr<WarpMethod>> made;
    for (const std::string& specification : methods) {
        Result<std::unique_ptr<WarpMethod>> method = make_warp_method(specification);
        if (!method) return method.error();
        made.push_back(*std::move(method));
    }
    return Sweep{std::move(made), range};
}

Sweep::Sweep(std::vector<std::unique_ptr<WarpMethod>> methods, CaseRange range)
    : range_{range}, methods_{std::move(methods)} {
    for (const auto& method : methods_) reports_.push_back({std::string{method->label()}, {}});
}

void Sweep::run(std::uint64_t seed) {
    const StabilityCase made = make_case(seed, range_);
    const std::array<Layer, 2> layers{layer_of(made, CasePattern::index), layer_of(made, CasePattern::lattice)};
    const std::array<PictureOracle, 3> oracles{PictureOracle{made, OracleMotion::full},
                                               PictureOracle{made, OracleMotion::rotation},
                                               PictureOracle{made, OracleMotion::none}};
    for (std::size_t i = 0; i < methods_.size(); ++i) {
        const MethodKind kind = kind_of(reports_[i].method);
        const Layer& layer = layers[static_cast<std::size_t>(pattern_of(kind))];
        methods_[i]->warp(layer, {made.target, made.at_target}, frame_);
        reports_[i].errors.add(check_picture(oracles[static_cast<std::size_t>(motion_of(kind))], layer, kind, frame_));
    }
}

std::vector<std::string> cpu_methods() {
    std::vector<std::string> names;
    for (const MethodEntry& entry : warp_methods()) {
        if (!entry.needs_gl) names.emplace_back(entry.name);
    }
    return names;
}

std::string summary_of(const MethodReport& report) {
    const MethodErrors& e = report.errors;
    return fmt::format(
        "{:10} {} cases, {} pixels: place {:.5f} px (case {}, pixel {},{}), depth {:.2e} (case {}, pixel {},{}); wrong "
        "surface {}, missing {}, invented {}, unusable {}{}",
        report.method, e.cases, e.pixels, e.place_px.value, e.place_px.seed, e.place_px.x, e.place_px.y, e.depth.value,
        e.depth.seed, e.depth.x, e.depth.y, e.wrong_surface, e.missing, e.invented, e.unusable,
        e.first_fault.value > 0.0
            ? fmt::format(" (case {}, pixel {},{})", e.first_fault.seed, e.first_fault.x, e.first_fault.y)
            : "");
}

}  // namespace lw::stability
