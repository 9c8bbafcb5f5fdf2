#pragma once
/// Edges beside holes: what a surface leaves of a pixel shows what the fill makes of the hole.

#include <cstdint>
#include <vector>

#include "core/task_pool.h"
#include "warp_server/warp_method.h"

namespace lw {

/// One thread at a time. No allocation once sizes are seen.
class PartCover {
public:
    /// @param threads  may be used too, and gives the same picture; null: the caller's alone. Outlives this
    explicit PartCover(TaskPool* threads = nullptr);
    PartCover(const PartCover&) = delete;
    PartCover& operator=(const PartCover&) = delete;

    /// Before the fill: pixels that are covered in part become holes, so that the fill says what is behind them. Those
    /// that another layer has covered since stay as they are, and their share becomes 0.
    void open(DisplayFrame& frame);

    /// After the fill: the surfaces of those pixels over what was filled, by their share, in linear light. What is
    /// covered by half or more is `reached` and has the surface's depth, the rest stays `filled`.
    void close(DisplayFrame& frame);

    /// Pixel numbers [begin, end).
    struct Pixels {
        std::uint32_t begin;
        std::uint32_t end;

        [[nodiscard]] bool holds(std::uint32_t pixel) const { return pixel >= begin && pixel < end; }
    };

private:
    void run(DisplayFrame& frame, const TaskPool::Work& work);
    [[nodiscard]] Pixels share_of(int task) const {
        return {borders_[static_cast<std::size_t>(task)], borders_[static_cast<std::size_t>(task) + 1]};
    }

    TaskPool* threads_;
    DisplayFrame* frame_ = nullptr;
    // Tasks share out the pixels of the picture, because layers may have left several entries of one pixel, which stay
    // in order: task i has those from pixel borders_[i] on.
    std::vector<std::uint32_t> borders_;
    // Kept, because making a function object may allocate.
    TaskPool::Work open_share_;
    TaskPool::Work close_share_;
};

}  // namespace lw
