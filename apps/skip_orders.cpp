#include "apps/skip_orders.h"

#include <algorithm>
#include <set>
#include <span>

#include "client_renderer/culling.h"
#include "client_renderer/draw_list.h"
#include "client_renderer/gpu_scene.h"

namespace lw {

namespace {

constexpr std::size_t kPieceDraws = 40;
constexpr std::size_t kMostPieces = 12;
// The search takes seconds beyond this.
constexpr std::size_t kLargestSearched = 8;

Result<std::vector<std::uint32_t>> arriving_states(const scene::Scene& scene) {
    auto gpu_scene = GpuScene::create(scene);
    if (!gpu_scene) return gpu_scene.error();
    scene::SceneState state{scene};
    state.set_time(0.0);
    const PlacedInstances placed{scene, state};
    Culling culling{placed, {}};
    Camera camera;
    camera.size_px = {1024, 1024};
    camera.world_from_eye = scene.start_pose.value_or(Pose{});
    DrawList list{placed, {.grouped = false}};
    list.build(culling.visible(camera), camera, (*gpu_scene)->parts());
    return list.arriving_states();
}

BufferChanges changes_with(std::span<const std::uint32_t> states, std::size_t capacity) {
    BufferChanges result;
    result.capacity = capacity;
    result.draws = states.size();
    result.states = std::set<std::uint32_t>(states.begin(), states.end()).size();
    result.piece_draws = kPieceDraws;
    const std::size_t strategies = sorting_strategy_names().size();
    result.changes.resize(strategies);
    result.piece_changes.resize(strategies);
    for (std::size_t s = 0; s < strategies; ++s) {
        const auto strategy = static_cast<SortingStrategy>(s);
        result.changes[s] = state_changes(states, sorted_through_buffer(states, strategy, capacity));
    }
    if (capacity > kLargestSearched) return result;
    for (std::size_t piece = 0; piece < kMostPieces && (piece + 1) * kPieceDraws <= states.size(); ++piece) {
        const auto part = states.subspan(piece * kPieceDraws, kPieceDraws);
        result.piece_fewest += fewest_state_changes(part, capacity);
        for (std::size_t s = 0; s < strategies; ++s) {
            const auto strategy = static_cast<SortingStrategy>(s);
            result.piece_changes[s] += state_changes(part, sorted_through_buffer(part, strategy, capacity));
        }
    }
    return result;
}

}  // namespace

const std::vector<std::string>& sorting_strategy_names() {
    static const std::vector<std::string> names{"none", "lru", "bounded-waste", "random", "round-robin"};
    return names;
}

Result<std::vector<BufferChanges>> compare_buffers(const scene::Scene& scene) {
    const auto states = arriving_states(scene);
    if (!states) return states.error();
    std::vector<BufferChanges> all;
    for (const std::size_t capacity : {2U, 4U, 8U, 16U, 32U, 64U, 128U}) {
        all.push_back(changes_with(*states, capacity));
    }
    return all;
}

}  // namespace lw
