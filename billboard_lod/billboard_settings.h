#pragma once
/// What can be chosen about billboards.

#include <array>
#include <cstdint>
#include <limits>

#include "billboard_lod/billboard_atlas.h"
#include "billboard_lod/billboard_pass.h"
#include "billboard_lod/update_criteria.h"

namespace lw {

enum class BillboardMode : std::uint8_t {
    off,
    flat,    ///< quads with the picture's axes that carry a G-buffer: seed 000
    warped,  ///< the billboard's own depth moves its pixels
};

enum class UpdateCriterion : std::uint8_t {
    angles,  ///< the three heuristics of seed 000
    error,   ///< pixels that the mode's own billboards are off
    /// Pixels that warped ones would be off, in either mode: flat and warped ones are drawn anew at the same times.
    warped_error,
};

struct BillboardSettings {
    BillboardMode mode = BillboardMode::off;
    double mesh_distance_share = 0.2;  ///< objects nearer than this share of the scene's diagonal are meshes
    std::array<int, kBillboardDimensions.size()> capacities{512, 512, 512, 512, 512, 128};
    AtlasFormat format = AtlasFormat::packed;
    QuadExpansion expansion = QuadExpansion::vertices;
    UpdateCriterion criterion = UpdateCriterion::error;
    UpdateThresholds thresholds;        ///< of the angles
    double error_cap_px = 2.0;          ///< of the error, pixels, > 0
    int max_creations = 64;             ///< per frame; the rest are meshes in this one
    int max_updates = 256;              ///< per frame; the rest are meshes in this one
    int texels_per_px = 3;              ///< a billboard's texels per pixel and axis when it is drawn, at least; 1 to 8
    int fade_frames = 0;                ///< frames over which a new version fades in over the old one; 0: at once
    double budget_ms = 0.0;             ///< estimated time for updates per frame; 0: no limit
    std::uint64_t min_triangles = 256;  ///< objects with fewer are drawn as fast as their quads
    /// Flat billboards beyond show no depth of their own, only their plane's: what a smaller texel without depth gives.
    double depthless_beyond_m = std::numeric_limits<double>::infinity();
    /// Flat ones too blend each texel with the one beside it, as warped ones do: tells what relief is worth by itself.
    bool blend_flat = false;
    bool group_touching = false;  ///< static objects whose boxes overlap share one billboard
    /// What a frame's updates replace is kept until the next one, so that withhold_updates() can show it. Takes slots.
    bool keep_replaced = false;
};

}  // namespace lw
