#include "warp_server/eye_layout.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.h"

namespace lw {
namespace {

constexpr std::array<std::pair<std::string_view, EyeLayout>, 4> kLayouts{{
    {"side-by-side", EyeLayout::side_by_side},
    {"top-bottom", EyeLayout::top_bottom},
    {"anaglyph", EyeLayout::anaglyph},
    {"files", EyeLayout::files},
}};

void pack_anaglyph(const ColourImage& left, const ColourImage& right, ColourImage& packed) {
    for (std::size_t i = 0; i < packed.pixels().size(); ++i) {
        const Rgba8 cyan = right.pixels()[i];
        packed.pixels()[i] = {left.pixels()[i].r, cyan.g, cyan.b, 255};
    }
}

}  // namespace

std::vector<std::string_view> eye_layout_names() {
    std::vector<std::string_view> names;
    for (const auto& [name, layout] : kLayouts) names.push_back(name);
    return names;
}

std::string_view name_of(EyeLayout layout) {
    for (const auto& [name, known] : kLayouts) {
        if (known == layout) return name;
    }
    return "unknown";
}

std::optional<EyeLayout> find_eye_layout(std::string_view name) {
    for (const auto& [known, layout] : kLayouts) {
        if (known == name) return layout;
    }
    return std::nullopt;
}

glm::ivec2 packed_size_px(EyeLayout layout, glm::ivec2 eye_px) {
    if (layout == EyeLayout::anaglyph) return eye_px;
    return layout == EyeLayout::top_bottom ? glm::ivec2{eye_px.x, 2 * eye_px.y} : glm::ivec2{2 * eye_px.x, eye_px.y};
}

void pack_eyes(EyeLayout layout, const ColourImage& left, const ColourImage& right, ColourImage& packed) {
    LW_CHECK(left.size_px() == right.size_px(), "both eyes' pictures are of one size");
    packed.resize(packed_size_px(layout, left.size_px()));
    if (layout == EyeLayout::anaglyph) return pack_anaglyph(left, right, packed);
    if (layout == EyeLayout::top_bottom) {
        const auto below = std::ranges::copy(left.pixels(), packed.pixels().begin()).out;
        std::ranges::copy(right.pixels(), below);
        return;
    }
    for (int y = 0; y < left.height(); ++y) {
        const auto beside = std::ranges::copy(left.row(y), packed.row(y).begin()).out;
        std::ranges::copy(right.row(y), beside);
    }
}

}  // namespace lw
