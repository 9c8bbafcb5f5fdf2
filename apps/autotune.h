#pragma once
/// `--method auto`: the warp method and fill that measured data of this machine recommend.

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "apps/bench_point.h"
#include "apps/options.h"
#include "core/result.h"

namespace lw {

/// What the method is chosen for. Exactly one of `error_cap` and `budget_ms` is given.
struct AutotuneRequest {
    std::optional<double> error_cap;  ///< mean FLIP that must not be exceeded: the cheapest such method is chosen
    std::optional<double> budget_ms;  ///< of a warp with its fill: the method with the least error in it is chosen
    BenchConditions conditions;       ///< of the run
    std::optional<std::string> fill;  ///< only this one
    bool gl_allowed = true;           ///< live on a software GL, a method on GL waits for the client's drawing
};

struct AutotuneChoice {
    std::string method;
    std::string fill;
    double warp_ms = 0.0;  ///< expected, median
    double flip = 0.0;     ///< expected, mean
    bool met = true;       ///< false: nothing meets the request, this comes nearest
    std::string reason;    ///< one line: which and why
};

/// Compares the methods at the request's conditions. Errors are those measured at the nearest density, samples and
/// size, interpolated between frame ages; times those at the nearest density and age, interpolated between numbers of
/// pixels and proportional to them beyond the measured sizes. Ties go to the earlier point. An error if no point can
/// be used. Pure.
[[nodiscard]] Result<AutotuneChoice> choose_method(const BenchData& data, const AutotuneRequest& request);

/// Where `bench` keeps what it measured: latewarp/bench.json in the user's cache folder ($XDG_CACHE_HOME, else
/// $HOME/.cache); empty if there is none.
[[nodiscard]] std::filesystem::path measured_data_path();

/// Replaces `--method auto` by a choice, and says which and why in one line on standard error unless quiet; options
/// with another method come back as they are. No data, or data of another machine, is an error that names the mend.
[[nodiscard]] Result<Options> with_chosen_method(const Options& options);

}  // namespace lw
