#pragma once
/// The list of warp methods: names, what they need, how they are made.

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Settings of a method specification "name:key=value,key=value".
using MethodSettings = std::map<std::string, double, std::less<>>;

struct MethodEntry {
    std::string_view name;
    std::string_view summary;   ///< one line for --help
    bool needs_gl;              ///< make() and warp() want a current GL 4.5 context on the calling thread
    std::string_view settings;  ///< keys it takes, comma separated, empty for none
    Result<std::unique_ptr<WarpMethod>> (*make)(std::string label, const MethodSettings& settings);
};

/// In the order of docs: baselines, GL, CPU, reference.
[[nodiscard]] std::span<const MethodEntry> warp_methods();

/// Null for an unknown name. `specification` may carry settings.
[[nodiscard]] const MethodEntry* find_warp_method(std::string_view specification);

/// Makes the method a specification names; unknown names, keys and values outside their range are errors.
[[nodiscard]] Result<std::unique_ptr<WarpMethod>> make_warp_method(std::string_view specification);

}  // namespace lw
