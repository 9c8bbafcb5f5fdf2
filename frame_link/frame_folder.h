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

/// Reads and checks a frame folder. Depth may be encoded as `reverse_z` or `distance_m` (background +inf). Bad pixels
/// and object ids without a placement are counted in warnings; everything else that is wrong is an error. Layers have
/// no stamps but `pose_sampled`, and nothing prepared. Any thread.
[[nodiscard]] Result<LoadedFrame> load_frame_folder(const std::filesystem::path& folder);

/// Writes `frame` (CPU pixels; programmer error otherwise) into `folder`, which is created. What load_frame_folder()
/// reads back is the same bit for bit. frame.json is removed first and written last: when writing fails the folder
/// holds no frame, never a half-written one. Any thread; one writer per folder.
[[nodiscard]] Status save_frame_folder(const RenderedFrame& frame, const std::filesystem::path& folder);

/// Reads `objects[]` ({id, world_from_object: 16 numbers, column-major}) from a JSON file, as `warp --objects` takes
/// it: an object with that list in it, or the list alone. By ascending id.
[[nodiscard]] Result<std::vector<ObjectTransform>> load_object_transforms(const std::filesystem::path& file);

}  // namespace lw
