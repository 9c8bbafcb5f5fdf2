#pragma once
/// A case as files, to be looked at with `latewarp warp`.

#include <filesystem>
#include <string>

#include "apps/stability/stability_case.h"
#include "core/result.h"

namespace lw::stability {

/// Writes the case's frame folder and, beside it, objects.json with the placements at the target's time.
/// @return the `latewarp warp` command that shows it: with the target's pose and size. Its field of view is the
/// source's where the case's target has another.
[[nodiscard]] Result<std::string> save_case(std::uint64_t seed, CaseRange range, const std::filesystem::path& folder);

}  // namespace lw::stability
