#pragma once
/// Layers whose pixel memory is used again: at 1024x1024 fresh memory costs 10 MB of page faults per frame.

#include <memory>
#include <mutex>
#include <vector>

#include "frame_link/rendered_frame.h"

namespace lw {

/// Hands out layers and takes them back when their last reference is dropped, on whatever thread that happens. A layer
/// may outlive the pool; then it is simply destroyed.
class LayerPool {
public:
    LayerPool();

    /// A layer without prepared parts whose pixels may hold old contents. Any thread.
    [[nodiscard]] std::shared_ptr<Layer> acquire();

    /// Layers waiting to be used again. Any thread.
    [[nodiscard]] std::size_t free_count() const;

private:
    // The exchange holds up to three frames, and one more is being drawn; each may have two layers.
    static constexpr std::size_t kMostFree = 8;

    struct Shelf {
        std::mutex mutex;
        std::vector<std::unique_ptr<Layer>> free;
    };
    std::shared_ptr<Shelf> shelf_;
};

}  // namespace lw
