#pragma once
/// The contract between a renderer and the warp server: layers of colour, depth and object ids, each with the camera
/// it was drawn with. The warp server knows nothing else of a scene.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/camera.h"
#include "core/clock.h"
#include "core/image.h"
#include "core/object_transform.h"
#include "core/stereo_rig.h"
#include "gl/fence.h"
#include "gl/texture.h"

namespace lw {

/// Depth of a pixel that shows nothing, not even the sky: layers that hold a part of the scene have such pixels. It is
/// no depth, so every warp method passes over it.
inline constexpr float kNoSurfaceDepth = -1.0F;

/// Pixels in CPU memory, of the layer's size where nothing else is said. How frames travel on a software GL, and from
/// renderers without GL.
struct CpuPixels {
    ColourImage colour;       ///< sRGB
    DepthImage depth;         ///< reversed infinite depth, near_m / distance_m; 0 = background
    ObjectIdImage object_id;  ///< 0 = static world and sky
    /// True: the colour's alpha is the share of the pixel that its surface covers, 255 = all of it; what is next to it
    /// has the rest. So a warp knows where in a pixel an edge runs. False: alpha says nothing.
    bool alpha_is_share = false;
    /// Empty, or twice the layer's size in each direction: the four quarters of every pixel, each in the mean colour of
    /// all that is seen there (sRGB). Where `alpha_is_share`, alpha is the share of the quarter that the pixel's own
    /// surface covers. A warp that reads between two pixels finds there what their means no longer tell, and at edges
    /// which part of a pixel is whose and how the rest of it looks.
    ColourImage quarters{};
    /// Samples that each quarter is the mean of, at least 1. One alone is noisy.
    int quarter_samples = 1;
};

/// Pixels in textures of a context that shares with the server's: SRGB8_ALPHA8, R32F and R16UI, row 0 on top.
/// Readable once `rendered` has signalled; the server polls it and never waits for it.
struct TexturePixels {
    gl::Texture colour;
    gl::Texture depth;
    gl::Texture object_id;
    gl::Fence rendered;
};

using FramePixels = std::variant<CpuPixels, TexturePixels>;

/// What a warp method worked out about a layer once, before it was published. Methods derive their own from it.
struct PreparedLayer {
    PreparedLayer() = default;
    PreparedLayer(const PreparedLayer&) = delete;
    PreparedLayer& operator=(const PreparedLayer&) = delete;
    virtual ~PreparedLayer() = default;
};

/// What a server may rely on to leave a layer out where it shows nothing. The defaults promise nothing.
struct LayerContent {
    std::uint32_t item = 0;      ///< the client's number of it, for HoleFeedback
    std::uint16_t shell = 0;     ///< distance range it belongs to, 0 the nearest; for false colours
    bool static_only = false;    ///< no pixel belongs to a mover
    float nearest_depth = 1.0F;  ///< no pixel's depth is larger
    double nearest_ray_m = 0.0;  ///< no pixel's surface is nearer along its ray
};

/// One image with everything needed to warp it. Immutable once published.
struct Layer {
    std::string name = "main";
    std::optional<Eye> for_eye;  ///< the one eye that looks at it; nothing: whoever looks
    Camera camera;               ///< the source camera; its size is the size of the pixels
    TimePoint pose_sampled;      ///< stamp of the newest head sample that `camera` was predicted from
    double scene_time_s = 0.0;   ///< time the movers were drawn at
    FramePixels pixels;
    std::uint64_t empty_pixels = 0;  ///< how many have kNoSurfaceDepth
    LayerContent content;
    std::vector<ObjectTransform> movers;  ///< every mover's placement as drawn, by ascending id

    /// Programmer errors when the pixels live elsewhere.
    [[nodiscard]] const CpuPixels& cpu() const { return std::get<CpuPixels>(pixels); }
    [[nodiscard]] CpuPixels& cpu() { return std::get<CpuPixels>(pixels); }

    /// What `method` (its label, with settings) prepared, or null.
    [[nodiscard]] const PreparedLayer* prepared_for(std::string_view method) const {
        for (const auto& [label, prepared_layer] : prepared) {
            if (label == method) return prepared_layer.get();
        }
        return nullptr;
    }
    std::vector<std::pair<std::string, std::shared_ptr<const PreparedLayer>>> prepared;
};

/// The stages of a rendered frame's life that the client stamps (docs/conventions.md, "The life of a frame").
struct RenderTimes {
    TimePoint pose_sampled;
    TimePoint render_begin;
    TimePoint render_end;
    TimePoint published;
};

/// What the client publishes. A layer that was not drawn again is carried over by its pointer, without a copy.
struct RenderedFrame {
    std::uint64_t index = 0;  ///< counts published frames from 1
    std::vector<std::shared_ptr<const Layer>> layers;
    RenderTimes times;
};

}  // namespace lw
