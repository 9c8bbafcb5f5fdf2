#pragma once
/// A scene's meshes, materials and textures in GL buffers, grouped into batches of equal state.

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "billboard_lod/billboard_atlas.h"
#include "client_renderer/clusters.h"
#include "client_renderer/draw_list.h"
#include "client_renderer/surface_features.h"
#include "client_renderer/texture_store.h"
#include "core/result.h"
#include "gl/program.h"
#include "scene/scene.h"

namespace lw {

/// What one draw call shares: program, material, textures.
struct SurfaceBatch {
    SurfaceFeatures features;
    int material = scene::kNone;      ///< kNone: glTF's default material
    std::ptrdiff_t block_offset = 0;  ///< of its MaterialBlock in the material buffer
    const gl::Program* program = nullptr;
    const gl::Program* billboard_program = nullptr;  ///< draws into a billboard's slot; null without billboards
    const gl::Program* part_program = nullptr;       ///< leaves out what is not in a part of the scene; null without
};

/// Immutable once made. Belongs to one GL context and its thread.
class GpuScene {
public:
    /// Uploads meshes, materials and textures and compiles the shader variants that the materials need. `scene` is
    /// finished and outlives it. A shader that does not compile is an error.
    [[nodiscard]] static Result<std::unique_ptr<GpuScene>> create(const scene::Scene& scene);

    /// Compiles the variants that draw into atlases of this format. Once, before billboards are painted.
    [[nodiscard]] Status add_billboard_programs(AtlasFormat format);

    /// Compiles the variants that draw a part of the scene (ScenePart), if they are not there yet.
    [[nodiscard]] Status add_part_programs();

    /// What a batch is drawn into; a part's picture is a G-buffer without what is not in the part.
    enum class Into : std::uint8_t { gbuffer, billboards, part };

    [[nodiscard]] const std::vector<SurfaceBatch>& batches() const { return batches_; }
    /// Mesh parts by batch, as DrawList takes them.
    [[nodiscard]] const std::vector<std::vector<MeshPart>>& parts() const { return parts_; }

    /// Of the parts.
    [[nodiscard]] Clusters& clusters() const { return *clusters_; }

    [[nodiscard]] const gl::Buffer& surface_vertices() const { return surface_vertices_; }
    [[nodiscard]] const gl::Buffer& texture_vertices() const { return texture_vertices_; }
    [[nodiscard]] const gl::Buffer& indices() const { return indices_; }

    /// Makes program, material block, textures and face culling current for a batch.
    void bind(const SurfaceBatch& batch, Into into = Into::gbuffer) const;

private:
    explicit GpuScene(const scene::Scene& scene) : scene_{scene}, textures_{scene} {}

    void upload_meshes();
    /// Puts the indices of a mesh (a copy) in the order of its clusters.
    void cluster(const scene::Mesh& mesh, std::span<std::uint32_t> indices);
    void collect_batches();
    void upload_materials();
    using Programs = std::map<SurfaceFeatures, gl::Program>;
    /// Compiles a variant of every batch's program; `variant` is more preprocessor lines.
    [[nodiscard]] Status compile(const std::string& variant, Programs& programs,
                                 const gl::Program* SurfaceBatch::*program_of_batch);
    [[nodiscard]] const scene::Material& material_of(const SurfaceBatch& batch) const;

    const scene::Scene& scene_;
    scene::Material default_material_;
    TextureStore textures_;
    gl::Buffer surface_vertices_;
    gl::Buffer texture_vertices_;
    gl::Buffer indices_;
    gl::Buffer materials_;
    std::vector<std::uint32_t> first_vertex_;  ///< by mesh
    std::vector<std::uint32_t> first_index_;   ///< by mesh
    std::unique_ptr<Clusters> clusters_ = std::make_unique<Clusters>();
    std::vector<std::vector<ClusterRange>> clusters_of_primitives_;  ///< by mesh and primitive
    Programs programs_;
    Programs billboard_programs_;
    Programs part_programs_;
    std::vector<SurfaceBatch> batches_;
    std::vector<std::vector<MeshPart>> parts_;
};

}  // namespace lw
