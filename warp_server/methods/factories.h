#pragma once
/// One factory per warp method, defined in the method's own file and listed in registry.cpp.

#include <memory>
#include <string>

#include "warp_server/methods/registry.h"

namespace lw {

/// Every factory: `label` is the specification as given; keys were checked against the method's list, values were not.
using MadeMethod = Result<std::unique_ptr<WarpMethod>>;

[[nodiscard]] MadeMethod make_stale_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_rotation_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_points_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_mesh_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_compute_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_inverse_gl_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_surface_gl_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_splat_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_inverse_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_surface_method(std::string label, const MethodSettings& settings);
[[nodiscard]] MadeMethod make_reference_method(std::string label, const MethodSettings& settings);

/// Value of a whole-number setting, `fallback` when absent.
/// @return an error that names the label when it is no whole number in [lowest, highest]
[[nodiscard]] Result<int> whole_setting(const std::string& label, const MethodSettings& settings, std::string_view key,
                                        int fallback, int lowest, int highest);

}  // namespace lw
