#pragma once
/// A small code in the corner of a display frame, that tells from the picture alone which head sample and which
/// rendered frame it was made of. Written at the latch, read back from what the display scans out.

#include <cstdint>
#include <optional>

#include "core/image.h"

namespace lw {

struct PhotonCode {
    std::uint32_t pose_sample = 0;  ///< low 32 bits of the head sample's number
    std::uint16_t frame = 0;        ///< low 16 bits of the rendered frame's index
    friend bool operator==(const PhotonCode&, const PhotonCode&) = default;
};

/// The code is 16 x 4 cells, black or white, at the left edge: 32 bits of the sample's number, 16 of the frame's, and
/// a CRC-16 (CCITT) over both, most significant bits first. A cell is 4 x 4 pixels where there is room, or smaller.
inline constexpr int kPhotonCodeColumns = 16;
inline constexpr int kPhotonCodeRows = 4;

/// Writes the code over the rows from `top_px` on, of which `height_px` may be used.
/// @return false, and nothing is written, where the picture has no room for one pixel per cell. No allocation.
bool write_photon_code(ColourImage& picture, int top_px, int height_px, const PhotonCode& code);

/// The code in the rows from `top_px` on; nothing when there is none or its check bits do not fit. Survives brightness
/// errors below half and loses a cell only when its middle is wrong. No allocation. Pure.
[[nodiscard]] std::optional<PhotonCode> read_photon_code(const ColourImage& picture, int top_px, int height_px);

}  // namespace lw
