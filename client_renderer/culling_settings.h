#pragma once
/// What a client may leave out of a frame.

namespace lw {

struct CullingSettings {
    bool skip = true;              ///< off (--no-skip): everything is drawn, in the same order
    bool occlusion = true;         ///< also what is hidden behind solid parts of the scene
    bool portals = true;           ///< through the portals of a building rather than by the field of view
    bool clusters = true;          ///< also clusters of triangles of what is drawn
    double min_pixels = 0.0;       ///< what looks smaller across is left out while the viewer moves; 0: nothing is
    double reveal_margin_m = 0.0;  ///< what is hidden must stay so for every eye within this distance, >= 0
    int threads = 0;               ///< that share the work, the renderer's included; 0: two, where the machine has them
};

}  // namespace lw
