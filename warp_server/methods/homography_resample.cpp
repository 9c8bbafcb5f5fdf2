#include "warp_server/methods/homography_resample.h"

#include "core/reprojection.h"
#include "warp_server/methods/homography_kernels.h"
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

struct PreparedPicture final : PreparedLayer {
    LinearImage linear;
};

}  // namespace

glm::mat3 background_source_from_target(const Camera& source, const Camera& target) {
    return source_from_target(source, target).matrix;
}

std::shared_ptr<const PreparedLayer> prepare_picture(const Layer& layer) {
    auto prepared = std::make_shared<PreparedPicture>();
    prepared->linear = LinearImage{checked_cpu_pixels(layer).colour};
    return prepared;
}

void resample_by_rotation(const Layer& layer, std::string_view label, const Camera& target, DisplayFrame& out,
                          WarpCounters& counters) {
    std::shared_ptr<const PreparedLayer> own;
    const PreparedLayer* prepared = layer.prepared_for(label);
    if (prepared == nullptr) {
        own = prepare_picture(layer);
        prepared = own.get();
    }
    const LinearImage& linear = static_cast<const PreparedPicture&>(*prepared).linear;
    const SourceFromTarget transform = source_from_target(layer.camera, target);
    const HomographyInput input{&checked_cpu_pixels(layer), &linear, transform.matrix, transform.depth_scale,
                                layer.empty_pixels > 0};
    out.resize(target.size_px);
    counters.bad_depth += resample_rows(input, {0, target.size_px.y}, out);
}

}  // namespace lw
