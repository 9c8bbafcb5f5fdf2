#pragma once
/// Which part of a display frame a layer can show something in.

#include <cstddef>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "warp_server/pixel_rect.h"
#include "warp_server/warp_method.h"

namespace lw {

/// The pixels of `target` that the layer's picture may reach: its frustum from its nearest depth to infinity, moved.
/// The whole target for a layer that may hold movers. Pure, any thread.
[[nodiscard]] PixelRect reach_of(const Layer& layer, const Camera& target);

/// No surface of a layer is nearer to the target than the depth returned; 1 where nothing is promised
/// (LayerContent::nearest_ray_m). Pure, any thread.
[[nodiscard]] float nearest_target_depth(const Layer& layer, const Camera& target);

/// What the pictures of the view, one or its sides, show of a target: directions are compared as if the eyes stood in
/// one place. Keeps its memory. One thread at a time.
class ViewCover {
public:
    void clear() { pictures_.clear(); }
    void add(const Camera& picture, const Camera& target);

    /// The columns of row y that are covered, of `width`: [first, second). Of pictures that leave a gap in the row the
    /// widest.
    [[nodiscard]] std::pair<int, int> columns(int y, int width) const;

    [[nodiscard]] bool covers(int x, int y) const;

private:
    struct Picture {
        glm::mat3 source_from_target{1.0F};  ///< background_source_from_target()
        glm::vec2 size_px{0.0F};

        [[nodiscard]] std::pair<int, int> columns(int y, int width) const;
    };
    std::vector<Picture> pictures_;
};

/// What a display frame lacks in a part of it.
struct MissingPixels {
    PixelRect rect;  ///< the smallest that holds them all
    std::size_t count = 0;
};

/// The pixels of `frame` in `rect` that show nothing, or something farther than `nearest_depth` where the view does not
/// cover them. Pure, any thread.
[[nodiscard]] MissingPixels missing_in(const DisplayFrame& frame, const PixelRect& rect, float nearest_depth,
                                       const ViewCover& view = {});

/// The part of a camera's picture in `rect`, which is not empty. Pure, any thread.
[[nodiscard]] Camera part_of(const Camera& camera, const PixelRect& rect);

}  // namespace lw
