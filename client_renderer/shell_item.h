#pragma once
/// What one item of a client of shells, a tile or the view, is shown from.

#include <memory>
#include <utility>

#include "client_renderer/layer_statistics.h"
#include "frame_link/rendered_frame.h"

namespace lw {

struct ShellItem {
    std::shared_ptr<const Layer> layer;   ///< null: never drawn
    std::shared_ptr<const Layer> hidden;  ///< of the view, with --layers 2
    LayerStatistics statistics;
    double drawn_s = 0.0;
    bool outdated = false;  ///< drawn for ranges that are no longer
    double holes_px = 0.0;  ///< mean per display frame since it was drawn
    double hole_frames = 0.0;

    /// Anew: nothing is known to be wrong.
    void set_layer(std::shared_ptr<const Layer> drawn, double now_s) {
        layer = std::move(drawn);
        drawn_s = now_s;
        outdated = false;
        holes_px = 0.0;
        hole_frames = 0.0;
    }
    [[nodiscard]] bool is_valid() const { return layer != nullptr && !outdated; }
    /// What the server could not explain there.
    /// @param reported_px  mean per display frame, over `frames` of them
    void count_holes(double reported_px, double frames) {
        holes_px = (holes_px * hole_frames + reported_px) / (hole_frames + frames);
        hole_frames += frames;
    }
};

}  // namespace lw
