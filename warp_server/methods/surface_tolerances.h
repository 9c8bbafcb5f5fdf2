#pragma once
/// How exactly depths must agree to be one surface, or one plane.

#include <algorithm>

#include "core/camera.h"

namespace lw {

/// A step of 1 % of the depth displaces the parallax by as much: 0.5 px for a head that moved 10 cm before something
/// 1 m away, which is less than what a wrong edge would show.
inline constexpr float kLevelDepthPart = 0.01F;

/// Samples averaged per surface sit up to a quarter of a pixel beside the pixel's centre, so slopes differ by half of
/// themselves at worst between two neighbours on one plane.
inline constexpr float kSlopeChangePart = 0.5F;

/// How far off a plane a pixel of it may lie: `part` of its depth, or `step` where that is more.
struct DepthTolerance {
    float part = 0.0F;
    float step = 0.0F;

    [[nodiscard]] float at(float depth) const { return std::max(part * depth, step); }
};

/// Of a patch: 0.05 px for 10 cm of motion at 1 m.
inline constexpr float kPlaneDepthPart = 1e-3F;

/// The same where planes meet: pixels near a crease are on their own plane and almost on the other one.
inline constexpr float kMeetingPlanesDepthPart = 1e-5F;

/// What lies apart by so little does not show that it does, at any distance: it shifts by at most 0.1 px when the head
/// moves 10 cm. Reversed depth is the near plane's distance over a pixel's, so that equal steps are equal shifts: the
/// tiles of a roof 20 m away, and the paint on the street, are planes. Of what stands still alone: what turns shows its
/// depth. (City at 1024x1024 from one sample: `prepare` 14.7 to 8.8 ms, the warp 9.4 to 8.5 ms; mean FLIP of twelve
/// replays the same to three digits.) A choice (`surface:flatten=1`), since it is no longer exact for whoever travels
/// kilometres while a frame is shown, nor are the depths of what is far.
[[nodiscard]] float unseen_depth_step(const Camera& source);

/// How far a piece reaches beyond its first and its last cell, in source pixels.
struct PatchOverlap {
    float before_px = 0.0F;
    float after_px = 0.0F;
};

/// Pieces of one surface overlap, so that rounding leaves no crack between them.
inline constexpr PatchOverlap kPatchOverlap{0.02F, 0.02F};

/// Edge cells must hardly overlap, because a pixel in two of them would count twice. Things that moved along one axis
/// only have pixels exactly on the borders of cells along the other: those belong to the later cell alone.
inline constexpr PatchOverlap kEdgeOverlap{1.1e-3F, -1e-3F};

/// Of surfaces drawn a tile at a time a cell begins so far before its first pixel: in the middle of where edge cells
/// drawn by themselves overlap. With whole numbers, surfaces of one cell in a strip between the two were drawn by
/// neither where others came by the other way: single holes in foliage.
inline constexpr float kCellsBegin_px = 1.05e-3F;

}  // namespace lw
