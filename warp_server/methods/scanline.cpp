#include "warp_server/methods/scanline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/check.h"
#include "core/stereo_rig.h"

namespace lw {
namespace {

bool is_depth(float depth) { return depth >= 0.0F && depth <= 1.0F; }

// Rows of both pictures that see the same, and where along them a pixel lands.
struct RowShift {
    double px_per_px = 1.0;    // target pixels per source pixel
    double offset_px = 0.0;    // of the target's picture against the source's, both on the screen plane
    double baseline_px = 0.0;  // b / pixel width
    double screen_m = 1.0;     // z0: any plane gives the same pixels
    double near_m = 0.05;

    [[nodiscard]] double target_x(int source_x, float depth) const {
        // The share z / (z + z0), with z + z0 = near / depth the distance from the eyes; 1 for background.
        const double behind = 1.0 - screen_m * static_cast<double>(depth) / near_m;
        return px_per_px * (source_x + 0.5) + offset_px + baseline_px * behind;
    }
};

RowShift row_shift(const Camera& source, const Camera& target) {
    const glm::dvec3 offset_m = glm::conjugate(source.world_from_eye.orientation) *
                                (target.world_from_eye.position_m - source.world_from_eye.position_m);
    RowShift shift;
    shift.near_m = source.near_m;
    const double source_tan_per_px = (source.fov.right - source.fov.left) / source.size_px.x;
    const double target_tan_per_px = (target.fov.right - target.fov.left) / target.size_px.x;
    const double pixel_width_m = target_tan_per_px * shift.screen_m;
    shift.px_per_px = source_tan_per_px / target_tan_per_px;
    shift.baseline_px = offset_m.x / pixel_width_m;
    // Each picture's left edge on the screen plane, seen from its own eye: the target's has gone along with its eye.
    shift.offset_px = (source.fov.left - target.fov.left) / target_tan_per_px - shift.baseline_px;
    return shift;
}

class RowShifter {
public:
    RowShifter(const CpuPixels& pixels, const RowShift& shift, bool to_the_left, float depth_ratio, DisplayFrame& out,
               WarpCounters& counters)
        : pixels_{pixels},
          shift_{shift},
          to_the_left_{to_the_left},
          depth_ratio_{depth_ratio},
          out_{out},
          counters_{counters} {}

    // An eye on the left sees near things farther to the right than far ones: whoever comes later from the right was
    // shifted less far to the left, and is nearer. For an eye on the right the other way round.
    void shift(int source_y, int target_y) {
        const int width = pixels_.colour.width();
        for (int i = 0; i < width; ++i) place(to_the_left_ ? width - 1 - i : i, source_y, target_y);
    }

private:
    void place(int source_x, int source_y, int target_y) {
        const float depth = pixels_.depth.at(source_x, source_y);
        if (!is_depth(depth)) {
            ++counters_.bad_depth;
            return;
        }
        const double x = std::floor(shift_.target_x(source_x, depth));
        const float target_depth = depth * depth_ratio_;
        if (!(x >= 0.0 && x < out_.colour.width()) || target_depth > 1.0F) return;
        const int target_x = static_cast<int>(x);
        out_.colour.at(target_x, target_y) = opaque(pixels_.colour.at(source_x, source_y));
        out_.depth.at(target_x, target_y) = target_depth;
        out_.coverage.at(target_x, target_y) = Coverage::reached;
    }

    const CpuPixels& pixels_;
    const RowShift& shift_;
    bool to_the_left_;
    float depth_ratio_;
    DisplayFrame& out_;
    WarpCounters& counters_;
};

class ScanlineMethod final : public WarpMethod {
public:
    ScanlineMethod(const Pose& source_from_target, const FovTangents& target_fov)
        : source_from_target_{source_from_target}, target_fov_{target_fov} {}

    [[nodiscard]] std::string_view label() const override { return "scanline"; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        Camera beside = target.camera;
        beside.fov = target_fov_;
        beside.world_from_eye = compose(layer.camera.world_from_eye, source_from_target_);
        shift_rows(layer.cpu(), layer.camera, beside, out, counters_);
    }

private:
    Pose source_from_target_;
    FovTangents target_fov_;
};

}  // namespace

void shift_rows(const CpuPixels& pixels, const Camera& source, const Camera& target, DisplayFrame& out,
                WarpCounters& counters) {
    out.resize(target.size_px);
    std::ranges::fill(out.coverage.pixels(), Coverage::hole);
    const RowShift shift = row_shift(source, target);
    RowShifter shifter{pixels, shift,   shift.baseline_px <= 0.0, static_cast<float>(target.near_m / source.near_m),
                       out,    counters};
    const double source_px_per_tan = source.size_px.y / (source.fov.up - source.fov.down);
    const double target_tan_per_px = (target.fov.up - target.fov.down) / target.size_px.y;
    for (int y = 0; y < target.size_px.y; ++y) {
        const double tangent = target.fov.up - (y + 0.5) * target_tan_per_px;
        const double source_y = std::floor((source.fov.up - tangent) * source_px_per_tan);
        if (source_y >= 0.0 && source_y < source.size_px.y) shifter.shift(static_cast<int>(source_y), y);
    }
}

Result<std::unique_ptr<WarpMethod>> make_scanline_method(const Camera& source, const Camera& target) {
    if (const std::string_view why = why_not_rectified(source, target); !why.empty()) {
        return Error{"pixels cannot be shifted along their rows", std::string{why}, "choose --stereo one-render"};
    }
    const Pose source_from_target = compose(inverse(source.world_from_eye), target.world_from_eye);
    return std::unique_ptr<WarpMethod>{std::make_unique<ScanlineMethod>(source_from_target, target.fov)};
}

}  // namespace lw
