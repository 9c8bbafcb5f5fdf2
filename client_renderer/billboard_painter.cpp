#include "client_renderer/billboard_painter.h"

#include <cstddef>

#include "client_renderer/packed_vertex.h"
#include "gl/stream_buffer.h"
#include "shaders/billboard_blocks.h"

namespace lw {

namespace {

/// The array of the G-buffer pass with longer instances that also carry a view.
gl::VertexArray make_view_array(const GpuScene& gpu_scene, const gl::Buffer& views) {
    gl::VertexArray array =
        make_vertex_array(gpu_scene.surface_vertices(), gpu_scene.texture_vertices(), views, gpu_scene.indices());
    const GLuint id = array.id();
    constexpr GLuint kInstances = 2;  // the stream of make_vertex_array() that holds them
    glVertexArrayVertexBuffer(id, kInstances, views.id(), 0, sizeof(PackedView));
    const std::pair<int, std::size_t> rows[] = {{shader::kAttributeViewX, offsetof(PackedView, clip_x)},
                                                {shader::kAttributeViewY, offsetof(PackedView, clip_y)},
                                                {shader::kAttributeViewW, offsetof(PackedView, clip_w)}};
    for (const auto& [location, offset] : rows) {
        const auto attribute = static_cast<GLuint>(location);
        glEnableVertexArrayAttrib(id, attribute);
        glVertexArrayAttribFormat(id, attribute, 4, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
        glVertexArrayAttribBinding(id, attribute, kInstances);
    }
    return array;
}

}  // namespace

BillboardPainter::BillboardPainter(const scene::Scene& scene, const scene::SceneState& state, const GpuScene& gpu_scene)
    : scene_{scene},
      state_{state},
      gpu_scene_{gpu_scene},
      views_{gl::make_stream_buffer()},
      commands_{gl::make_stream_buffer()} {
    gl::replace(views_, std::vector<PackedView>(1));
    vertex_array_ = make_view_array(gpu_scene, views_);
    for (std::vector<Range>& ranges : ranges_) ranges.resize(scene.meshes.size());
}

std::uint64_t BillboardPainter::triangles_of(std::uint32_t instance) const {
    const auto mesh = static_cast<std::size_t>(scene_.instances[instance].mesh);
    return scene_.meshes[mesh].indices.size() / 3;
}

void BillboardPainter::pack(std::span<const PaintedView> views, const glm::dvec3& eye_world) {
    // By mesh, so that one command draws all views of a mesh.
    std::array<std::vector<std::vector<PackedView>>, 2> by_mesh;
    for (auto& meshes : by_mesh) meshes.resize(scene_.meshes.size());
    for (const PaintedView& view : views) {
        const scene::Instance& instance = scene_.instances[view.instance];
        const glm::dmat4 world_from_object = state_.world_from_object(instance);
        const bool mirrored = glm::determinant(glm::dmat3{world_from_object}) < 0.0;
        by_mesh[mirrored ? 1 : 0][static_cast<std::size_t>(instance.mesh)].push_back(
            {packed_instance(world_from_object, eye_world, instance.mover), view.clip_x, view.clip_y, view.clip_w});
    }
    packed_.clear();
    for (std::size_t mirrored = 0; mirrored < 2; ++mirrored) {
        for (std::size_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
            const std::vector<PackedView>& of_mesh = by_mesh[mirrored][mesh];
            ranges_[mirrored][mesh] = {static_cast<std::uint32_t>(packed_.size()),
                                       static_cast<std::uint32_t>(of_mesh.size())};
            packed_.insert(packed_.end(), of_mesh.begin(), of_mesh.end());
        }
    }
}

std::uint64_t BillboardPainter::submit() {
    struct BatchRange {
        std::size_t batch;
        bool mirrored;
        std::size_t first_command;
        std::size_t command_count;
    };
    std::vector<BatchRange> batch_ranges;
    std::uint64_t triangles = 0;
    command_list_.clear();
    for (std::size_t batch = 0; batch < gpu_scene_.parts().size(); ++batch) {
        for (const bool mirrored : {false, true}) {
            const std::size_t first = command_list_.size();
            for (const MeshPart& part : gpu_scene_.parts()[batch]) {
                const Range& range = ranges_[mirrored ? 1 : 0][static_cast<std::size_t>(part.mesh)];
                if (range.count == 0) continue;
                command_list_.push_back(
                    {part.index_count, range.count, part.first_index, part.base_vertex, range.first});
                triangles += std::uint64_t{part.index_count / 3} * range.count;
            }
            if (command_list_.size() > first) {
                batch_ranges.push_back({batch, mirrored, first, command_list_.size() - first});
            }
        }
    }
    gl::replace(views_, packed_);
    gl::replace(commands_, command_list_);
    glBindVertexArray(vertex_array_.id());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.id());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    for (const BatchRange& range : batch_ranges) {
        gpu_scene_.bind(gpu_scene_.batches()[range.batch], GpuScene::Into::billboards);
        glFrontFace(range.mirrored ? GL_CW : GL_CCW);
        glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                    gl::buffer_offset(range.first_command * sizeof(DrawCommand)),
                                    static_cast<GLsizei>(range.command_count), 0);
    }
    glFrontFace(GL_CCW);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
    glBindVertexArray(0);
    return triangles;
}

std::uint64_t BillboardPainter::paint(std::span<const PaintedView> views, const glm::dvec3& eye_world) {
    pack(views, eye_world);
    return submit();
}

}  // namespace lw
