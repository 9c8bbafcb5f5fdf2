#include "client_renderer/draw_list.h"

#include <algorithm>

#include "client_renderer/fetch_lines.h"

namespace lw {

namespace {

// What is seen lies scattered over a large scene: each object would be waited for.
constexpr std::size_t kAhead = 8;
// Instances differ in what their clusters cost.
constexpr std::size_t kRunsPerThread = 4;

double distance_to_box_m(const glm::dvec3& place, const scene::Bounds& box) {
    return glm::distance(place, glm::clamp(place, box.min, box.max));
}

/// The range of both and of what lies between.
ClusterRange joined(const ClusterRange& a, const ClusterRange& b) {
    if (a.count == 0) return b;
    if (b.count == 0) return a;
    const std::uint32_t first = std::min(a.first, b.first);
    const std::uint32_t end = std::max(a.first + a.count, b.first + b.count);
    ClusterRange both = a;
    both.first = first;
    both.count = end - first;
    both.include(b);
    return both;
}

}  // namespace

DrawList::DrawList(const PlacedInstances& placed, DrawOrder order) : placed_{placed}, order_{order} {
    for (auto& zone : visible_) {
        for (auto& visible : zone) visible.resize(placed.scene().meshes.size());
    }
}

void DrawList::collect(std::span<const std::uint32_t> visible, const Camera& camera, bool by_clusters) {
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    packed_.clear();
    placed_of_packed_.clear();
    shown_of_packed_.clear();
    tests_.clear();
    words_ = 0;
    for (auto& zone : visible_) {
        for (auto& ranges : zone) std::ranges::fill(ranges, VisibleRange{});
    }
    for (std::size_t i = 0; i < visible.size(); ++i) {
        if (i + kAhead < visible.size()) fetch_lines(&placed_[visible[i + kAhead]]);
        const PlacedInstance& placed = placed_[visible[i]];
        const double distance_m = distance_to_box_m(eye_world, placed.bounds_world);
        const auto zone =
            static_cast<std::size_t>(std::ranges::upper_bound(kZoneEnds_m, distance_m) - kZoneEnds_m.begin());
        collected_[zone][placed.mirrored ? 1 : 0].push_back(visible[i]);
        const int mesh = placed.mesh;
        const bool last_of_mesh = i + 1 == visible.size() || placed_[visible[i + 1]].mesh != mesh;
        if (last_of_mesh) end_mesh(static_cast<std::size_t>(mesh), eye_world, by_clusters);
    }
}

void DrawList::end_mesh(std::size_t mesh, const glm::dvec3& eye_world, bool by_clusters) {
    const std::size_t words = by_clusters ? Clusters::words_for(clusters_of_meshes_[mesh]) : 0;
    for (std::size_t zone = 0; zone < kZones; ++zone) {
        for (std::size_t mirrored = 0; mirrored < 2; ++mirrored) {
            std::vector<std::uint32_t>& collected = collected_[zone][mirrored];
            visible_[zone][mirrored][mesh] = {static_cast<std::uint32_t>(packed_.size()),
                                              static_cast<std::uint32_t>(collected.size())};
            for (const std::uint32_t index : collected) {
                const PlacedInstance& placed = placed_[index];
                packed_.push_back(packed_instance(placed.world_from_object, eye_world, placed.mover));
                placed_of_packed_.push_back(index);
                shown_of_packed_.push_back(static_cast<std::uint32_t>(words_));
                if (words > 0) tests_.push_back({index, static_cast<std::uint32_t>(words_)});
                words_ += words;
            }
            collected.clear();
        }
    }
}

void DrawList::build(std::span<const std::uint32_t> visible, const Camera& camera,
                     std::span<const std::vector<MeshPart>> batches, const ClusterUse& clusters) {
    if (clusters.clusters != nullptr) {
        clusters.clusters->begin(clusters.view);
        find_clusters_of_meshes(batches);
    }
    collect(visible, camera, clusters.clusters != nullptr);
    cluster_counters_ = {};
    if (!tests_.empty()) test_clusters(clusters);
    commands_.clear();
    ranges_.clear();
    triangles_drawn_ = 0;
    states_.clear();
    if (!order_.grouped) return append_by_distance(camera, batches, clusters);
    for (std::size_t zone = 0; zone < kZones; ++zone) append_ranges(zone, batches, clusters);
}

// In runs of about equally many clusters.
void DrawList::test_clusters(const ClusterUse& clusters) {
    shown_.assign(words_, 0);
    tested_ = clusters.clusters;
    const std::size_t count =
        clusters.threads == nullptr ? 1 : kRunsPerThread * static_cast<std::size_t>(clusters.threads->threads());
    test_runs_.assign(count, {});
    const auto first_of = [&](std::size_t run) {
        const auto word = static_cast<std::uint32_t>(words_ * run / count);
        return static_cast<std::size_t>(std::ranges::lower_bound(tests_, word, {}, &ClusterTest::first_word) -
                                        tests_.begin());
    };
    for (std::size_t i = 0; i < count; ++i)
        test_runs_[i] = {first_of(i), i + 1 == count ? tests_.size() : first_of(i + 1), {}};
    if (clusters.threads == nullptr) {
        test_run(*tested_, test_runs_.front());
    } else {
        clusters.threads->run(static_cast<int>(count), test_run_);
    }
    for (const TestRun& run : test_runs_) cluster_counters_ += run.counters;
}

void DrawList::test_run(const Clusters& clusters, TestRun& run) {
    ClusterCounters counters;  // its own: neighbouring runs' would lie in one cache line
    for (std::size_t i = run.first; i < run.end; ++i) {
        const PlacedInstance& placed = placed_[tests_[i].placed];
        const ClusterRange& range = clusters_of_meshes_[static_cast<std::size_t>(placed.mesh)];
        clusters.test(range, placed.world_from_object,
                      std::span{shown_}.subspan(tests_[i].first_word, Clusters::words_for(range)), counters);
    }
    run.counters = counters;
}

void DrawList::find_clusters_of_meshes(std::span<const std::vector<MeshPart>> batches) {
    if (!clusters_of_meshes_.empty()) return;
    clusters_of_meshes_.resize(placed_.scene().meshes.size());
    for (const std::vector<MeshPart>& parts : batches) {
        for (const MeshPart& part : parts) {
            ClusterRange& mesh = clusters_of_meshes_[static_cast<std::size_t>(part.mesh)];
            mesh = joined(mesh, part.clusters);
        }
    }
}

void DrawList::append_by_distance(const Camera& camera, std::span<const std::vector<MeshPart>> batches,
                                  const ClusterUse& clusters) {
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    by_distance_.clear();
    for (std::uint32_t i = 0; i < placed_of_packed_.size(); ++i) {
        by_distance_.emplace_back(distance_to_box_m(eye_world, placed_[placed_of_packed_[i]].bounds_world), i);
    }
    std::ranges::sort(by_distance_);
    if (parts_of_meshes_.empty()) {
        parts_of_meshes_.resize(placed_.scene().meshes.size());
        for (std::uint32_t batch = 0; batch < batches.size(); ++batch) {
            for (const MeshPart& part : batches[batch]) {
                parts_of_meshes_[static_cast<std::size_t>(part.mesh)].emplace_back(batch, part);
            }
        }
    }
    for (const auto& [distance_m, packed] : by_distance_) {
        const PlacedInstance& placed = placed_[placed_of_packed_[packed]];
        for (const auto& [batch, part] : parts_of_meshes_[static_cast<std::size_t>(placed.mesh)]) {
            append_part(part, {packed, 1}, clusters);
            states_.resize(commands_.size(), 2 * batch + (placed.mirrored ? 1 : 0));
        }
    }
    pass_through_buffer();
}

void DrawList::pass_through_buffer() {
    arrived_.swap(commands_);
    commands_.clear();
    for (const std::uint32_t draw : sorted_through_buffer(states_, order_.strategy, order_.capacity)) {
        const auto batch = static_cast<int>(states_[draw] / 2);
        const bool mirrored = states_[draw] % 2 == 1;
        if (ranges_.empty() || ranges_.back().batch != batch || ranges_.back().mirrored != mirrored) {
            ranges_.push_back({batch, mirrored, commands_.size(), 0});
        }
        commands_.push_back(arrived_[draw]);
        ++ranges_.back().command_count;
    }
}

void DrawList::append_part(const MeshPart& part, const VisibleRange& visible, const ClusterUse& clusters) {
    if (clusters.clusters == nullptr || part.clusters.count == 0) {
        commands_.push_back({part.index_count, visible.count, part.first_index, part.base_vertex, visible.first});
        triangles_drawn_ += std::uint64_t{part.index_count / 3} * visible.count;
        return;
    }
    for (std::uint32_t i = visible.first; i < visible.first + visible.count; ++i) {
        runs_.clear();
        const std::uint32_t first_of_mesh = clusters_of_meshes_[static_cast<std::size_t>(part.mesh)].first;
        clusters.clusters->append_runs(part.clusters, std::span{shown_}.subspan(shown_of_packed_[i]),
                                       part.clusters.first - first_of_mesh, runs_);
        for (const IndexRun& run : runs_) {
            commands_.push_back({run.count, 1, part.first_index + run.first, part.base_vertex, i});
            triangles_drawn_ += run.count / 3;
        }
    }
}

void DrawList::append_ranges(std::size_t zone, std::span<const std::vector<MeshPart>> batches,
                             const ClusterUse& clusters) {
    for (std::size_t batch = 0; batch < batches.size(); ++batch) {
        for (const bool mirrored : {false, true}) {
            DrawRange range{static_cast<int>(batch), mirrored, commands_.size(), 0};
            for (const MeshPart& part : batches[batch]) {
                const auto mesh = static_cast<std::size_t>(part.mesh);
                const VisibleRange& visible = visible_[zone][mirrored ? 1 : 0][mesh];
                if (visible.count == 0) continue;
                append_part(part, visible, clusters);
            }
            range.command_count = commands_.size() - range.first_command;
            if (range.command_count > 0) ranges_.push_back(range);
        }
    }
}

}  // namespace lw
