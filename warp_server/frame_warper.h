#pragma once
/// One display frame: warp method, then fill, with the time each took. What the live server, replay and the command
/// line all call.

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/clock.h"
#include "core/result.h"
#include "warp_server/fill.h"
#include "warp_server/layer_composition.h"
#include "warp_server/part_cover.h"
#include "warp_server/picture_maker.h"
#include "warp_server/stepped_warp.h"
#include "warp_server/warp_method.h"

namespace lw {

class FrameWarper final : public PictureMaker {
public:
    FrameWarper(std::unique_ptr<WarpMethod> method, std::unique_ptr<Fill> fill)
        : method_{std::move(method)},
          fill_{std::move(fill)},
          part_cover_{std::make_unique<PartCover>(method_->threads())},
          stepped_{dynamic_cast<SteppedWarp*>(method_.get())} {
        fill_->work_on(method_->threads());
    }

    /// From specifications, "points:size_px=2" and "nearest-background".
    [[nodiscard]] static Result<FrameWarper> create(std::string_view method, std::string_view fill);

    /// Runs prepare and stores the result in the layer (client's thread, before publishing).
    void prepare(Layer& layer) const override;

    /// Warps and fills. `frame` has at least one layer; size, field of view and near plane of the target are usable
    /// (programmer errors otherwise). A head pose that is none (not finite, no direction) is replaced by the last good
    /// one, or by the first layer's before there was one; a mover's placement that is none by its last good one; a
    /// layer whose camera is none is left out, and when no layer is left the picture shown before is shown again. All
    /// of that is counted. The same layers at the same poses are the same picture: it is shown again, whatever the
    /// method. The result is valid until the next call. Server thread.
    const DisplayFrame& warp(const RenderedFrame& frame, const WarpTarget& target) override;

    /// Whether the method has steps (stepped_warp.h).
    [[nodiscard]] bool can_step() const { return stepped_ != nullptr; }
    /// warp() in steps, for the same picture: after begin_steps() every band of `bands` is stepped until it returns
    /// false, each on a thread of its own or all on one; then next_stage() is called, and both again as long as it
    /// returns true. finish_steps() fills. `frame` and `target.movers` outlive all of it.
    void begin_steps(const RenderedFrame& frame, const WarpTarget& target, int bands);
    bool step(int band) { return is_stepping_ && stepped_->step(band); }
    [[nodiscard]] bool next_stage();
    void finish_steps();

    /// What the last warp left out, over all layers.
    [[nodiscard]] const WarpCounters& counters() const override { return counters_; }
    /// What else of its input could not be used.
    [[nodiscard]] const HeldInput& held() const override { return held_; }
    /// The picture of the last warp().
    [[nodiscard]] const DisplayFrame& display_frame() const override { return display_frame_; }
    /// The same, to write over it what belongs to the display and not to the scene (photon codes, an overlay). It is
    /// not shown again after that.
    [[nodiscard]] DisplayFrame& display_frame_to_write_over() override {
        made_.layers.clear();
        return display_frame_;
    }

    void report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const override;

    /// Shows which shell each pixel comes from, from the next picture on.
    void set_false_colours(bool on) {
        if (on != composition_.false_colours()) made_.layers.clear();
        composition_.set_false_colours(on);
    }

    [[nodiscard]] const WarpMethod& method() const { return *method_; }
    /// Share of unreached pixels of the last frame, before fill. Computed on demand from its coverage.
    [[nodiscard]] double hole_fraction() const { return lw::hole_fraction(display_frame_); }

private:
    [[nodiscard]] bool begin(const RenderedFrame& frame, const WarpTarget& target);
    void finish();
    [[nodiscard]] WarpTarget usable_target(const RenderedFrame& frame, const WarpTarget& target);
    void hold_placements(std::span<const ObjectTransform> movers);
    // What the last picture was made of. Layers by their weak pointers: an address may come again, and the last
    // reference to a layer belongs to the client.
    struct Made {
        std::vector<std::weak_ptr<const Layer>> layers;
        Camera camera;
        std::optional<Eye> eye;
        std::vector<ObjectTransform> movers;
        std::uint64_t bad_layers = 0;
    };
    [[nodiscard]] bool is_made_of(const RenderedFrame& frame, const WarpTarget& target) const;
    void remember();

    std::unique_ptr<WarpMethod> method_;
    std::unique_ptr<Fill> fill_;
    std::unique_ptr<PartCover> part_cover_;
    SteppedWarp* stepped_;  ///< the method, where it has steps
    DisplayFrame display_frame_;
    Made made_;
    LayerComposition composition_;
    std::vector<const Layer*> usable_layers_;  // of the picture being made
    const RenderedFrame* frame_ = nullptr;     // from which it is made
    WarpTarget usable_;                        // for which it is made
    bool is_reused_ = false;                   // it is the one before
    bool is_stepping_ = false;
    WarpCounters counters_;
    HeldInput held_;
    std::optional<Pose> good_head_;
    std::vector<ObjectTransform> good_movers_;    // by ascending id: the last usable placement of each
    std::vector<ObjectTransform> usable_movers_;  // of this picture
};

}  // namespace lw
