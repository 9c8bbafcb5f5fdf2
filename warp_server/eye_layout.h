#pragma once
/// Two eyes' pictures as one (--stereo-output).

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace lw {

enum class EyeLayout : std::uint8_t {
    side_by_side,  ///< left eye left, right eye right: for a headset, or parallel viewing
    top_bottom,    ///< left eye on top
    anaglyph,      ///< red from the left eye, green and blue from the right one: red-cyan glasses
    files,         ///< two files; where there is but one display, side by side on it
};

[[nodiscard]] std::vector<std::string_view> eye_layout_names();  ///< "side-by-side", "top-bottom", "anaglyph", "files"
[[nodiscard]] std::string_view name_of(EyeLayout layout);
[[nodiscard]] std::optional<EyeLayout> find_eye_layout(std::string_view name);

/// Size of what two pictures of `eye_px` become.
[[nodiscard]] glm::ivec2 packed_size_px(EyeLayout layout, glm::ivec2 eye_px);

/// Both eyes' pictures, of one size, into `packed`, which is resized. Allocates nothing once sizes are seen.
void pack_eyes(EyeLayout layout, const ColourImage& left, const ColourImage& right, ColourImage& packed);

}  // namespace lw
