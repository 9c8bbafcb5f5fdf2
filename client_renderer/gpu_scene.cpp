#include "client_renderer/gpu_scene.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "shaders/client_blocks.h"

namespace lw {

namespace {

// GL wants storage of at least one byte also for a scene without meshes.
template <class T>
gl::Buffer static_buffer(std::vector<T>& elements) {
    if (elements.empty()) elements.resize(1);
    return gl::make_buffer(static_cast<GLsizeiptr>(elements.size() * sizeof(T)), elements.data(), 0);
}

bool has_vertex_colours(const scene::Mesh& mesh) {
    return std::ranges::any_of(mesh.vertices, [](const scene::Vertex& v) { return v.colour != Rgba8{}; });
}

shader::MaterialBlock block_of(const scene::Material& material) {
    shader::MaterialBlock block{};
    block.base_colour = material.base_colour;
    block.emissive = glm::vec4{material.emissive, material.unlit ? 1.0f : 0.0f};
    block.factors = {material.metallic, material.roughness, material.normal_scale,
                     material.alpha_cutoff.value_or(0.0f)};
    const std::pair<int, const scene::TextureUse*> uses[] = {
        {shader::kUnitBaseColour, &material.base_colour_texture},
        {shader::kUnitMetallicRoughness, &material.metallic_roughness_texture},
        {shader::kUnitNormal, &material.normal_texture},
        {shader::kUnitEmissive, &material.emissive_texture}};
    for (const auto& [unit, use] : uses) {
        for (int row = 0; row < 2; ++row) {
            for (int column = 0; column < 3; ++column) {
                block.uv_rows[2 * unit + row][column] = use->uv_transform[column][row];
            }
        }
    }
    return block;
}

}  // namespace

Result<std::unique_ptr<GpuScene>> GpuScene::create(const scene::Scene& scene) {
    std::unique_ptr<GpuScene> gpu_scene{new GpuScene{scene}};
    gpu_scene->upload_meshes();
    gpu_scene->collect_batches();
    gpu_scene->upload_materials();
    const Status compiled = gpu_scene->compile("", gpu_scene->programs_, &SurfaceBatch::program);
    if (!compiled.ok()) return compiled.error();
    return gpu_scene;
}

void GpuScene::upload_meshes() {
    std::vector<PackedSurfaceVertex> surface;
    std::vector<PackedTextureVertex> texture;
    std::vector<std::uint32_t> indices;
    for (const scene::Mesh& mesh : scene_.meshes) {
        first_vertex_.push_back(static_cast<std::uint32_t>(surface.size()));
        first_index_.push_back(static_cast<std::uint32_t>(indices.size()));
        for (const scene::Vertex& vertex : mesh.vertices) {
            surface.push_back(pack_surface(vertex));
            texture.push_back(pack_texture(vertex));
        }
        indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
        cluster(mesh, std::span{indices}.subspan(first_index_.back()));
    }
    clusters_->finish();
    surface_vertices_ = static_buffer(surface);
    texture_vertices_ = static_buffer(texture);
    indices_ = static_buffer(indices);
}

void GpuScene::cluster(const scene::Mesh& mesh, std::span<std::uint32_t> indices) {
    std::vector<ClusterRange>& ranges = clusters_of_primitives_.emplace_back();
    clusters_->begin_mesh();
    for (const scene::Primitive& primitive : mesh.primitives) {
        SurfaceBatch batch;
        batch.material = primitive.material;
        ranges.push_back(clusters_->add(mesh.vertices, indices.subspan(primitive.first_index, primitive.index_count),
                                        material_of(batch).double_sided));
    }
}

void GpuScene::collect_batches() {
    std::map<std::tuple<SurfaceFeatures, int>, std::vector<MeshPart>> parts_by_state;
    for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
        const scene::Mesh& mesh = scene_.meshes[m];
        const bool vertex_colour = has_vertex_colours(mesh);
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& primitive = mesh.primitives[p];
            if (primitive.index_count == 0) continue;
            SurfaceBatch batch;
            batch.material = primitive.material;
            const SurfaceFeatures features = features_of(material_of(batch), vertex_colour, textures_.has_image());
            parts_by_state[{features, primitive.material}].push_back(
                {static_cast<int>(m), primitive.index_count, first_index_[m] + primitive.first_index,
                 static_cast<std::int32_t>(first_vertex_[m]), clusters_of_primitives_[m][p]});
        }
    }
    for (auto& [state, parts] : parts_by_state) {
        batches_.push_back({std::get<0>(state), std::get<1>(state), 0, nullptr});
        parts_.push_back(std::move(parts));
    }
}

void GpuScene::upload_materials() {
    GLint alignment = 1;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    const auto unit = static_cast<std::size_t>(std::max(alignment, 1));
    const std::size_t stride = (sizeof(shader::MaterialBlock) + unit - 1) / unit * unit;
    const auto size_bytes = static_cast<GLsizeiptr>(stride * std::max<std::size_t>(batches_.size(), 1));
    materials_ = gl::make_buffer(size_bytes, nullptr, GL_DYNAMIC_STORAGE_BIT);
    for (std::size_t b = 0; b < batches_.size(); ++b) {
        const shader::MaterialBlock block = block_of(material_of(batches_[b]));
        batches_[b].block_offset = static_cast<std::ptrdiff_t>(b * stride);
        glNamedBufferSubData(materials_.id(), batches_[b].block_offset, sizeof block, &block);
    }
}

Status GpuScene::compile(const std::string& variant, Programs& programs,
                         const gl::Program* SurfaceBatch::*program_of_batch) {
    for (SurfaceBatch& batch : batches_) {
        gl::Program& program = programs[batch.features];
        if (!program) {
            auto made = gl::Program::create({"client/gbuffer.vert", "client/gbuffer.frag"},
                                            defines_of(batch.features) + variant);
            if (!made.ok()) return made.error();
            program = std::move(*made);
        }
        batch.*program_of_batch = &program;
    }
    return Done{};
}

Status GpuScene::add_billboard_programs(AtlasFormat format) {
    return compile(std::string{"#define BILLBOARD\n"}.append(lw::defines_of(format)), billboard_programs_,
                   &SurfaceBatch::billboard_program);
}

Status GpuScene::add_part_programs() { return compile("#define PART\n", part_programs_, &SurfaceBatch::part_program); }

const scene::Material& GpuScene::material_of(const SurfaceBatch& batch) const {
    return batch.material == scene::kNone ? default_material_
                                          : scene_.materials[static_cast<std::size_t>(batch.material)];
}

void GpuScene::bind(const SurfaceBatch& batch, Into into) const {
    const scene::Material& material = material_of(batch);
    const SurfaceFeatures& features = batch.features;
    const gl::Program* const programs[] = {batch.program, batch.billboard_program, batch.part_program};
    programs[static_cast<std::size_t>(into)]->use();
    glBindBufferRange(GL_UNIFORM_BUFFER, shader::kBindingMaterial, materials_.id(), batch.block_offset,
                      sizeof(shader::MaterialBlock));
    if (features.base_colour_texture) textures_.bind(material.base_colour_texture, true, shader::kUnitBaseColour);
    if (features.metallic_roughness_texture) {
        textures_.bind(material.metallic_roughness_texture, false, shader::kUnitMetallicRoughness);
    }
    if (features.normal_texture) textures_.bind(material.normal_texture, false, shader::kUnitNormal);
    if (features.emissive_texture) textures_.bind(material.emissive_texture, true, shader::kUnitEmissive);
    if (features.double_sided) {
        glDisable(GL_CULL_FACE);
    } else {
        glEnable(GL_CULL_FACE);
    }
}

}  // namespace lw
