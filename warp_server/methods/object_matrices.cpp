#include "warp_server/methods/object_matrices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/check.h"
#include "core/task_pool.h"

namespace lw {
namespace {

// Below what float can hold of a pixel coordinate (1024 px: 6e-5) and above what composing in double leaves (1e-12).
constexpr double kStillPx = 1e-6;

constexpr std::size_t kIdsPerTask = 64;  // some microseconds

bool is_identity(const glm::dmat4& m, glm::ivec2 source_size_px) {
    const glm::dvec4 reach{source_size_px.x, source_size_px.y, 1.0, 1.0};  // largest x_px, y_px, 1, depth
    const glm::dmat4 identity = [] {  // (x, y, 1, z) to w * (x, y, z, 1): columns 2 and 3 swap rows 2 and 3
        glm::dmat4 swapped{1.0};
        swapped[2] = glm::dvec4{0.0, 0.0, 0.0, 1.0};
        swapped[3] = glm::dvec4{0.0, 0.0, 1.0, 0.0};
        return swapped;
    }();
    const double largest_px = std::max({reach.x, reach.y, 1.0});
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            const double moved = std::abs(m[column][row] - identity[column][row]) * reach[column];
            // An error of w moves a pixel by its distance from the origin.
            const double moved_px = row == 3 ? moved * largest_px : moved;
            if (!(moved_px < kStillPx)) return false;
        }
    }
    return true;
}

// How far pixels beyond sight and a metre away move from where a still picture shows them.
class Motion {
public:
    Motion(const Camera& source, Camera target) {
        target.world_from_eye = source.world_from_eye;
        const Transform<TargetPx, SourcePx> still = static_target_px_from_source_px(source, target);
        std::size_t i = 0;
        for (const double part : {0.0, 0.5, 1.0}) {
            for (const double depth : {0.0, source.near_m}) {
                probes_[i].place = {part * glm::dvec2{source.size_px}, 1.0, depth};
                const glm::dvec4 shown = still.matrix * probes_[i].place;
                probes_[i++].still_px = glm::dvec2{shown} / shown.w;
            }
        }
    }

    [[nodiscard]] float of(const Transform<TargetPx, SourcePx>& target_px_from_source_px) const {
        double largest_px = 0.0;
        for (const Probe& probe : probes_) {
            const glm::dvec4 shown = target_px_from_source_px.matrix * probe.place;
            const double moved_px = glm::distance(glm::dvec2{shown} / shown.w, probe.still_px);
            if (!(shown.w > 0.0) || !(moved_px < kFarPx)) return kFarPx;
            largest_px = std::max(largest_px, moved_px);
        }
        return static_cast<float>(largest_px);
    }

private:
    static constexpr float kFarPx = 1e6F;

    struct Probe {
        glm::dvec4 place{0.0};  // in the source
        glm::dvec2 still_px{0.0};
    };
    std::array<Probe, 6> probes_;
};

PixelMatrix::Column rounded(const glm::dvec4& column) {
    return {static_cast<float>(column.x), static_cast<float>(column.y), static_cast<float>(column.w)};
}

}  // namespace

PixelMatrix pixel_matrix_of(const Transform<TargetPx, SourcePx>& target_px_from_source_px, glm::ivec2 source_size_px) {
    const glm::dmat4& m = target_px_from_source_px.matrix;
    if (is_identity(m, source_size_px)) {
        return {{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}, 1.0F, 0.0F, true, true};
    }
    return {rounded(m[0]), rounded(m[1]), rounded(m[2]), rounded(m[3]), static_cast<float>(m[3].z), 0.0F, true, false};
}

void ObjectMatrices::build(const Layer& layer, const WarpTarget& target, float depth_share, TaskPool* threads) {
    if (layer.content.static_only) {
        table_.build(layer.camera, target.camera, {}, {});
    } else {
        table_.build(layer.camera, target.camera, layer.movers, target.movers, threads);
    }
    matrices_.resize(table_.size());
    const auto* pixels = std::get_if<CpuPixels>(&layer.pixels);
    std::optional<Motion> motion;
    if (pixels != nullptr && pixels->alpha_is_share) motion.emplace(layer.camera, target.camera);
    for_ranges(threads, matrices_.size(), kIdsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t id = begin; id < end; ++id) {
            matrices_[id].valid = false;
            const Transform<TargetPx, SourcePx>* exact = table_.find(static_cast<ObjectId>(id));
            if (exact == nullptr) continue;
            matrices_[id] = pixel_matrix_of(*exact, layer.camera.size_px);
            matrices_[id].depth_scale *= depth_share;
            if (motion) matrices_[id].moved_px = motion->of(*exact);
        }
    });
    const auto stays = [](const PixelMatrix& matrix) { return !matrix.valid || matrix.identity; };
    all_identity_ = layer.camera.size_px == target.camera.size_px && std::ranges::all_of(matrices_, stays);
}

const CpuPixels& checked_cpu_pixels(const Layer& layer) {
    const auto* pixels = std::get_if<CpuPixels>(&layer.pixels);
    LW_CHECK(pixels != nullptr, "a CPU warp method needs a layer with CPU pixels: " + layer.name);
    const glm::ivec2 size_px = layer.camera.size_px;
    LW_CHECK(size_px.x > 0 && size_px.y > 0, "layer without pixels: " + layer.name);
    const bool sizes_agree = pixels->colour.size_px() == size_px && pixels->depth.size_px() == size_px &&
                             pixels->object_id.size_px() == size_px;
    LW_CHECK(sizes_agree, "images and camera of a layer differ in size: " + layer.name);
    return *pixels;
}

}  // namespace lw
