#include "apps/app_load.h"

#include <chrono>
#include <thread>

namespace lw {
namespace {

class LoadedRenderer final : public SceneRenderer {
public:
    LoadedRenderer(std::unique_ptr<SceneRenderer> renderer, const AppLoad& load)
        : renderer_{std::move(renderer)}, load_{load} {}

    void draw(const Camera& camera, double scene_time_s, CpuPixels& pixels) override {
        renderer_->draw(camera, scene_time_s, pixels);
    }
    void draw_resolved(const Camera& camera, double scene_time_s, int samples_per_axis, CpuPixels& pixels) override {
        add_load(camera, scene_time_s);
        renderer_->draw_resolved(camera, scene_time_s, samples_per_axis, pixels);
    }
    std::uint64_t draw_part(const Camera& camera, double scene_time_s, int samples_per_axis, const ScenePart& part,
                            CpuPixels& pixels) override {
        return renderer_->draw_part(camera, scene_time_s, samples_per_axis, part, pixels);
    }
    [[nodiscard]] TexturePixels draw_to_textures(const Camera& camera, double scene_time_s,
                                                 int samples_per_axis) override {
        add_load(camera, scene_time_s);
        return renderer_->draw_to_textures(camera, scene_time_s, samples_per_axis);
    }
    void draw_supersampled(const Camera& camera, double scene_time_s, int samples_per_axis,
                           ColourImage& colour) override {
        renderer_->draw_supersampled(camera, scene_time_s, samples_per_axis, colour);
    }
    void mover_placements(double scene_time_s, std::vector<ObjectTransform>& transforms) override {
        renderer_->mover_placements(scene_time_s, transforms);
    }
    void set_reveal_margin(double margin_m) override { renderer_->set_reveal_margin(margin_m); }
    void set_viewer_moves(bool moves) override { renderer_->set_viewer_moves(moves); }
    void use_billboards(bool use) override { renderer_->use_billboards(use); }
    [[nodiscard]] const BillboardField* billboards() const override { return renderer_->billboards(); }
    [[nodiscard]] const DrawCounters& counters() const override { return renderer_->counters(); }

private:
    void add_load(const Camera& camera, double scene_time_s) {
        double drawn = 0.0;
        while (drawn < load_.triangles) {
            renderer_->draw(camera, scene_time_s, spare_);
            const auto triangles = static_cast<double>(renderer_->counters().triangles_drawn);
            // A view without a triangle would never get there.
            if (triangles <= 0.0) break;
            drawn += triangles;
        }
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>{load_.stall_ms});
    }

    std::unique_ptr<SceneRenderer> renderer_;
    AppLoad load_;
    CpuPixels spare_;
};

}  // namespace

std::unique_ptr<SceneRenderer> with_load(std::unique_ptr<SceneRenderer> renderer, const AppLoad& load) {
    if (load.triangles <= 0.0 && load.stall_ms <= 0.0) return renderer;
    return std::make_unique<LoadedRenderer>(std::move(renderer), load);
}

}  // namespace lw
