#include "client_renderer/layer_pool.h"

namespace lw {

LayerPool::LayerPool() : shelf_{std::make_shared<Shelf>()} { shelf_->free.reserve(kMostFree); }

std::shared_ptr<Layer> LayerPool::acquire() {
    std::unique_ptr<Layer> layer;
    {
        const std::lock_guard lock{shelf_->mutex};
        if (!shelf_->free.empty()) {
            layer = std::move(shelf_->free.back());
            shelf_->free.pop_back();
        }
    }
    if (!layer) layer = std::make_unique<Layer>();
    layer->name = "main";
    layer->empty_pixels = 0;
    layer->content = {};
    const auto give_back = [weak = std::weak_ptr<Shelf>{shelf_}](Layer* returned) {
        std::unique_ptr<Layer> owned{returned};
        // Textures belong to a context that may not be current wherever the layer comes back: they go with the layer.
        if (!std::holds_alternative<CpuPixels>(owned->pixels)) return;
        owned->prepared.clear();
        const std::shared_ptr<Shelf> shelf = weak.lock();
        if (!shelf) return;
        const std::lock_guard lock{shelf->mutex};
        if (shelf->free.size() < kMostFree) shelf->free.push_back(std::move(owned));
    };
    return {layer.release(), give_back};
}

std::size_t LayerPool::free_count() const {
    const std::lock_guard lock{shelf_->mutex};
    return shelf_->free.size();
}

}  // namespace lw
