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

/// What one frame of a trial cost and did.
struct TrialFrame {
    double time_s = 0.0;  ///< on the path
    double frame_ms = 0.0;
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
    /// Mode off: everything is a mesh. `clock` outlives the trial.
    [[nodiscard]] static Result<BillboardTrial> create(std::string label, const scene::Scene& scene,
                                                       const BillboardSettings& settings, const Clock& clock);

    /// Draws the next frame of the path, with `samples_per_axis` squared samples per pixel, and remembers what it cost.
    /// The picture stays until the next one.
    const ColourImage& draw(const Camera& camera, double time_s, int samples_per_axis = 1);

    [[nodiscard]] const std::string& label() const { return label_; }
    [[nodiscard]] const std::vector<TrialFrame>& frames() const { return frames_; }
    /// Bytes that the atlases take, by dimension; zero for meshes.
    [[nodiscard]] std::array<std::size_t, kBillboardDimensions.size()> bytes() const;
    /// Billboards drawn anew so far: created and updated.
    [[nodiscard]] std::uint64_t redraws() const;

private:
    BillboardTrial(std::string label, const Clock& clock, std::unique_ptr<SceneRenderer> renderer)
        : label_{std::move(label)}, clock_{&clock}, renderer_{std::move(renderer)} {}

    std::string label_;
    const Clock* clock_;
    std::unique_ptr<SceneRenderer> renderer_;
    CpuPixels pixels_;
    std::vector<TrialFrame> frames_;
};

/// How much more two pictures in a row change than the true ones do: over 4 x 4 pixels, the cell of the dither, since
/// the eye averages over it. The excess of the change of luma (sRGB, 0 to 1), squared and averaged. Equal sizes. Pure.
[[nodiscard]] double flicker_energy(const ColourImage& before, const ColourImage& after, const ColourImage& true_before,
                                    const ColourImage& true_after);

}  // namespace lw
