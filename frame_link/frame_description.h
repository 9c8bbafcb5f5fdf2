#pragma once
/// frame.json: everything of a frame folder but the pixels. Schema: docs/formats.md.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/object_transform.h"
#include "core/result.h"
#include "frame_link/rendered_frame.h"

namespace lw {

enum class DepthEncoding {
    kReverseZ,   ///< near_m / distance_m, background 0
    kDistanceM,  ///< metres along the view axis, background +inf
};

struct LayerDescription {
    std::string name;
    Camera camera;
    bool alpha_is_share = false;  ///< CpuPixels::alpha_is_share
    bool has_quarters = false;    ///< CpuPixels::quarters lie in a file of their own
    int quarter_samples = 1;
    DepthEncoding depth_encoding = DepthEncoding::kReverseZ;
    double time_s = 0.0;          ///< scene time of the movers
    double pose_sampled_s = 0.0;  ///< stamp of the pose sample, seconds since the clock's zero
    std::vector<ObjectTransform> movers;
};

struct FrameDescription {
    std::uint64_t index = 1;
    std::vector<LayerDescription> layers;
    std::vector<std::string> warnings;
};

/// Layer names are also file names: 1-64 letters, digits, '-' and '_'. Pure.
[[nodiscard]] bool is_layer_name(std::string_view name);

/// Reads and checks frame.json. `where` names it in errors. Pure.
[[nodiscard]] Result<FrameDescription> parse_frame_description(std::string_view json, const std::string& where);

/// The text of frame.json; numbers in the shortest form that reads back as the same double. Pure.
[[nodiscard]] std::string frame_description_of(const RenderedFrame& frame);

/// `objects[]`, at the top of a JSON file or in an object there. By ascending id. Pure.
[[nodiscard]] Result<std::vector<ObjectTransform>> parse_objects(std::string_view json, const std::string& where);

}  // namespace lw
