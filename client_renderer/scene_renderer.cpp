#include "client_renderer/scene_renderer.h"

#include <algorithm>
#include <optional>
#include <thread>
#include <utility>

#include "client_renderer/billboard_painter.h"
#include "client_renderer/culling.h"
#include "client_renderer/draw_list.h"
#include "client_renderer/frame_block.h"
#include "client_renderer/gbuffer_pass.h"
#include "client_renderer/gpu_scene.h"
#include "client_renderer/image_passes.h"
#include "client_renderer/light_tiles.h"
#include "client_renderer/lighting_pass.h"
#include "client_renderer/render_targets.h"
#include "client_renderer/surface_resolve.h"
#include "core/task_pool.h"

namespace lw {

namespace {

// Supersampled pictures are drawn in tiles of at most this many samples a side: 2048 squared samples take 110 MB.
constexpr int kMaxTileSamples = 2048;

/// The part of a camera's picture from pixel `first_px` on.
Camera cropped(const Camera& camera, glm::ivec2 first_px, glm::ivec2 size_px) {
    const FovTangents& fov = camera.fov;
    const double tan_per_px_x = (fov.right - fov.left) / camera.size_px.x;
    const double tan_per_px_y = (fov.up - fov.down) / camera.size_px.y;
    Camera part = camera;
    part.size_px = size_px;
    part.fov = {fov.left + tan_per_px_x * first_px.x, fov.left + tan_per_px_x * (first_px.x + size_px.x),
                fov.up - tan_per_px_y * (first_px.y + size_px.y), fov.up - tan_per_px_y * first_px.y};
    return part;
}

/// For programs to be compiled: every part of the sky somewhere.
std::array<SkyRect, kSkyPartCount> one_of_each_part(glm::ivec2 size_px) {
    std::array<SkyRect, kSkyPartCount> rects;
    for (std::size_t part = 0; part < rects.size(); ++part) {
        rects[part] = {{0, 0}, size_px, static_cast<SkyPart>(part)};
    }
    return rects;
}

void check_samples(int samples_per_axis) {
    LW_CHECK(samples_per_axis == 1 || samples_per_axis == 2 || samples_per_axis == 4,
             fmt::format("{} samples per axis", samples_per_axis));
}

/// Calls draw_tile(part, first_px) for tiles that cover the camera's picture: `part` is the tile's camera with all its
/// samples as pixels. All tiles have one size, so the last ones may reach beyond the picture.
template <class DrawTile>
void for_each_tile(const Camera& camera, int samples_per_axis, glm::ivec2 tile_px, DrawTile draw_tile) {
    for (int y = 0; y < camera.size_px.y; y += tile_px.y) {
        for (int x = 0; x < camera.size_px.x; x += tile_px.x) {
            Camera part = cropped(camera, {x, y}, tile_px);
            part.size_px *= samples_per_axis;
            draw_tile(part, glm::ivec2{x, y});
        }
    }
}

glm::ivec2 tile_size_px(glm::ivec2 size_px, int samples_per_axis) {
    const int max_tile_px = kMaxTileSamples / samples_per_axis;
    const glm::ivec2 tile_count = (size_px + max_tile_px - 1) / max_tile_px;
    return (size_px + tile_count - 1) / tile_count;
}

void download(const gl::Texture& colour, const gl::Texture& depth, GLenum depth_format, const gl::Texture& object_id,
              CpuPixels& pixels) {
    pixels.colour.resize(colour.size_px());
    pixels.depth.resize(colour.size_px());
    pixels.object_id.resize(colour.size_px());
    colour.download(GL_RGBA, GL_UNSIGNED_BYTE, pixels.colour.size_bytes(), pixels.colour.pixels().data());
    depth.download(depth_format, GL_FLOAT, pixels.depth.size_bytes(), pixels.depth.pixels().data());
    object_id.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, pixels.object_id.size_bytes(),
                       pixels.object_id.pixels().data());
    pixels.alpha_is_share = false;
    pixels.quarters.resize({0, 0});
}

void copy_into(const ColourImage& tile, glm::ivec2 first_px, ColourImage& colour) {
    const glm::ivec2 size_px = glm::min(tile.size_px(), colour.size_px() - first_px);
    for (int y = 0; y < size_px.y; ++y) {
        const std::span<const Rgba8> from = tile.row(y).first(static_cast<std::size_t>(size_px.x));
        std::ranges::copy(from, colour.row(first_px.y + y).begin() + first_px.x);
    }
}

// Objects are put in order and collected between two stages that threads share: 0.3 ms.
constexpr int kPatienceBetweenStages = 10000;

// More would be idle: what is culled takes a millisecond.
int threads_of(const CullingSettings& settings) {
    if (settings.threads > 0) return settings.threads;
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2);
}

class DeferredSceneRenderer final : public SceneRenderer {
public:
    DeferredSceneRenderer(const scene::Scene& scene, SceneRendererSettings settings,
                          std::unique_ptr<GpuScene> gpu_scene, LightingPass lighting, ImagePasses images,
                          SurfaceResolve resolve)
        : scene_{scene},
          settings_{settings},
          threads_{threads_of(settings.culling), kPatienceBetweenStages},
          state_{scene},
          gpu_scene_{std::move(gpu_scene)},
          gbuffer_{*gpu_scene_},
          lighting_{std::move(lighting)},
          images_{std::move(images)},
          resolve_{std::move(resolve)},
          frame_block_{gl::make_buffer(sizeof(shader::FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT)} {
        state_.set_time(0.0);
        placed_.emplace(scene_, state_);
        culling_.emplace(*placed_, settings_.culling, &threads_);
        draw_list_.emplace(*placed_, settings_.order);
    }

    /// Makes the billboards of the settings, if any.
    [[nodiscard]] Status add_billboards() {
        if (settings_.billboards.mode == BillboardMode::off) return Done{};
        const Status programs = gpu_scene_->add_billboard_programs(settings_.billboards.format);
        if (!programs.ok()) return programs.error();
        painter_.emplace(scene_, state_, *gpu_scene_);
        auto field = BillboardField::create(scene_, *painter_, settings_.billboards, settings_.stage_clock);
        if (!field.ok()) return field.error();
        field_ = std::move(*field);
        return Done{};
    }

    [[nodiscard]] Status warm_up() {
        Camera camera;
        camera.size_px = {kWarmUpPx, kWarmUpPx};
        auto targets = RenderTargets::create(camera.size_px);
        if (!targets.ok()) return targets.error();
        bind_frame(camera);
        gbuffer_.warm_up(**targets);
        lights_.build(scene_.point_lights, camera);
        const std::array<SkyRect, kSkyPartCount> sky = one_of_each_part(camera.size_px);
        lighting_.draw(**targets, lights_, sky);
        images_.average((*targets)->colour, 2, gl::Texture{camera.size_px / 2, GL_SRGB8_ALPHA8});
        images_.copy_depth((*targets)->depth, gl::Texture{camera.size_px, GL_R32F});
        glFinish();
        return Done{};
    }

    void draw(const Camera& camera, double scene_time_s, CpuPixels& pixels) override {
        begin_picture(camera, scene_time_s, 1);
        draw_begun(camera, scene_time_s, 1, pixels);
    }

    void draw_resolved(const Camera& camera, double scene_time_s, int samples_per_axis, CpuPixels& pixels) override {
        check_samples(samples_per_axis);
        begin_picture(camera, scene_time_s, samples_per_axis);
        draw_begun(camera, scene_time_s, samples_per_axis, pixels);
    }

    void draw_without_updates(const Camera& camera, double scene_time_s, int samples_per_axis,
                              CpuPixels& pixels) override {
        LW_CHECK(field_ != nullptr, "no billboards");
        check_samples(samples_per_axis);
        counters_ = {};
        replace_by_billboards_ = true;
        field_->withhold_updates(true);
        draw_begun(camera, scene_time_s, samples_per_axis, pixels);
        field_->withhold_updates(false);
    }

    std::uint64_t draw_part(const Camera& camera, double scene_time_s, int samples_per_axis, const ScenePart& part,
                            CpuPixels& pixels) override {
        begin_part(camera, samples_per_axis, part);
        tile_first_px_ = {0, 0};
        if (samples_per_axis == 1) {
            const RenderTargets& targets = render(camera, scene_time_s);
            download(targets.colour, targets.depth, GL_DEPTH_COMPONENT, targets.object_id, pixels);
        } else {
            resolve(camera, scene_time_s, samples_per_axis, resolved_of(camera.size_px));
            download(resolved_->colour, resolved_->depth, GL_RED, resolved_->object_id, pixels);
            // The rest of a hidden pixel is what hides it, which is not in the picture.
            pixels.alpha_is_share = part.behind == nullptr;
        }
        part_ = {};
        into_ = GpuScene::Into::gbuffer;
        return empty_what_is_not_in(part, pixels);
    }

    TexturePixels draw_to_textures(const Camera& camera, double scene_time_s, int samples_per_axis) override {
        check_samples(samples_per_axis);
        begin_picture(camera, scene_time_s, samples_per_axis);
        LayerTextures layer = make_layer(camera.size_px);
        if (samples_per_axis == 1) {
            const RenderTargets& targets = render(camera, scene_time_s);
            copy(targets.colour, layer.colour);
            copy(targets.object_id, layer.object_id);
            images_.copy_depth(targets.depth, layer.depth);
        } else {
            resolve(camera, scene_time_s, samples_per_axis, layer);
        }
        return {std::move(layer.colour), std::move(layer.depth), std::move(layer.object_id), gl::Fence::insert()};
    }

    void draw_supersampled(const Camera& camera, double scene_time_s, int samples_per_axis,
                           ColourImage& colour) override {
        check_samples(samples_per_axis);
        counters_ = {};
        replace_by_billboards_ = false;
        colour.resize(camera.size_px);
        if (samples_per_axis == 1) {
            const RenderTargets& targets = render(camera, scene_time_s);
            targets.colour.download(GL_RGBA, GL_UNSIGNED_BYTE, colour.size_bytes(), colour.pixels().data());
            return;
        }
        const glm::ivec2 tile_px = tile_size_px(camera.size_px, samples_per_axis);
        const gl::Texture averaged{tile_px, GL_SRGB8_ALPHA8};
        ColourImage tile{tile_px};
        for_each_tile(camera, samples_per_axis, tile_px, [&](const Camera& part, glm::ivec2 first_px) {
            images_.average(render(part, scene_time_s).colour, samples_per_axis, averaged);
            averaged.download(GL_RGBA, GL_UNSIGNED_BYTE, tile.size_bytes(), tile.pixels().data());
            copy_into(tile, first_px, colour);
        });
    }

    void set_reveal_margin(double margin_m) override { culling_->set_reveal_margin(margin_m); }

    void set_viewer_moves(bool moves) override { culling_->set_viewer_moves(moves); }

    void mover_placements(double scene_time_s, std::vector<ObjectTransform>& transforms) override {
        state_.set_time(scene_time_s);
        state_.mover_placements(transforms);
    }

    void use_billboards(bool use) override { use_billboards_ = use; }
    [[nodiscard]] const BillboardField* billboards() const override { return field_.get(); }

    [[nodiscard]] const DrawCounters& counters() const override { return counters_; }

private:
    static constexpr int kWarmUpPx = 64;

    void begin_part(const Camera& camera, int samples_per_axis, const ScenePart& part) {
        check_samples(samples_per_axis);
        const Status programs = gpu_scene_->add_part_programs();
        LW_CHECK(programs.ok(), programs.error().message());
        counters_ = {};
        replace_by_billboards_ = false;
        part_ = part;
        samples_per_axis_ = samples_per_axis;
        into_ = GpuScene::Into::part;
        if (part.behind == nullptr) return;
        LW_CHECK(part.behind->size_px() == camera.size_px, "limits of another size than the picture");
        if (!behind_ || behind_->size_px() != camera.size_px) behind_.emplace(camera.size_px, GL_R32F);
        behind_->upload(GL_RED, GL_FLOAT, part.behind->pixels().data());
    }

    const LayerTextures& resolved_of(glm::ivec2 size_px) {
        if (!resolved_ || resolved_->colour.size_px() != size_px) resolved_ = make_layer(size_px);
        return *resolved_;
    }

    // Null where they would be more than a texture holds.
    const QuarterTexture* quarters_of(glm::ivec2 size_px) {
        GLint most_px = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
        if (2 * std::max(size_px.x, size_px.y) > most_px) return nullptr;
        if (!quarters_ || quarters_->colour.size_px() != 2 * size_px) {
            auto made = QuarterTexture::create(size_px);
            LW_CHECK(made.ok(), made.error().message());
            quarters_ = std::move(*made);
        }
        return &*quarters_;
    }

    // Before the tiles of a picture are drawn: billboards are chosen and updated once for all of them.
    void begin_picture(const Camera& camera, double scene_time_s, int samples_per_axis) {
        counters_ = {};
        replace_by_billboards_ = use_billboards_ && field_ != nullptr;
        if (!replace_by_billboards_) return;
        state_.set_time(scene_time_s);
        Camera whole = camera;
        whole.size_px *= samples_per_axis;
        field_->prepare(whole, state_);
    }

    // After begin_picture().
    void draw_begun(const Camera& camera, double scene_time_s, int samples_per_axis, CpuPixels& pixels) {
        if (samples_per_axis == 1) {
            const RenderTargets& targets = render(camera, scene_time_s);
            download(targets.colour, targets.depth, GL_DEPTH_COMPONENT, targets.object_id, pixels);
            return;
        }
        const QuarterTexture* quarters = quarters_of(camera.size_px);
        resolve(camera, scene_time_s, samples_per_axis, resolved_of(camera.size_px), quarters);
        download(resolved_->colour, resolved_->depth, GL_RED, resolved_->object_id, pixels);
        pixels.alpha_is_share = true;
        if (quarters == nullptr) return;
        pixels.quarter_samples = std::max(samples_per_axis * samples_per_axis / 4, 1);
        pixels.quarters.resize(quarters->colour.size_px());
        quarters->colour.download(GL_RGBA, GL_UNSIGNED_BYTE, pixels.quarters.size_bytes(),
                                  pixels.quarters.pixels().data());
    }

    /// Runs `stage` and adds its time to `ms` where stages are timed.
    template <class Stage>
    void timed(double& ms, Stage stage) {
        if (settings_.stage_clock == nullptr) return stage();
        glFinish();
        const TimePoint begin = settings_.stage_clock->now();
        stage();
        glFinish();
        ms += to_ms(settings_.stage_clock->now() - begin);
    }

    static void copy(const gl::Texture& from, const gl::Texture& to) {
        glCopyImageSubData(from.id(), GL_TEXTURE_2D, 0, 0, 0, 0, to.id(), GL_TEXTURE_2D, 0, 0, 0, 0, to.size_px().x,
                           to.size_px().y, 1);
    }

    void bind_frame(const Camera& camera) {
        shader::FrameBlock block = frame_block(camera, scene_.sun);
        block.part = {static_cast<float>(part_.nearest_m), static_cast<float>(part_.farthest_m),
                      part_.behind != nullptr ? static_cast<float>(samples_per_axis_) : 0.0F, 0.0F};
        block.tiles.y = tile_first_px_.x;
        block.tiles.z = tile_first_px_.y;
        glNamedBufferSubData(frame_block_.id(), 0, sizeof block, &block);
        glBindBufferBase(GL_UNIFORM_BUFFER, shader::kBindingFrame, frame_block_.id());
    }

    static LayerTextures make_layer(glm::ivec2 size_px) {
        LW_CHECK(size_px.x >= 1 && size_px.y >= 1, fmt::format("{}x{} pixels", size_px.x, size_px.y));
        auto made = LayerTextures::create(size_px);
        LW_CHECK(made.ok(), made.error().message());
        return std::move(*made);
    }

    void resolve(const Camera& camera, double scene_time_s, int samples_per_axis, const LayerTextures& layer,
                 const QuarterTexture* quarters = nullptr) {
        const glm::ivec2 tile_px = tile_size_px(camera.size_px, samples_per_axis);
        for_each_tile(camera, samples_per_axis, tile_px, [&](const Camera& part, glm::ivec2 first_px) {
            tile_first_px_ = first_px;
            const RenderTargets& samples = render(part, scene_time_s);
            resolve_.draw(samples, samples_per_axis, first_px, layer);
            if (quarters != nullptr) resolve_.draw_quarters(samples, samples_per_axis, first_px, *quarters);
        });
    }

    // One sample per pixel into the targets of this size; they are drawn over by the next call.
    const RenderTargets& render(const Camera& camera, double scene_time_s) {
        const RenderTargets& targets = targets_of(camera.size_px);
        decide_what_is_drawn(camera, scene_time_s);
        bind_frame(camera);
        if (behind_) glBindTextureUnit(static_cast<GLuint>(shader::kUnitBehind), behind_->id());
        timed(counters_.meshes_ms, [&] { counters_.draw_calls += gbuffer_.draw(*draw_list_, targets, into_); });
        if (replace_by_billboards_) {
            timed(counters_.billboards_ms, [&] {
                targets.gbuffer.bind();
                field_->draw(camera);
            });
        }
        timed(counters_.light_ms, [&] {
            lights_.build(scene_.point_lights, camera);
            if (part_.sky) sky_.build(camera, scene_.sun);
            lighting_.draw(targets, lights_, part_.sky ? sky_.rects() : std::span<const SkyRect>{});
        });
        if (replace_by_billboards_ && field_->fades()) {
            timed(counters_.billboards_ms, [&] {
                targets.picture.bind();
                field_->draw_fading(camera);
            });
        }
        return targets;
    }

    void decide_what_is_drawn(const Camera& camera, double scene_time_s) {
        if (settings_.culling.skip) threads_.rouse();
        state_.set_time(scene_time_s);
        placed_->move(state_);
        const TimePoint begin = settings_.clock != nullptr ? settings_.clock->now() : TimePoint{};
        culling_->move();
        const std::span<const std::uint32_t> visible = in_part(drawn_as_meshes(culling_->visible(camera)), camera);
        ClusterUse clusters;
        if (settings_.culling.skip && settings_.culling.clusters) {
            clusters = {&gpu_scene_->clusters(), culling_->cluster_view(camera), &threads_};
        }
        draw_list_->build(visible, camera, gpu_scene_->parts(), clusters);
        if (settings_.clock != nullptr) counters_.culling += settings_.clock->now() - begin;
        count_what_was_skipped();
    }

    // Without the instances that billboards stand for.
    std::span<const std::uint32_t> drawn_as_meshes(std::span<const std::uint32_t> visible) {
        if (!replace_by_billboards_) return visible;
        const std::span<const std::uint8_t> replaced = field_->replaced();
        meshes_.clear();
        for (const std::uint32_t i : visible) {
            const auto instance = static_cast<std::size_t>((*placed_)[i].instance - scene_.instances.data());
            if (replaced[instance] == 0) meshes_.push_back(i);
        }
        return meshes_;
    }

    // Without the instances that have nothing in the part being drawn.
    std::span<const std::uint32_t> in_part(std::span<const std::uint32_t> visible, const Camera& camera) {
        if (into_ != GpuScene::Into::part) return visible;
        in_part_.clear();
        for (const std::uint32_t i : visible) {
            const PlacedInstance& placed = (*placed_)[i];
            const bool is_mover = placed.instance->mover != 0;
            if (in_range(part_, placed.bounds_world, is_mover, camera.world_from_eye.position_m)) in_part_.push_back(i);
        }
        return in_part_;
    }

    void count_what_was_skipped() {
        const CullingCounters& objects = culling_->counters();
        counters_.objects_tested += objects.tested;
        counters_.objects_outside += objects.outside;
        counters_.objects_behind_walls += objects.behind_walls;
        counters_.objects_occluded += objects.occluded;
        counters_.objects_too_small += objects.too_small;
        counters_.objects_between_samples += objects.between_samples;
        counters_.objects_drawn += draw_list_->objects_drawn();
        counters_.triangles_drawn += draw_list_->triangles_drawn();
        const ClusterCounters& clusters = draw_list_->cluster_counters();
        counters_.clusters_tested += clusters.tested;
        counters_.clusters_outside += clusters.outside;
        counters_.clusters_turned_away += clusters.turned_away;
        counters_.clusters_occluded += clusters.occluded;
        counters_.clusters_too_small += clusters.too_small;
        counters_.clusters_between_samples += clusters.between_samples;
    }

    // Keeps the last three sizes: a run alternates between at most a source, its truth's tiles and a fresh view.
    const RenderTargets& targets_of(glm::ivec2 size_px) {
        const auto found =
            std::ranges::find_if(targets_, [&](const auto& targets) { return targets->colour.size_px() == size_px; });
        if (found != targets_.end()) {
            std::rotate(targets_.begin(), found, found + 1);
            return *targets_.front();
        }
        LW_CHECK(size_px.x >= 1 && size_px.y >= 1, fmt::format("{}x{} pixels", size_px.x, size_px.y));
        if (targets_.size() == 3) targets_.pop_back();
        auto made = RenderTargets::create(size_px);
        LW_CHECK(made.ok(), made.error().message());
        targets_.insert(targets_.begin(), std::move(*made));
        return *targets_.front();
    }

    const scene::Scene& scene_;
    SceneRendererSettings settings_;
    TaskPool threads_;
    scene::SceneState state_;
    std::optional<PlacedInstances> placed_;
    std::optional<Culling> culling_;
    std::vector<std::uint32_t> meshes_;  // of the visible instances, those that no billboard stands for
    std::optional<DrawList> draw_list_;
    std::unique_ptr<GpuScene> gpu_scene_;
    GBufferPass gbuffer_;
    LightingPass lighting_;
    ImagePasses images_;
    SurfaceResolve resolve_;
    std::optional<LayerTextures> resolved_;   ///< of the last size drawn with several samples
    std::optional<QuarterTexture> quarters_;  ///< likewise
    LightTiles lights_;
    SkyParts sky_;
    gl::Buffer frame_block_;
    std::optional<BillboardPainter> painter_;
    std::unique_ptr<BillboardField> field_;
    ScenePart part_;  ///< of the picture being drawn; all of the scene unless into_ says so
    GpuScene::Into into_ = GpuScene::Into::gbuffer;
    int samples_per_axis_ = 1;           ///< of the part being drawn
    glm::ivec2 tile_first_px_{0};        ///< of its tile being drawn
    std::optional<gl::Texture> behind_;  ///< limits of the last part that had some
    std::vector<std::uint32_t> in_part_;
    bool use_billboards_ = false;
    bool replace_by_billboards_ = false;  ///< in the picture being drawn
    std::vector<std::unique_ptr<RenderTargets>> targets_;
    DrawCounters counters_;
};

}  // namespace

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::create(const scene::Scene& scene,
                                                             SceneRendererSettings settings) {
    auto gpu_scene = GpuScene::create(scene);
    if (!gpu_scene.ok()) return gpu_scene.error();
    auto lighting = LightingPass::create(!scene.point_lights.empty());
    if (!lighting.ok()) return lighting.error();
    auto images = ImagePasses::create();
    if (!images.ok()) return images.error();
    auto resolve = SurfaceResolve::create();
    if (!resolve.ok()) return resolve.error();
    auto renderer = std::make_unique<DeferredSceneRenderer>(
        scene, settings, std::move(*gpu_scene), std::move(*lighting), std::move(*images), std::move(*resolve));
    const Status billboards = renderer->add_billboards();
    if (!billboards.ok()) return billboards.error();
    const Status warm = renderer->warm_up();
    if (!warm.ok()) return warm.error();
    return std::unique_ptr<SceneRenderer>{std::move(renderer)};
}

}  // namespace lw
