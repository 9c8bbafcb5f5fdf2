/// `surface` on GL: the same pieces of plane as the CPU's, drawn as rectangles whose every pixel asks for its exact
/// place in the source; along edges lists of fragments per pixel, put together at the end.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "gl/program.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/gl_images.h"
#include "warp_server/methods/gl_source.h"
#include "warp_server/methods/gl_target.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_split.h"

namespace lw {
namespace {

// Of shaders/warp/surface_patch.vert.
constexpr std::size_t kPatchVertices = 6;

// What the shaders draw, packed on the client's thread.
struct PreparedGlSurface final : PreparedLayer {
    std::uint64_t number = 0;  ///< tells one from the next; addresses come again
    std::vector<glsl::WarpPatch> patches;
    std::size_t whole_count = 0;  ///< the rest are edges
    std::vector<IdCount> id_counts;
};

void append(const PatchList& list, std::vector<glsl::WarpPatch>& packed) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        packed.push_back({{list.x[i], list.y[i], list.depth[i], list.gradient_x[i]},
                          {list.left[i], list.right[i], list.top[i], list.bottom[i]},
                          list.gradient_y[i],
                          list.object_id[i],
                          list.corners[i],
                          0});
    }
}

// Waits for the client's own drawing: the classification needs the pixels.
CpuPixels downloaded(const TexturePixels& textures) {
    const glm::ivec2 size_px = textures.colour.size_px();
    CpuPixels pixels{ColourImage{size_px}, DepthImage{size_px}, ObjectIdImage{size_px}};
    textures.colour.download(GL_RGBA, GL_UNSIGNED_BYTE, pixels.colour.size_bytes(), pixels.colour.pixels().data());
    textures.depth.download(GL_RED, GL_FLOAT, pixels.depth.size_bytes(), pixels.depth.pixels().data());
    textures.object_id.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, pixels.object_id.size_bytes(),
                                pixels.object_id.pixels().data());
    return pixels;
}

struct SurfacePrograms {
    gl::Program opaque;
    gl::Program edge;
    gl::Program resolve;

    [[nodiscard]] static Result<SurfacePrograms> create() {
        auto opaque = gl::Program::create({"warp/surface_patch.vert", "warp/surface_opaque.frag"});
        if (!opaque) return opaque.error();
        auto edge = gl::Program::create({"warp/surface_patch.vert", "warp/surface_edge.frag"});
        if (!edge) return edge.error();
        auto resolve = gl::Program::create({"warp/surface_resolve.comp"});
        if (!resolve) return resolve.error();
        return SurfacePrograms{std::move(opaque).value(), std::move(edge).value(), std::move(resolve).value()};
    }
};

// Lists of fragments per pixel (shaders/warp/surface_edge.frag). Grows when a picture had more than it holds.
class FragmentLists {
public:
    void begin(glm::ivec2 size_px) {
        if (!newest_ || newest_.size_px() != size_px) newest_ = gl::Texture{size_px, GL_R32UI};
        const auto pixels = static_cast<std::uint32_t>(size_px.x) * static_cast<std::uint32_t>(size_px.y);
        // As many as pixels were never needed by a scene that is no thicket.
        if (capacity_ < pixels) allocate(pixels);
        glClearTexImage(newest_.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &glsl::kNoFragment);
        constexpr std::uint32_t kNone = 0;
        glNamedBufferSubData(fragments_.id(), 0, sizeof(kNone), &kNone);
        glBindImageTexture(LW_WARP_INDEX_IMAGE, newest_.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, LW_WARP_FRAGMENTS_BINDING, fragments_.id());
    }

    // Makes room for the next attempt when the last did not fit. Waits for the GPU.
    [[nodiscard]] bool all_fit() {
        std::uint32_t count = 0;
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glGetNamedBufferSubData(fragments_.id(), 0, sizeof(count), &count);
        if (count <= capacity_) return true;
        allocate(count + count / 4);
        return false;
    }

private:
    void allocate(std::uint32_t count) {
        capacity_ = count;
        // The array begins where its alignment of 16 lets it.
        constexpr std::size_t kArrayOffset = 16;
        const auto size_bytes = static_cast<GLsizeiptr>(kArrayOffset + std::size_t{count} * sizeof(glsl::WarpFragment));
        fragments_ = gl::make_buffer(size_bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    }

    gl::Texture newest_;
    gl::Buffer fragments_;
    std::uint32_t capacity_ = 0;
};

class SurfaceGlMethod final : public WarpMethod {
public:
    SurfaceGlMethod(std::string label, SurfacePrograms programs)
        : label_{std::move(label)}, programs_{std::move(programs)}, vertices_{gl::make_vertex_array()} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        const auto* textures = std::get_if<TexturePixels>(&layer.pixels);
        const auto surface = textures != nullptr ? classify_surfaces(downloaded(*textures), SurfaceUse::gl)
                                                 : classify_surfaces(checked_cpu_pixels(layer), SurfaceUse::gl);
        auto prepared = std::make_shared<PreparedGlSurface>();
        prepared->number = ++prepared_count_;
        PatchList whole_cells;
        PatchList edge_cells;
        for (std::size_t i = 0; i < surface->tiles.surfaces.size(); ++i) {
            split_tile(surface->tiles, i, whole_cells, edge_cells);
        }
        prepared->patches.reserve(surface->blocks.size() + surface->patches.size() + whole_cells.size() +
                                  edge_cells.size() + surface->edges.size());
        append(surface->blocks, prepared->patches);
        append(surface->patches, prepared->patches);
        append(whole_cells, prepared->patches);
        prepared->whole_count = prepared->patches.size();
        append(edge_cells, prepared->patches);
        append(surface->edges, prepared->patches);
        prepared->id_counts = surface->id_counts;
        return prepared;
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        std::shared_ptr<const PreparedLayer> own;
        const auto& prepared = prepared_or_made<PreparedGlSurface>(layer, own);
        source_.bind(layer, target);
        counters_ = bad_pixels(prepared.id_counts, source_.matrices());
        upload(prepared);
        do {
            lists_.begin(target.camera.size_px);
            draw(prepared, target.camera.size_px);
        } while (!lists_.all_fit());
        resolve(target.camera.size_px);
        images_.read(out);
    }

private:
    void upload(const PreparedGlSurface& prepared) {
        if (prepared.number != uploaded_) {
            uploaded_ = prepared.number;
            const std::size_t count = std::max<std::size_t>(prepared.patches.size(), 1);
            if (count > patch_capacity_) {
                patch_capacity_ = count + count / 4;
                patches_ = gl::make_buffer(static_cast<GLsizeiptr>(patch_capacity_ * sizeof(glsl::WarpPatch)), nullptr,
                                           GL_DYNAMIC_STORAGE_BIT);
            }
            const auto size_bytes = static_cast<GLsizeiptr>(prepared.patches.size() * sizeof(glsl::WarpPatch));
            glNamedBufferSubData(patches_.id(), 0, size_bytes, prepared.patches.data());
        }
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, LW_WARP_PATCHES_BINDING, patches_.id());
    }

    void draw(const PreparedGlSurface& prepared, glm::ivec2 size_px) {
        target_.begin(size_px, GlTarget::Writes::linear_light);
        glBindVertexArray(vertices_.id());  // no attributes: the vertex shader fetches its patch
        draw_patches(programs_.opaque, size_px, 0, prepared.whole_count);

        glBindTextureUnit(LW_WARP_DRAWN_COLOUR_UNIT, target_.colour().id());
        glBindTextureUnit(LW_WARP_DRAWN_DEPTH_UNIT, target_.depth().id());
        glBindTextureUnit(LW_WARP_DRAWN_COVERAGE_UNIT, target_.coverage().id());
        // The edges read the depth that was drawn, so nothing may be attached that they could write.
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        glDepthMask(GL_FALSE);
        glDisable(GL_DEPTH_TEST);
        glTextureBarrier();
        draw_patches(programs_.edge, size_px, prepared.whole_count, prepared.patches.size() - prepared.whole_count);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthMask(GL_TRUE);
        glEnable(GL_DEPTH_TEST);
    }

    static void draw_patches(const gl::Program& program, glm::ivec2 size_px, std::size_t first, std::size_t count) {
        program.use();
        program.set("target_size_px", glm::vec2{size_px});
        program.set("first_patch", static_cast<unsigned>(first));
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(kPatchVertices * count));
    }

    void resolve(glm::ivec2 size_px) {
        images_.begin(size_px);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                        GL_TEXTURE_FETCH_BARRIER_BIT);
        programs_.resolve.use();
        programs_.resolve.set("target_size_px", size_px);
        const glm::uvec2 groups = work_groups(size_px);
        glDispatchCompute(groups.x, groups.y, 1);
    }

    std::string label_;
    SurfacePrograms programs_;
    gl::VertexArray vertices_;
    gl::Buffer patches_;
    std::size_t patch_capacity_ = 0;
    std::uint64_t uploaded_ = 0;
    mutable std::atomic<std::uint64_t> prepared_count_{0};
    GlSource source_;
    GlTarget target_;
    FragmentLists lists_;
    GlImages images_;
};

}  // namespace

MadeMethod make_surface_gl_method(std::string label, const MethodSettings& /*settings*/) {
    auto programs = SurfacePrograms::create();
    if (!programs) return programs.error();
    return std::unique_ptr<WarpMethod>{
        std::make_unique<SurfaceGlMethod>(std::move(label), std::move(programs).value())};
}

}  // namespace lw
