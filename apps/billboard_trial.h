#pragma once
/// One way to draw a scene's far objects, tried along a camera path, for the suite `billboards`.

#include <memory>
#include <string>
#include <vector>

#include "apps/real_clock.h"
#include "billboard_lod/billboard_field.h"
#include "client_renderer/scene_renderer.h"
#include "core/result.h"

namespace lw {

/// Processor time of all threads of this process. On a machine that does other work it is steadier than wall time.
class ProcessorClock final : public Clock {
public:
    [[nodiscard]] TimePoint now() const override;
    /// Nobody waits by it: programmer error.
    void sleep_until(TimePoint wake) override;
};

/// The clocks of a trial; they outlive it.
struct TrialClocks {
    const Clock* wall;
    const Clock* processor;
};

/// What one frame of a trial cost and did. All but the wall time is processor time of all threads.
struct TrialFrame {
    double time_s = 0.0;    ///< on the path
    double wall_ms = 0.0;   ///< of the whole frame
    double frame_ms = 0.0;  ///< of the whole frame
    double meshes_ms = 0.0;
    double choose_ms = 0.0;
    double create_ms = 0.0;
    double update_ms = 0.0;
    double draw_ms = 0.0;
    double light_ms = 0.0;
    BillboardCounters counters;
    std::uint64_t triangles_drawn = 0;
};

/// Belongs to one GL context and its thread.
class BillboardTrial {
public:
    /// Mode off: everything is a mesh.
    [[nodiscard]] static Result<BillboardTrial> create(std::string label, const scene::Scene& scene,
                                                       const BillboardSettings& settings, const TrialClocks& clocks);

    /// Draws the next frame of the path, with `samples_per_axis` squared samples per pixel, and remembers what it cost.
    /// The picture stays until the next one.
    const ColourImage& draw(const Camera& camera, double time_s, int samples_per_axis = 1);

    /// The last frame again as it would be without its updates and steps of fades; for settings that keep what is
    /// replaced. The picture stays until the next one.
    const ColourImage& draw_without_updates(const Camera& camera, int samples_per_axis);

    /// Of the frame drawn last.
    [[nodiscard]] const ColourImage& picture() const { return pixels_.colour; }
    [[nodiscard]] const std::string& label() const { return label_; }
    [[nodiscard]] const std::vector<TrialFrame>& frames() const { return frames_; }
    /// Bytes that the atlases take, by dimension; zero for meshes.
    [[nodiscard]] std::array<std::size_t, kBillboardDimensions.size()> bytes() const;
    /// Billboards drawn anew so far: created and updated.
    [[nodiscard]] std::uint64_t redraws() const;

private:
    BillboardTrial(std::string label, const TrialClocks& clocks, std::unique_ptr<SceneRenderer> renderer)
        : label_{std::move(label)}, clocks_{clocks}, renderer_{std::move(renderer)} {}

    std::string label_;
    TrialClocks clocks_;
    std::unique_ptr<SceneRenderer> renderer_;
    CpuPixels pixels_;
    CpuPixels without_updates_;
    std::vector<TrialFrame> frames_;
};

/// How much two pictures differ: luma (sRGB, 0 to 1) averaged over cells of `cell_px` squared, the difference squared
/// and averaged. Equal sizes. Pure.
[[nodiscard]] double change_energy(const ColourImage& before, const ColourImage& after, int cell_px);

/// How much more two pictures in a row change than the true ones do: over 4 x 4 pixels, the cell of the dither, since
/// the eye averages over it. The excess of the change of luma (sRGB, 0 to 1), squared and averaged. Equal sizes. Pure.
[[nodiscard]] double flicker_energy(const ColourImage& before, const ColourImage& after, const ColourImage& true_before,
                                    const ColourImage& true_after);

}  // namespace lw
