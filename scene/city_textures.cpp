#include "scene/city_textures.h"

#include <algorithm>
#include <cmath>

#include "scene/random.h"

namespace lw::scene {

namespace {

/// sRGB in [0, 255].
using Srgb = glm::dvec3;

/// Random number in [0, 1) of a lattice cell.
double cell_noise(int x, int y, std::uint32_t layer) {
    const std::uint64_t key = (static_cast<std::uint64_t>(layer) << 48) ^
                              (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 24) ^
                              static_cast<std::uint64_t>(static_cast<std::uint32_t>(y));
    return static_cast<double>(scrambled(key + 0x9E3779B97F4A7C15ull) >> 40) * 0x1.0p-24;
}

int wrapped(int i, int period) { return ((i % period) + period) % period; }

/// Smooth noise in [-1, 1] of a point in cells; repeats after `period` cells on both axes.
double value_noise(double x, double y, int period_x, int period_y, std::uint32_t layer) {
    const double fx = std::floor(x);
    const double fy = std::floor(y);
    const double tx = x - fx;
    const double ty = y - fy;
    const int x0 = wrapped(static_cast<int>(fx), period_x);
    const int y0 = wrapped(static_cast<int>(fy), period_y);
    const int x1 = (x0 + 1) % period_x;
    const int y1 = (y0 + 1) % period_y;
    const double sx = tx * tx * (3.0 - 2.0 * tx);
    const double sy = ty * ty * (3.0 - 2.0 * ty);
    const double top = cell_noise(x0, y0, layer) * (1.0 - sx) + cell_noise(x1, y0, layer) * sx;
    const double bottom = cell_noise(x0, y1, layer) * (1.0 - sx) + cell_noise(x1, y1, layer) * sx;
    return 2.0 * (top * (1.0 - sy) + bottom * sy) - 1.0;
}

/// Octaves from `cells` per texture side up, each half as strong; (u, v) in [0, 1). About [-1, 1].
double octaves(double u, double v, int cells, int count, std::uint32_t layer) {
    double sum = 0.0;
    double weight = 0.5;
    for (int i = 0; i < count; ++i) {
        sum += weight * value_noise(u * cells, v * cells, cells, cells, layer + static_cast<std::uint32_t>(i));
        cells *= 2;
        weight *= 0.6;
    }
    return sum;
}

template <class ColourAt>
ColourImage painted(int size_px, const ColourAt& colour_at) {
    ColourImage image{glm::ivec2{size_px}};
    const auto byte = [](double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5); };
    for (int y = 0; y < size_px; ++y) {
        for (int x = 0; x < size_px; ++x) {
            const Srgb c = colour_at((x + 0.5) / size_px, (y + 0.5) / size_px);
            image.at(x, y) = {byte(c.x), byte(c.y), byte(c.z), 255};
        }
    }
    return image;
}

/// 0 in the joint around a cell, 1 inside; (u, v) inside the cell in [0, 1], the rest as fractions of it.
double inside_joint(double u, double v, double joint_u, double joint_v, double softness) {
    const double du = (std::min(u, 1.0 - u) - joint_u) / softness;
    const double dv = (std::min(v, 1.0 - v) - joint_v) / softness;
    return std::clamp(std::min(du, dv), 0.0, 1.0);
}

Srgb mixed(const Srgb& a, const Srgb& b, double t) { return a + (b - a) * t; }

}  // namespace

ColourImage plaster_texture() {
    return painted(256, [](double u, double v) {
        const double stains = octaves(u, v, 3, 4, 10);
        const double grain = cell_noise(static_cast<int>(u * 256), static_cast<int>(v * 256), 20) - 0.5;
        return Srgb{240.0, 238.0, 233.0} + Srgb{11.0, 12.0, 14.0} * stains + Srgb{14.0} * grain +
               Srgb{9.0} * octaves(u, v, 40, 2, 30);
    });
}

ColourImage brick_texture() {
    // 8 bricks and 24 courses in 1.92 m: bricks of 240 x 80 mm with their joints.
    return painted(512, [](double u, double v) {
        const double course = v * 24.0;
        const int row = static_cast<int>(course);
        const double along = u * 8.0 + (row % 2 == 0 ? 0.0 : 0.5);
        const int column = static_cast<int>(along) % 8;
        const double in = inside_joint(along - std::floor(along), course - row, 0.020, 0.060, 0.03);
        const double shade = cell_noise(column, row, 1);
        const double hue = cell_noise(column, row, 2);
        const Srgb brick = mixed({170.0, 106.0, 84.0}, {204.0, 146.0, 116.0}, shade) + Srgb{8.0, -10.0, -12.0} * hue -
                           Srgb{34.0, 26.0, 18.0} * (cell_noise(column, row, 3) > 0.88 ? 1.0 : 0.0);
        const Srgb mortar{198.0, 190.0, 176.0};
        const double grain = octaves(u, v, 64, 3, 5);
        return mixed(mortar, brick, in) + Srgb{13.0} * grain + Srgb{8.0} * octaves(u, v, 3, 3, 12);
    });
}

ColourImage stone_texture() {
    return painted(256, [](double u, double v) {
        return Srgb{226.0, 221.0, 210.0} + Srgb{16.0, 16.0, 17.0} * octaves(u, v, 6, 5, 40) +
               Srgb{12.0} * (cell_noise(static_cast<int>(u * 256), static_cast<int>(v * 256), 50) - 0.5);
    });
}

ColourImage roof_tile_texture() {
    return painted(256, [](double u, double v) {
        const int column = static_cast<int>(u * 8.0);
        const int row = static_cast<int>(v * 8.0);
        const double in_row = v * 8.0 - row;
        const double shade = cell_noise(column, row, 60) - 0.5;
        const double hue = cell_noise(column, row, 61) - 0.5;
        const double lichen = std::max(0.0, octaves(u, v, 4, 4, 62));
        return Srgb{222.0, 218.0, 214.0} + Srgb{52.0, 46.0, 44.0} * shade + Srgb{8.0, -4.0, -12.0} * hue -
               Srgb{40.0, 34.0, 40.0} * lichen - Srgb{34.0} * std::max(0.0, 1.0 - 6.0 * in_row) +
               Srgb{10.0} * octaves(u, v, 48, 2, 70);
    });
}

ColourImage roof_felt_texture() {
    return painted(256, [](double u, double v) {
        const double seam = std::abs(u * 4.0 - std::floor(u * 4.0) - 0.5) > 0.485 ? -22.0 : 0.0;
        return Srgb{150.0, 150.0, 152.0} + Srgb{seam} + Srgb{14.0} * octaves(u, v, 4, 5, 80) +
               Srgb{22.0} * (cell_noise(static_cast<int>(u * 256), static_cast<int>(v * 256), 81) - 0.5);
    });
}

ColourImage wood_texture() {
    return painted(256, [](double u, double v) {
        const int plank = static_cast<int>(v * 8.0);
        const double in = std::abs(v * 8.0 - plank - 0.5) > 0.46 ? 1.0 : 0.0;
        const double fibre =
            value_noise(u * 6.0, v * 96.0, 6, 96, 90) + 0.6 * value_noise(u * 12.0, v * 128.0, 12, 128, 91);
        return Srgb{204.0, 178.0, 146.0} + Srgb{26.0, 24.0, 20.0} * (cell_noise(plank, 0, 92) - 0.5) +
               Srgb{15.0, 14.0, 13.0} * fibre - Srgb{70.0} * in;
    });
}

ColourImage asphalt_texture() {
    return painted(512, [](double u, double v) {
        const double chippings = cell_noise(static_cast<int>(u * 256), static_cast<int>(v * 256), 100);
        const double fine = cell_noise(static_cast<int>(u * 512), static_cast<int>(v * 512), 101) - 0.5;
        const double patch = octaves(u, v, 3, 5, 102);
        // Cracks: where a smooth noise crosses zero.
        const double crack = std::abs(octaves(u, v, 4, 4, 120)) < 0.010 && octaves(u, v, 2, 2, 130) > 0.05 ? 1.0 : 0.0;
        return Srgb{112.0, 112.0, 115.0} + Srgb{17.0} * patch + Srgb{12.0} * fine +
               Srgb{44.0, 43.0, 40.0} * std::max(0.0, chippings - 0.72) / 0.28 * 0.7 - Srgb{32.0} * crack;
    });
}

ColourImage paving_texture() {
    return painted(512, [](double u, double v) {
        const int row = static_cast<int>(v * 6.0);
        const double along = u * 6.0 + (row % 2 == 0 ? 0.0 : 0.5);
        const int column = static_cast<int>(along) % 6;
        const double in = inside_joint(along - std::floor(along), v * 6.0 - row, 0.008, 0.008, 0.014);
        const double shade = cell_noise(column, row, 140) - 0.5;
        const Srgb slab = Srgb{188.0, 182.0, 172.0} + Srgb{24.0, 23.0, 20.0} * shade +
                          Srgb{15.0} * octaves(u, v, 8, 5, 141) +
                          Srgb{12.0} * (cell_noise(static_cast<int>(u * 512), static_cast<int>(v * 512), 150) - 0.5);
        return mixed({118.0, 113.0, 104.0}, slab, in);
    });
}

ColourImage grass_texture() {
    return painted(256, [](double u, double v) {
        const double blades = cell_noise(static_cast<int>(u * 256), static_cast<int>(v * 128), 160) - 0.5;
        const double patch = octaves(u, v, 3, 5, 161);
        return Srgb{118.0, 140.0, 84.0} + Srgb{22.0, 16.0, 12.0} * patch + Srgb{30.0, 34.0, 20.0} * blades;
    });
}

ColourImage bark_texture() {
    return painted(128, [](double u, double v) {
        const double ridges =
            value_noise(u * 14.0, v * 4.0, 14, 4, 170) + 0.5 * value_noise(u * 30.0, v * 8.0, 30, 8, 171);
        return Srgb{150.0, 134.0, 118.0} + Srgb{38.0, 36.0, 33.0} * ridges;
    });
}

}  // namespace lw::scene
