#pragma once
/// Second and further layers of a frame, put behind and before what is already shown.

#include "warp_server/layer_reach.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Keeps scratch memory. Server thread.
class LayerComposition {
public:
    /// Warps `layer` with `method` and shows it in `into` where nothing is shown yet or where it is nearer. Only the
    /// part of the target is warped that the layer can reach and where something is missing, so the cost grows with
    /// what becomes visible and not with the number of layers. Of two surfaces at nearly the same depth the one that is
    /// shown already stays: layers come nearest shell first, and the nearest is the newest.
    ///
    /// Layers of the nearest shell beside its view stand in for it past its edges: where the view covers the target
    /// they only fill holes, since they are older.
    /// @param view  the frame's first layer
    /// @return false when the layer has nothing to show in this frame, and was not warped
    bool add(WarpMethod& method, const Layer& layer, const Layer& view, const WarpTarget& target, DisplayFrame& into);

    /// Mixes every layer's colours with its shell's from now on.
    void set_false_colours(bool on) { false_colours_ = on; }
    [[nodiscard]] bool false_colours() const { return false_colours_; }
    /// Mixes a picture that is not composed, of a first layer.
    void tint(const Layer& layer, DisplayFrame& frame) const;

private:
    DisplayFrame scratch_;
    bool false_colours_ = false;
};

}  // namespace lw
