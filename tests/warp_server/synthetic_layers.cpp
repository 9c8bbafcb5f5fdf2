#include "tests/warp_server/synthetic_layers.h"

#include <random>
#include <string>

#include "core/check.h"

namespace lw::test {
namespace {

Layer empty_layer(const Camera& camera) {
    Layer layer;
    layer.camera = camera;
    layer.pixels = CpuPixels{ColourImage{camera.size_px}, DepthImage{camera.size_px}, ObjectIdImage{camera.size_px}};
    return layer;
}

}  // namespace

Rgba8 colour_of_index(std::uint32_t index) {
    return {static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8U),
            static_cast<std::uint8_t>(index >> 16U), 255};
}

std::uint32_t index_of_colour(Rgba8 colour) {
    return std::uint32_t{colour.r} | (std::uint32_t{colour.g} << 8U) | (std::uint32_t{colour.b} << 16U);
}

void colour_by_index(Layer& layer) {
    std::uint32_t index = 0;
    for (Rgba8& colour : layer.cpu().colour.pixels()) colour = colour_of_index(index++);
}

Layer indexed_layer(const Camera& camera, float depth) {
    Layer layer = empty_layer(camera);
    for (float& value : layer.cpu().depth.pixels()) value = depth;
    colour_by_index(layer);
    return layer;
}

Layer noise_layer(const Camera& camera) {
    Layer layer = empty_layer(camera);
    std::mt19937 random{7};  // the raw generator is the same everywhere, distributions are not
    for (Rgba8& colour : layer.cpu().colour.pixels()) colour = colour_of_index(random() & 0xFFFFFFU);
    for (float& depth : layer.cpu().depth.pixels()) {
        const auto value = random() & 0xFFFFU;
        depth = value < 0x2000U ? 0.0F : static_cast<float>(value) / 65535.0F;
    }
    return layer;
}

std::unique_ptr<WarpMethod> method_named(std::string_view specification) {
    Result<std::unique_ptr<WarpMethod>> method = make_warp_method(specification);
    LW_CHECK(method.ok(), method.ok() ? std::string{} : method.error().message());
    return std::move(*method);
}

DisplayFrame warp_once(std::string_view specification, const Layer& layer, const WarpTarget& target) {
    DisplayFrame frame;
    method_named(specification)->warp(layer, target, frame);
    return frame;
}

}  // namespace lw::test
