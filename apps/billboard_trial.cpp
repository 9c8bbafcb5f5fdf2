#include "apps/billboard_trial.h"

#include <cmath>
#include <ctime>

#include "core/check.h"

namespace lw {

namespace {

constexpr int kCellPx = 4;

double cell_luma(const ColourImage& image, int cell_px, int cell_x, int cell_y) {
    double sum = 0.0;
    for (int y = 0; y < cell_px; ++y) {
        for (int x = 0; x < cell_px; ++x) {
            const Rgba8 colour = image.at(cell_x * cell_px + x, cell_y * cell_px + y);
            sum += 0.299 * colour.r + 0.587 * colour.g + 0.114 * colour.b;
        }
    }
    return sum / (255.0 * cell_px * cell_px);
}

}  // namespace

TimePoint ProcessorClock::now() const {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return TimePoint{std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec}};
}

void ProcessorClock::sleep_until(TimePoint) { LW_CHECK(false, "processor time does not pass while one waits"); }

Result<BillboardTrial> BillboardTrial::create(std::string label, const scene::Scene& scene,
                                              const BillboardSettings& settings, const TrialClocks& clocks) {
    SceneRendererSettings renderer_settings;
    renderer_settings.billboards = settings;
    renderer_settings.stage_clock = clocks.processor;
    auto renderer = SceneRenderer::create(scene, renderer_settings);
    if (!renderer) return renderer.error();
    (*renderer)->use_billboards(true);
    return BillboardTrial{std::move(label), clocks, std::move(*renderer)};
}

const ColourImage& BillboardTrial::draw(const Camera& camera, double time_s, int samples_per_axis) {
    TrialFrame frame;
    frame.time_s = time_s;
    const TimePoint wall_begin = clocks_.wall->now();
    const TimePoint begin = clocks_.processor->now();
    renderer_->draw_resolved(camera, time_s, samples_per_axis, pixels_);
    frame.frame_ms = to_ms(clocks_.processor->now() - begin);
    frame.wall_ms = to_ms(clocks_.wall->now() - wall_begin);
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

const ColourImage& BillboardTrial::draw_without_updates(const Camera& camera, int samples_per_axis) {
    renderer_->draw_without_updates(camera, 0.0, samples_per_axis, without_updates_);
    return without_updates_.colour;
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

double change_energy(const ColourImage& before, const ColourImage& after, int cell_px) {
    double sum = 0.0;
    const glm::ivec2 cells = before.size_px() / cell_px;
    for (int y = 0; y < cells.y; ++y) {
        for (int x = 0; x < cells.x; ++x) {
            const double change = cell_luma(after, cell_px, x, y) - cell_luma(before, cell_px, x, y);
            sum += change * change;
        }
    }
    return sum / std::max(cells.x * cells.y, 1);
}

double flicker_energy(const ColourImage& before, const ColourImage& after, const ColourImage& true_before,
                      const ColourImage& true_after) {
    double sum = 0.0;
    const glm::ivec2 cells = before.size_px() / kCellPx;
    for (int y = 0; y < cells.y; ++y) {
        for (int x = 0; x < cells.x; ++x) {
            const double change = cell_luma(after, kCellPx, x, y) - cell_luma(before, kCellPx, x, y);
            const double true_change = cell_luma(true_after, kCellPx, x, y) - cell_luma(true_before, kCellPx, x, y);
            const double excess = std::max(std::abs(change) - std::abs(true_change), 0.0);
            sum += excess * excess;
        }
    }
    return sum / std::max(cells.x * cells.y, 1);
}

}  // namespace lw
