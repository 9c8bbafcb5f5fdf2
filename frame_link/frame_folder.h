#pragma once
/// Frame folders: a rendered frame as files (frame.json with schema latewarp.frame/1, per layer NAME.color.png,
/// NAME.depth.pfm, NAME.id.png). Format: docs/formats.md.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "frame_link/rendered_frame.h"

namespace lw {

struct LoadedFrame {
    std::shared_ptr<const RenderedFrame> frame;  ///< CPU pixels; depth converted to reversed infinite depth
    std::vector<std::string> warnings;
};

/// Reads and checks a frame folder. Depth may be encoded as `reverse_z` or `distance_m` (background +inf).
[[nodiscard]] Result<LoadedFrame> load_frame_folder(const std::filesystem::path& folder);

/// Writes `frame` (CPU pixels) into `folder`, which is created; frame.json is written last.
[[nodiscard]] Status save_frame_folder(const RenderedFrame& frame, const std::filesystem::path& folder);

/// Reads `objects[]` ({id, world_from_object: 16 numbers, column-major}) from a JSON file, as `warp --objects` takes
/// it.
[[nodiscard]] Result<std::vector<ObjectTransform>> load_object_transforms(const std::filesystem::path& file);

}  // namespace lw
