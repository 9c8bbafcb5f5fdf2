#pragma once
/// One display frame: warp method, then fill, with the time each took. What the live server, replay and the command
/// line all call.

#include <memory>
#include <string_view>
#include <vector>

#include "core/clock.h"
#include "core/result.h"
#include "warp_server/fill.h"
#include "warp_server/warp_method.h"

namespace lw {

class FrameWarper {
public:
    FrameWarper(std::unique_ptr<WarpMethod> method, std::unique_ptr<Fill> fill)
        : method_{std::move(method)}, fill_{std::move(fill)} {}

    /// From specifications, "points:size_px=2" and "nearest-background".
    [[nodiscard]] static Result<FrameWarper> create(std::string_view method, std::string_view fill);

    /// Runs prepare and stores the result in the layer (client's thread, before publishing).
    void prepare(Layer& layer) const;

    /// Warps and fills. `frame` has at least one layer. The result is valid until the next call. Server thread.
    /// The same layers at the same poses are the same picture: it is shown again, whatever the method.
    const DisplayFrame& warp(const RenderedFrame& frame, const WarpTarget& target);

    [[nodiscard]] const WarpMethod& method() const { return *method_; }
    /// Of the last warp(), all layers together.
    [[nodiscard]] const WarpCounters& counters() const { return counters_; }
    /// Share of unreached pixels of the last frame, before fill. Computed on demand from its coverage.
    [[nodiscard]] double hole_fraction() const { return lw::hole_fraction(display_frame_); }

private:
    // What the last picture was made of. Layers by their weak pointers: an address may come again, and the last
    // reference to a layer belongs to the client.
    struct Made {
        std::vector<std::weak_ptr<const Layer>> layers;
        Camera camera;
        std::vector<ObjectTransform> movers;
    };
    [[nodiscard]] bool is_made_of(const RenderedFrame& frame, const WarpTarget& target) const;
    void remember(const RenderedFrame& frame, const WarpTarget& target);

    std::unique_ptr<WarpMethod> method_;
    std::unique_ptr<Fill> fill_;
    DisplayFrame display_frame_;
    Made made_;
    WarpCounters counters_;
    DisplayFrame layer_frame_;  // scratch: second and further layers before they are merged
};

}  // namespace lw
