#pragma once
/// Many cases, several methods: the worst errors of each.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/stability/method_check.h"
#include "core/result.h"

namespace lw::stability {

/// Errors of one method over the cases of a sweep.
struct MethodReport {
    std::string method;
    MethodErrors errors;
};

/// Methods that are asked the same cases. GL methods want a current context on the calling thread.
class Sweep {
public:
    /// `methods` are specifications as on the command line.
    [[nodiscard]] static Result<Sweep> create(const std::vector<std::string>& methods, CaseRange range);

    /// Warps one case with every method and adds what was wrong with each picture.
    void run(std::uint64_t seed);

    [[nodiscard]] const std::vector<MethodReport>& reports() const { return reports_; }

private:
    Sweep(std::vector<std::unique_ptr<WarpMethod>> methods, CaseRange range);

    CaseRange range_;
    std::vector<std::unique_ptr<WarpMethod>> methods_;
    std::vector<MethodReport> reports_;
    DisplayFrame frame_;
};

/// The methods that need no GL, by their names.
[[nodiscard]] std::vector<std::string> cpu_methods();

/// One line: what was compared, the worst errors and how to see them again.
[[nodiscard]] std::string summary_of(const MethodReport& report);

}  // namespace lw::stability
