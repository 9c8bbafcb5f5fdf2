#pragma once
/// Which objects of a scene are billboards in this frame: makes, updates, frees and draws them.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "billboard_lod/billboard_settings.h"
#include "billboard_lod/object_painter.h"
#include "core/camera.h"
#include "core/clock.h"
#include "core/result.h"
#include "scene/scene.h"

namespace lw {

/// What one prepare() did. Objects, not instances.
struct BillboardCounters {
    std::uint64_t out_of_view = 0;
    std::uint64_t near_meshes = 0;   ///< nearer than the threshold, around the eye, or across the near plane
    std::uint64_t queue_meshes = 0;  ///< fell out of the queue of creations or of updates
    std::uint64_t atlas_meshes = 0;  ///< no slot was free
    std::uint64_t bad_bounds = 0;    ///< empty or infinite box, or a placement without an inverse: meshes
    std::uint64_t active = 0;        ///< shown as billboards, the new ones included
    std::uint64_t created = 0;
    std::uint64_t updated = 0;
    std::uint64_t stale = 0;  ///< due, but kept for the time budget
    std::uint64_t triangles_painted = 0;
    std::uint64_t triangles_in_view = 0;      ///< of the meshes of all objects that are not out of view
    std::uint64_t triangles_replaceable = 0;  ///< of those that may be billboards
    std::array<std::uint64_t, kBillboardDimensions.size()> active_by_dimension{};
    double choose_ms = 0.0;  ///< scores and queues, on the processor; with a stage clock
    double create_ms = 0.0;  ///< with a stage clock; includes waiting for the GL
    double update_ms = 0.0;
};

/// Belongs to one GL context and its thread.
class BillboardField {
public:
    /// `scene` is finished; it, `painter` and `stage_clock` (may be null) outlive the field. With a clock the stages
    /// are timed between two glFinish. A shader that does not compile is an error.
    [[nodiscard]] static Result<std::unique_ptr<BillboardField>> create(const scene::Scene& scene,
                                                                        ObjectPainter& painter,
                                                                        const BillboardSettings& settings,
                                                                        const Clock* stage_clock);
    virtual ~BillboardField() = default;

    /// Decides for one frame and draws what is new or out of date into the atlases. `camera` is that of the whole
    /// picture, its pixels are the samples to draw; `state` is at the frame's time. Changes the framebuffer binding.
    virtual void prepare(const Camera& camera, const scene::SceneState& state) = 0;

    /// By index into the scene's instances: 1 where a billboard stands for the instance in this frame.
    [[nodiscard]] virtual std::span<const std::uint8_t> replaced() const = 0;

    /// Draws the frame's billboards into the G-buffer that is bound, of those that fade the version that is opaque.
    /// `part` has the eye of prepare()'s camera: the whole or a tile of it.
    virtual void draw(const Camera& part) = 0;

    /// After draw() of the same part and its light: blends what fades into the picture, whose colour, ids and depth are
    /// bound, as are the blocks of the light pass.
    virtual void draw_fading(const Camera& part) = 0;
    /// Whether draw_fading() has anything to draw.
    [[nodiscard]] virtual bool fades() const = 0;

    /// From now on draw() shows each billboard as the frame before did, where that had one: the picture without this
    /// frame's updates and steps of fades. Only with BillboardSettings::keep_replaced.
    virtual void withhold_updates(bool withhold) = 0;

    [[nodiscard]] virtual const BillboardCounters& counters() const = 0;
    /// Bytes that the atlases of each dimension take now.
    [[nodiscard]] virtual std::array<std::size_t, kBillboardDimensions.size()> bytes() const = 0;
    [[nodiscard]] virtual const BillboardSettings& settings() const = 0;
};

}  // namespace lw
