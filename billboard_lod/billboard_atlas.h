#pragma once
/// The framebuffers that hold the billboards' surfaces: one per dimension and page.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "billboard_lod/atlas_layout.h"
#include "core/result.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace lw {

/// What an atlas keeps per texel. Object ids are constant over a billboard and are not stored.
enum class AtlasFormat : std::uint8_t {
    packed,    ///< 10 bytes: surface RG32UI (shaders/billboards/packed_surface.glsl), depth 16 bits of the own range
    document,  ///< 13 bytes, as seed 000 has it: colour and roughness 4, normal 4, metalness and share of glow 2, depth
               ///< 3
    full,      ///< 16 bytes: the attachments of the scene's G-buffer, depth 32 bits
};

/// Bytes of one texel. Pure.
[[nodiscard]] constexpr int bytes_per_texel(AtlasFormat format) {
    return format == AtlasFormat::packed ? 10 : format == AtlasFormat::document ? 13 : 16;
}

/// Preprocessor lines for the shaders that write or read such an atlas.
[[nodiscard]] std::string_view defines_of(AtlasFormat format);

/// Belongs to one GL context and its thread.
class BillboardAtlas {
public:
    /// `capacities[i]` slots of kBillboardDimensions[i] are wanted, 0 or more; the driver's limits may allow fewer.
    /// Memory is taken page by page, when each is first drawn to. A shader that does not compile is an error.
    [[nodiscard]] static Result<BillboardAtlas> create(AtlasFormat format,
                                                       const std::array<int, kBillboardDimensions.size()>& capacities);

    [[nodiscard]] AtlasFormat format() const { return format_; }
    [[nodiscard]] const AtlasLayouts& layouts() const { return layouts_; }

    /// Makes the framebuffer of `page` current, viewport over all of it, and clears the depth of `slots` (their
    /// indices; they lie on it). False when the driver has no memory for it; nothing is bound then. No such page:
    /// programmer error.
    [[nodiscard]] bool begin(AtlasPage page, std::span<const int> slots);

    /// Binds the textures of `page` to the units of billboard_blocks.h. It was drawn to.
    void bind_textures(AtlasPage page) const;

    /// Bytes of the textures of a level: what it takes now (0 before it was first drawn to).
    [[nodiscard]] std::size_t bytes(std::size_t level) const;

private:
    struct Page {
        std::vector<gl::Texture> surfaces;
        gl::Texture depth;
        gl::Framebuffer framebuffer;
    };

    BillboardAtlas() = default;
    [[nodiscard]] Page& at(AtlasPage page) { return pages_[page.level][static_cast<std::size_t>(page.index)]; }
    [[nodiscard]] bool allocate(AtlasPage page);
    void clear(std::size_t level, std::span<const int> slots);

    AtlasFormat format_ = AtlasFormat::packed;
    AtlasLayouts layouts_;
    std::array<std::vector<Page>, kBillboardDimensions.size()> pages_;  ///< by level; empty until drawn to
    gl::Program clear_;
    gl::Buffer rects_;  ///< mutable storage, replaced per clear
    gl::VertexArray rect_array_;
};

}  // namespace lw
