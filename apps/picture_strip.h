#pragma once
/// Pictures side by side with words under each: what the README shows, and what a run leaves behind to look at.

#include <string>
#include <vector>

#include "core/image.h"

namespace lw {

struct StripPicture {
    const ColourImage* picture = nullptr;  ///< not null; all of a strip have one size
    std::vector<std::string> lines;        ///< written below it; capitals, digits and . , : ; = + - % / ( ) _
};

/// Draws the strip on white, opaque. Letters come from a built-in 5x7 bitmap font, enlarged by whole numbers so that
/// about 24 fit below a picture; small letters are shown as capitals, unknown ones as blanks, and what is wider than
/// its picture is cut off.
/// @param pictures  at least one. Pure, any thread.
[[nodiscard]] ColourImage picture_strip(const std::vector<StripPicture>& pictures);

}  // namespace lw
