#include "scene/gltf_triangles.h"

#include "scene/gltf_refusal.h"

namespace lw::scene {
namespace {

enum Mode : int { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

}  // namespace

bool draws_triangles(int mode, const std::string& place) {
    if (mode < points || mode > triangle_fan) refuse(fmt::format("{} is not a primitive mode", mode), place);
    return mode >= triangles;
}

std::vector<std::uint32_t> triangle_list(int mode, std::vector<std::uint32_t> corners) {
    if (corners.size() < 3) return {};
    if (mode == triangles) {
        corners.resize(corners.size() - corners.size() % 3);
        return corners;
    }
    std::vector<std::uint32_t> list;
    list.reserve(3 * (corners.size() - 2));
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
        if (mode == triangle_fan) {
            list.insert(list.end(), {corners[i + 1], corners[i + 2], corners[0]});
        } else {
            // Every other triangle of a strip is turned (glTF 2.0, 3.7.2.1).
            const std::size_t odd = i % 2;
            list.insert(list.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
        }
    }
    return list;
}

}  // namespace lw::scene
