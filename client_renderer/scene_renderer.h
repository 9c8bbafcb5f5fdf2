#pragma once
/// Draws a scene as the slow side does: G-buffer, deferred light, sky; into the pixels of a layer.

#include <memory>
#include <vector>

#include "billboard_lod/billboard_field.h"
#include "client_renderer/culling_settings.h"
#include "client_renderer/draw_order.h"
#include "client_renderer/scene_part.h"
#include "core/camera.h"
#include "core/clock.h"
#include "core/image.h"
#include "core/result.h"
#include "frame_link/rendered_frame.h"
#include "scene/scene.h"

namespace lw {

/// What one draw did.
struct DrawCounters {
    std::uint64_t objects_tested = 0;
    std::uint64_t objects_drawn = 0;
    std::uint64_t triangles_drawn = 0;
    std::uint64_t draw_calls = 0;
    std::uint64_t objects_outside = 0;          ///< skipped: not in the field of view
    std::uint64_t objects_behind_walls = 0;     ///< skipped: no portal in view shows them
    std::uint64_t objects_occluded = 0;         ///< skipped: hidden behind others
    std::uint64_t objects_too_small = 0;        ///< skipped: below --min-pixels
    std::uint64_t objects_between_samples = 0;  ///< skipped: too thin to meet a sample of the picture
    std::uint64_t clusters_tested = 0;
    std::uint64_t clusters_outside = 0;
    std::uint64_t clusters_turned_away = 0;
    std::uint64_t clusters_occluded = 0;
    std::uint64_t clusters_too_small = 0;
    std::uint64_t clusters_between_samples = 0;
    Duration culling{};  ///< deciding what is drawn, with the draws for it; zero unless the settings have a clock
    /// With a stage clock, each between two glFinish.
    double meshes_ms = 0.0;
    double billboards_ms = 0.0;  ///< drawing them; making and updating: BillboardCounters
    double light_ms = 0.0;
};

struct SceneRendererSettings {
    CullingSettings culling;             ///< whatever it skips, the picture is the same
    Clock* clock = nullptr;              ///< for DrawCounters::culling; outlives the renderer
    BillboardSettings billboards{};      ///< mode off: none, whatever use_billboards() says
    const Clock* stage_clock = nullptr;  ///< times the stages of every draw, at the cost of waiting for each
    DrawOrder order{};                   ///< where surfaces lie in one plane, it may decide which is seen
};

/// Belongs to one GL context and its thread: made, used and destroyed with that context current.
class SceneRenderer {
public:
    /// Uploads the scene and compiles every shader variant it needs. `scene` is finished and outlives the renderer.
    /// Shader or framebuffer trouble is an error.
    [[nodiscard]] static Result<std::unique_ptr<SceneRenderer>> create(const scene::Scene& scene,
                                                                       SceneRendererSettings settings = {});
    virtual ~SceneRenderer() = default;

    /// One sample per pixel, at its centre, into CPU memory: colour (sRGB), depth, ids. `pixels` is resized to
    /// camera.size_px, whose sides are at least 1 and at most what the driver takes (16384 on Mesa). A picture is a
    /// function of its arguments alone: equal ones give equal bytes.
    virtual void draw(const Camera& camera, double scene_time_s, CpuPixels& pixels) = 0;

    /// The source of a warp: `samples_per_axis` squared samples per pixel, resolved per surface (SurfaceResolve), so
    /// that surfaces are antialiased inside and keep hard edges. 1, 2 or 4; 1 equals draw() bit for bit, at its cost.
    /// Drawn in tiles where it is large.
    virtual void draw_resolved(const Camera& camera, double scene_time_s, int samples_per_axis, CpuPixels& pixels) = 0;

    /// draw_resolved() of a part of the scene. Objects that would be billboards are drawn as meshes.
    /// @return the number of pixels that hold nothing
    virtual std::uint64_t draw_part(const Camera& camera, double scene_time_s, int samples_per_axis,
                                    const ScenePart& part, CpuPixels& pixels) = 0;

    /// draw_resolved() into textures of the current context, with a fence, for a server whose context shares with this
    /// one.
    [[nodiscard]] virtual TexturePixels draw_to_textures(const Camera& camera, double scene_time_s,
                                                         int samples_per_axis) = 0;

    /// Truth: `samples_per_axis` squared samples per pixel, box-averaged in linear light. 1, 2 or 4; 1 equals
    /// draw(). Drawn in tiles where it is large, so any size up to the driver's texture limit works.
    virtual void draw_supersampled(const Camera& camera, double scene_time_s, int samples_per_axis,
                                   ColourImage& colour) = 0;

    /// From the next draw on, what is skipped as hidden is hidden from every eye within `margin_m` metres of the
    /// camera's. It changes no pixel, only what the counters say.
    virtual void set_reveal_margin(double margin_m) { (void)margin_m; }

    /// From the next draw on: objects below the settings' min_pixels are left out while the viewer moves. Before the
    /// first call it stands still.
    virtual void set_viewer_moves(bool moves) { (void)moves; }

    /// Placements of the movers at a scene time.
    virtual void mover_placements(double scene_time_s, std::vector<ObjectTransform>& transforms) = 0;

    /// Whether draw(), draw_resolved() and draw_to_textures() show far objects as billboards from now on; off at first,
    /// so that truth and comparisons are meshes. With them a picture depends on those drawn before. Truth
    /// (draw_supersampled) never shows any.
    virtual void use_billboards(bool use) { static_cast<void>(use); }
    /// The picture of the last draw_resolved() again, whose arguments these are, with its billboards as the frame
    /// before showed them: what its updates changed is the difference. Only with BillboardSettings::keep_replaced.
    virtual void draw_without_updates(const Camera& camera, double scene_time_s, int samples_per_axis,
                                      CpuPixels& pixels) {
        draw_resolved(camera, scene_time_s, samples_per_axis, pixels);
    }
    /// Null without billboards in the settings.
    [[nodiscard]] virtual const BillboardField* billboards() const { return nullptr; }

    [[nodiscard]] virtual const DrawCounters& counters() const = 0;  ///< of the last draw
};

}  // namespace lw
