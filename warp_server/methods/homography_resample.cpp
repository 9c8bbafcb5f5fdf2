#include "warp_server/methods/homography_resample.h"

#include <algorithm>

#include "core/reprojection.h"
#include "warp_server/methods/bilinear.h"
#include "warp_server/methods/object_matrices.h"

namespace lw {
namespace {

// Float homography source <- target with the depth factor: rows x, y, w of columns x, y, 1.
struct SourceFromTarget {
    glm::mat3 matrix{1.0F};
    float depth_scale = 1.0F;  // target depth = source depth * depth_scale * w of the homography
};

SourceFromTarget source_from_target(const Camera& source, const Camera& target) {
    Camera turned = target;  // same place as the source
    turned.world_from_eye.position_m = source.world_from_eye.position_m;
    const Transform<TargetPx, SourcePx> forward = static_target_px_from_source_px(source, turned);
    if (pixel_matrix_of(forward, source.size_px).identity) return {};
    const glm::dmat4& m = forward.matrix;
    const glm::dmat3 target_from_source{m[0].x, m[0].y, m[0].w, m[1].x, m[1].y, m[1].w, m[2].x, m[2].y, m[2].w};
    return {glm::mat3{glm::inverse(target_from_source)}, static_cast<float>(m[3].z)};
}

bool meets_nothing(const DepthImage& depth, const BilinearTap& tap) {
    return depth.at(tap.x0, tap.y0) == kNoSurfaceDepth || depth.at(tap.x1, tap.y0) == kNoSurfaceDepth ||
           depth.at(tap.x0, tap.y1) == kNoSurfaceDepth || depth.at(tap.x1, tap.y1) == kNoSurfaceDepth;
}

}  // namespace

glm::mat3 background_source_from_target(const Camera& source, const Camera& target) {
    return source_from_target(source, target).matrix;
}

void resample_by_rotation(const Layer& layer, const Camera& target, DisplayFrame& out, WarpCounters& counters) {
    const CpuPixels& pixels = checked_cpu_pixels(layer);
    const glm::ivec2 source_size_px = layer.camera.size_px;
    const auto source_width = static_cast<float>(source_size_px.x);
    const auto source_height = static_cast<float>(source_size_px.y);
    const SourceFromTarget transform = source_from_target(layer.camera, target);
    const glm::mat3& h = transform.matrix;

    out.resize(target.size_px);
    for (int y = 0; y < target.size_px.y; ++y) {
        const glm::vec3 row_start = h[2] + (static_cast<float>(y) + 0.5F) * h[1];
        for (int x = 0; x < target.size_px.x; ++x) {
            const glm::vec3 place = row_start + (static_cast<float>(x) + 0.5F) * h[0];
            const float x_px = place.x / place.z;
            const float y_px = place.y / place.z;
            const bool inside =
                place.z > 0.0F && x_px >= 0.0F && x_px < source_width && y_px >= 0.0F && y_px < source_height;
            if (!inside) {
                out.coverage.at(x, y) = Coverage::hole;
                continue;
            }
            const glm::ivec2 nearest{static_cast<int>(x_px), static_cast<int>(y_px)};
            float depth = pixels.depth.at(nearest.x, nearest.y);
            if (depth == kNoSurfaceDepth) {
                ++counters.bad_depth;
                out.coverage.at(x, y) = Coverage::hole;
                continue;
            }
            if (!is_usable_depth(depth)) {
                ++counters.bad_depth;
                depth = 0.0F;
            }
            const BilinearTap tap = bilinear_tap(x_px, y_px, source_size_px);
            const bool beside_nothing = layer.empty_pixels > 0 && meets_nothing(pixels.depth, tap);
            out.colour.at(x, y) =
                beside_nothing ? pixels.colour.at(nearest.x, nearest.y) : sample_bilinear(pixels.colour, tap);
            out.depth.at(x, y) = std::min(depth * transform.depth_scale * place.z, 1.0F);
            out.coverage.at(x, y) = Coverage::reached;
        }
    }
}

}  // namespace lw
