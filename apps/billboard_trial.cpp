#include "apps/billboard_trial.h"

#include <cmath>

namespace lw {

namespace {

constexpr int kCellPx = 4;

double cell_luma(const ColourImage& image, int cell_x, int cell_y) {
    double sum = 0.0;
    for (int y = 0; y < kCellPx; ++y) {
        for (int x = 0; x < kCellPx; ++x) {
            const Rgba8 colour = image.at(cell_x * kCellPx + x, cell_y * kCellPx + y);
            sum += 0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b;
        }
    }
    return sum / (255.0 * kCellPx * kCellPx);
}

}  // namespace

Result<BillboardTrial> BillboardTrial::create(std::string label, const scene::Scene& scene,
                                              const BillboardSettings& settings, const Clock& clock) {
    SceneRendererSettings renderer_settings;
    renderer_settings.billboards = settings;
    renderer_settings.stage_clock = &clock;
    auto renderer = SceneRenderer::create(scene, renderer_settings);
    if (!renderer) return renderer.error();
    (*renderer)->use_billboards(true);
    return BillboardTrial{std::move(label), clock, std::move(*renderer)};
}

const ColourImage& BillboardTrial::draw(const Camera& camera, double time_s, int samples_per_axis) {
    TrialFrame frame;
    frame.time_s = time_s;
    const TimePoint begin = clock_->now();
    renderer_->draw_resolved(camera, time_s, samples_per_axis, pixels_);
    frame.frame_ms = to_ms(clock_->now() - begin);
    const DrawCounters& drawn = renderer_->counters();
    frame.meshes_ms = drawn.meshes_ms;
    frame.draw_ms = drawn.billboards_ms;
    frame.light_ms = drawn.light_ms;
    frame.triangles_drawn = drawn.triangles_drawn;
    if (renderer_->billboards() != nullptr) {
        frame.counters = renderer_->billboards()->counters();
        frame.choose_ms = frame.counters.choose_ms;
        frame.create_ms = frame.counters.create_ms;
        frame.update_ms = frame.counters.update_ms;
    }
    frames_.push_back(frame);
    return pixels_.colour;
}

std::array<std::size_t, kBillboardDimensions.size()> BillboardTrial::bytes() const {
    return renderer_->billboards() == nullptr ? std::array<std::size_t, kBillboardDimensions.size()>{}
                                              : renderer_->billboards()->bytes();
}

std::uint64_t BillboardTrial::redraws() const {
    std::uint64_t sum = 0;
    for (const TrialFrame& frame : frames_) sum += frame.counters.created + frame.counters.updated;
    return sum;
}

double flicker_energy(const ColourImage& before, const ColourImage& after, const ColourImage& true_before,
                      const ColourImage& true_after) {
    double sum = 0.0;
    const glm::ivec2 cells = before.size_px() / kCellPx;
    for (int y = 0; y < cells.y; ++y) {
        for (int x = 0; x < cells.x; ++x) {
            const double change = cell_luma(after, x, y) - cell_luma(before, x, y);
            const double true_change = cell_luma(true_after, x, y) - cell_luma(true_before, x, y);
            const double excess = std::max(std::abs(change) - std::abs(true_change), 0.0);
            sum += excess * excess;
        }
    }
    return sum / std::max(cells.x * cells.y, 1);
}

}  // namespace lw
