#pragma once
/// What the factory of a warp method returns, and how it reads its settings. The factories themselves are declared by
/// the list in registry.cpp.

#include <memory>
#include <string>

#include "warp_server/methods/registry.h"

namespace lw {

/// Every factory: `label` is the specification as given; keys were checked against the method's list, values were not.
using MadeMethod = Result<std::unique_ptr<WarpMethod>>;

/// Value of a whole-number setting, `fallback` when absent.
/// @return an error that names the label when it is no whole number in [lowest, highest]
[[nodiscard]] Result<int> whole_setting(const std::string& label, const MethodSettings& settings, std::string_view key,
                                        int fallback, int lowest, int highest);

}  // namespace lw
