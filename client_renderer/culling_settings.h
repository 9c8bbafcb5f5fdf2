#pragma once
/// What a client may leave out of a frame.

namespace lw {

struct CullingSettings {
    bool skip = true;              ///< off (--no-skip): everything is drawn, in the same order
    bool clusters = true;          ///< also clusters of triangles of what is drawn
    double reveal_margin_m = 0.0;  ///< what is hidden must stay so for every eye within this distance, >= 0
};

}  // namespace lw
