#include "billboard_lod/billboard_atlas.h"

#include <algorithm>

#include "core/check.h"
#include "gl/stream_buffer.h"
#include "shaders/billboard_blocks.h"

namespace lw {

namespace {

/// 5 MB of ten bytes. A software GL clears what it gives: 2 ms for such a page, 137 ms for all slots of 256 x 256 at
/// once.
constexpr int kPageTexels = 1 << 19;

std::vector<GLenum> surface_formats(AtlasFormat format) {
    if (format == AtlasFormat::packed) return {GL_RG32UI};
    if (format == AtlasFormat::document) return {GL_RGBA8, GL_RG16, GL_RG8};
    return {GL_RGBA8, GL_RG16, GL_RGBA8};
}

GLenum depth_format(AtlasFormat format) {
    if (format == AtlasFormat::packed) return GL_DEPTH_COMPONENT16;
    return format == AtlasFormat::document ? GL_DEPTH_COMPONENT24 : GL_DEPTH_COMPONENT32F;
}

glm::ivec2 driver_limit_px() {
    GLint texture = 0;
    GLint width = 0;
    GLint height = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_FRAMEBUFFER_WIDTH, &width);
    glGetIntegerv(GL_MAX_FRAMEBUFFER_HEIGHT, &height);
    return glm::min(glm::ivec2{width, height}, glm::ivec2{texture});
}

}  // namespace

std::string_view defines_of(AtlasFormat format) {
    if (format == AtlasFormat::packed) return "#define PACKED\n";
    return format == AtlasFormat::document ? "#define SHARED_COLOUR\n" : "";
}

Result<BillboardAtlas> BillboardAtlas::create(AtlasFormat format,
                                              const std::array<int, kBillboardDimensions.size()>& capacities) {
    BillboardAtlas atlas;
    atlas.format_ = format;
    const glm::ivec2 limit_px = driver_limit_px();
    for (std::size_t level = 0; level < capacities.size(); ++level) {
        AtlasLayout& layout = atlas.layouts_[level];
        layout = paged_layout(kBillboardDimensions[level], capacities[level], limit_px, kPageTexels);
        atlas.pages_[level].resize(static_cast<std::size_t>(layout.pages));
    }
    auto clear = gl::Program::create({"billboards/clear.vert", "billboards/clear.frag"});
    if (!clear.ok()) return clear.error();
    atlas.clear_ = std::move(*clear);
    atlas.rects_ = gl::make_stream_buffer();
    atlas.rect_array_ = gl::make_vertex_array();
    const GLuint array = atlas.rect_array_.id();
    glVertexArrayVertexBuffer(array, 0, atlas.rects_.id(), 0, sizeof(glm::vec4));
    glVertexArrayBindingDivisor(array, 0, 1);
    glEnableVertexArrayAttrib(array, 0);
    glVertexArrayAttribFormat(array, 0, 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, 0, 0);
    return atlas;
}

bool BillboardAtlas::allocate(AtlasPage page) {
    Page& made = at(page);
    const glm::ivec2 size_px = layouts_[page.level].size_px();
    while (glGetError() != GL_NO_ERROR) {
    }
    std::vector<const gl::Texture*> colours;
    made.surfaces.reserve(3);
    for (const GLenum format : surface_formats(format_)) made.surfaces.emplace_back(size_px, format);
    for (const gl::Texture& surface : made.surfaces) colours.push_back(&surface);
    made.depth = gl::Texture{size_px, depth_format(format_)};
    if (glGetError() == GL_NO_ERROR) {
        auto framebuffer = gl::Framebuffer::create(colours, &made.depth);
        if (framebuffer.ok()) {
            made.framebuffer = std::move(*framebuffer);
            return true;
        }
    }
    made = {};
    return false;
}

bool BillboardAtlas::begin(AtlasPage page, std::span<const int> slots) {
    LW_CHECK(page.index < layouts_[page.level].pages, "an atlas without this page");
    if (!at(page).framebuffer && !allocate(page)) return false;
    at(page).framebuffer.bind();
    clear(page.level, slots);
    return true;
}

void BillboardAtlas::clear(std::size_t level, std::span<const int> slots) {
    const AtlasLayout& layout = layouts_[level];
    std::vector<glm::vec4> rects;
    rects.reserve(slots.size());
    for (const int slot : slots) {
        const glm::dvec4 uv = layout.slot_uv(slot);
        // Row 0 is on top, NDC counts upwards.
        rects.emplace_back(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.w, 2.0 * uv.z - 1.0, 1.0 - 2.0 * uv.y);
    }
    gl::replace(rects_, rects);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    clear_.use();
    glBindVertexArray(rect_array_.id());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(rects.size()));
    glBindVertexArray(0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_GEQUAL);
    glDisable(GL_DEPTH_TEST);
}

void BillboardAtlas::bind_textures(AtlasPage page) const {
    const Page& bound = pages_[page.level][static_cast<std::size_t>(page.index)];
    glBindTextureUnit(shader::kUnitAtlasDepth, bound.depth.id());
    for (std::size_t i = 0; i < bound.surfaces.size(); ++i) {
        glBindTextureUnit(static_cast<GLuint>(shader::kUnitAtlasSurface) + static_cast<GLuint>(i),
                          bound.surfaces[i].id());
    }
}

std::size_t BillboardAtlas::bytes(std::size_t level) const {
    const auto made = std::ranges::count_if(pages_[level], [](const Page& page) { return bool{page.framebuffer}; });
    const glm::ivec2 size_px = layouts_[level].size_px();
    return static_cast<std::size_t>(made) * static_cast<std::size_t>(size_px.x) * static_cast<std::size_t>(size_px.y) *
           static_cast<std::size_t>(bytes_per_texel(format_));
}

}  // namespace lw
