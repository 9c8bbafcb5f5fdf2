#include "scene/city_facade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace lw::scene {

namespace {

constexpr double kReveal_m = 0.17;
constexpr double kFrame_m = 0.06;

Rgba8 scaled(Rgba8 colour, double factor) {
    const auto channel = [&](std::uint8_t c) {
        return static_cast<std::uint8_t>(std::clamp(c * factor + 0.5, 0.0, 255.0));
    };
    return {channel(colour.r), channel(colour.g), channel(colour.b), 255};
}

std::vector<double> sorted_cuts(std::vector<double> cuts) {
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double a, double b) { return b - a < 1e-6; }), cuts.end());
    return cuts;
}

/// The flat ring between the opening and itself made smaller by `inset`, facing out at depth z.
void add_ring(MeshBuilder& builder, const Opening& o, double inset, double z) {
    const glm::dvec3 normal{0.0, 0.0, 1.0};
    const std::array<std::uint32_t, 4> outer{
        builder.vertex({o.x0, o.y0, z}, normal), builder.vertex({o.x1, o.y0, z}, normal),
        builder.vertex({o.x1, o.y1, z}, normal), builder.vertex({o.x0, o.y1, z}, normal)};
    const std::array<std::uint32_t, 4> inner{builder.vertex({o.x0 + inset, o.y0 + inset, z}, normal),
                                             builder.vertex({o.x1 - inset, o.y0 + inset, z}, normal),
                                             builder.vertex({o.x1 - inset, o.y1 - inset, z}, normal),
                                             builder.vertex({o.x0 + inset, o.y1 - inset, z}, normal)};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        builder.triangle(outer[i], outer[j], inner[j]);
        builder.triangle(outer[i], inner[j], inner[i]);
    }
}

/// `low`, the cuts between it and `high`, and `high`.
std::vector<double> steps_between(double low, double high, std::span<const double> cuts) {
    std::vector<double> steps{low};
    for (const double cut : cuts) {
        if (cut > low + 1e-6 && cut < high - 1e-6) steps.push_back(cut);
    }
    steps.push_back(high);
    return steps;
}

/// The four inward faces of a hole between depths z_out and z_in; their outer edges meet the wall's corners.
void add_reveal(MeshBuilder& builder, const Opening& o, double z_out, double z_in, const WallCuts& wall = {}) {
    const auto upright = [&](double x, double z, std::span<const double> ys, double normal_x) {
        std::vector<std::uint32_t> line;
        for (const double y : ys) line.push_back(builder.vertex({x, y, z}, {normal_x, 0.0, 0.0}));
        return line;
    };
    const auto level = [&](double y, double z, std::span<const double> xs, double normal_y) {
        std::vector<std::uint32_t> line;
        for (const double x : xs) line.push_back(builder.vertex({x, y, z}, {0.0, normal_y, 0.0}));
        return line;
    };
    const std::vector<double> xs = steps_between(o.x0, o.x1, wall.xs);
    const std::vector<double> ys = steps_between(o.y0, o.y1, wall.ys);
    const std::array<double, 2> ends_x{o.x0, o.x1};
    const std::array<double, 2> ends_y{o.y0, o.y1};
    builder.strip(upright(o.x0, z_out, ys, 1.0), upright(o.x0, z_in, ends_y, 1.0));
    builder.strip(upright(o.x1, z_in, ends_y, -1.0), upright(o.x1, z_out, ys, -1.0));
    builder.strip(level(o.y0, z_in, ends_x, 1.0), level(o.y0, z_out, xs, 1.0));
    builder.strip(level(o.y1, z_out, xs, -1.0), level(o.y1, z_in, ends_x, -1.0));
}

void use_wall(MeshBuilder& builder, const BuildingStyle& style, double factor = 1.0) {
    builder.use_material(style.wall, texture_size_m(style.wall));
    builder.use_colour(scaled(style.wall_colour, factor));
}

void use_trim(MeshBuilder& builder, const BuildingStyle& style) {
    builder.use_material(kStone, texture_size_m(kStone));
    builder.use_colour(style.trim_colour);
}

void use_paint(MeshBuilder& builder, Rgba8 colour) {
    builder.use_material(kPaint);
    builder.use_colour(colour);
}

/// Glass at depth z: dark rooms, some with curtains behind the lower or the whole pane.
void add_glass(MeshBuilder& builder, const Opening& o, double z, Random& random) {
    static constexpr std::array<std::uint32_t, 4> kRooms{0x2B343C, 0x35424C, 0x262C33, 0x3E4A50};
    builder.use_material(kGlass);
    builder.use_colour(tint(random.pick(kRooms)));
    builder.polygon({{o.x0, o.y0, z}, {o.x1, o.y0, z}, {o.x1, o.y1, z}, {o.x0, o.y1, z}});
    if (!random.chance(0.45)) return;
    static constexpr std::array<std::uint32_t, 4> kCurtains{0xB9AE9A, 0xA8A39A, 0xA58F7C, 0x8F9A98};
    builder.use_colour(tint(random.pick(kCurtains)));
    const double reach = (o.x1 - o.x0) * random.between(0.16, 0.34);
    const double zc = z + 0.012;
    builder.polygon({{o.x0, o.y0, zc}, {o.x0 + 0.7 * reach, o.y0, zc}, {o.x0 + reach, o.y1, zc}, {o.x0, o.y1, zc}});
    builder.polygon({{o.x1 - 0.7 * reach, o.y0, zc}, {o.x1, o.y0, zc}, {o.x1, o.y1, zc}, {o.x1 - reach, o.y1, zc}});
}

void add_sill(MeshBuilder& builder, const BuildingStyle& style, const Opening& o) {
    use_trim(builder, style);
    builder.box({o.x0 - 0.10, o.y0 - 0.09, -kReveal_m}, {o.x1 + 0.10, o.y0 + 0.01, 0.13}, kNoBack);
}

/// A raised frame around an opening.
void add_surround(MeshBuilder& builder, const BuildingStyle& style, const Opening& o) {
    use_trim(builder, style);
    constexpr double kWide = 0.14;
    constexpr double kThick = 0.05;
    const unsigned upright = kLeft | kRight | kFront;
    builder.box({o.x0 - kWide, o.y0, 0.0}, {o.x0, o.y1, kThick}, upright);
    builder.box({o.x1, o.y0, 0.0}, {o.x1 + kWide, o.y1, kThick}, upright);
    builder.box({o.x0 - kWide - 0.05, o.y1, 0.0}, {o.x1 + kWide + 0.05, o.y1 + 0.2, kThick + 0.05}, kNoBack);
}

/// A louvred shutter folded open beside a window.
void add_shutter(MeshBuilder& builder, const BuildingStyle& style, double x0, double x1, double y0, double y1) {
    use_paint(builder, style.accent_colour);
    constexpr double kStile = 0.06;
    const unsigned edge = kLeft | kRight | kFront;
    builder.box({x0, y0, 0.0}, {x0 + kStile, y1, 0.05}, edge);
    builder.box({x1 - kStile, y0, 0.0}, {x1, y1, 0.05}, edge);
    builder.box({x0 + kStile, y0, 0.0}, {x1 - kStile, y0 + kStile, 0.05}, kTop | kFront | kBottom);
    builder.box({x0 + kStile, y1 - kStile, 0.0}, {x1 - kStile, y1, 0.05}, kTop | kFront | kBottom);
    constexpr int kLouvres = 9;
    const double pitch = (y1 - y0 - 2.0 * kStile) / kLouvres;
    builder.use_colour(scaled(style.accent_colour, 0.82));
    for (int i = 0; i < kLouvres; ++i) {
        const double y = y0 + kStile + i * pitch;
        builder.polygon({{x0 + kStile, y, 0.042},
                         {x1 - kStile, y, 0.042},
                         {x1 - kStile, y + pitch, 0.012},
                         {x0 + kStile, y + pitch, 0.012}});
    }
}

void add_door(MeshBuilder& builder, const BuildingStyle& style, const Opening& o, const WallCuts& wall,
              Random& random) {
    use_wall(builder, style, 0.8);
    add_reveal(builder, o, 0.0, -0.3, wall);
    const double head = o.y0 + 2.15;  // above it a light
    use_paint(builder, style.frame_colour);
    add_ring(builder, o, kFrame_m, -0.2);
    const Opening inner{o.x0 + kFrame_m, o.x1 - kFrame_m, o.y0, o.y1 - kFrame_m};
    add_reveal(builder, inner, -0.2, -0.26);
    builder.box({inner.x0, head, -0.26}, {inner.x1, head + 0.07, -0.19}, kTop | kBottom | kFront);
    add_glass(builder, {inner.x0, inner.x1, head + 0.07, inner.y1}, -0.25, random);
    use_paint(builder, style.accent_colour);
    builder.polygon(
        {{inner.x0, o.y0, -0.25}, {inner.x1, o.y0, -0.25}, {inner.x1, head, -0.25}, {inner.x0, head, -0.25}});
    builder.use_colour(scaled(style.accent_colour, 1.25));
    const double middle = 0.5 * (inner.x0 + inner.x1);
    for (int row = 0; row < 3; ++row) {
        const double y = o.y0 + 0.16 + row * 0.66;
        for (const double x : {inner.x0 + 0.09, middle + 0.04}) {
            builder.box({x, y, -0.25}, {x + middle - inner.x0 - 0.13, y + 0.54, -0.225}, kNoBack);
        }
    }
    builder.use_material(kIron);
    builder.use_colour(tint(0xB9A25A));
    builder.box({inner.x1 - 0.12, o.y0 + 1.02, -0.25}, {inner.x1 - 0.05, o.y0 + 1.1, -0.17}, kNoBack);
    // Steps, and a small roof on two brackets.
    use_trim(builder, style);
    builder.box({o.x0 - 0.25, 0.0, -0.3}, {o.x1 + 0.25, o.y0, 0.34}, kLeft | kRight | kTop | kFront);
    builder.box({o.x0 - 0.25, 0.0, 0.34}, {o.x1 + 0.25, 0.5 * o.y0, 0.64}, kLeft | kRight | kTop | kFront);
    if (random.chance(0.5)) {
        use_paint(builder, style.accent_colour);
        builder.box({o.x0 - 0.3, o.y1 + 0.24, 0.0}, {o.x1 + 0.3, o.y1 + 0.33, 0.85}, kNoBack);
        builder.use_material(kIron);
        builder.use_colour(tint(0x2E3133));
        for (const double x : {o.x0 - 0.22, o.x1 + 0.22}) {
            builder.bar({x, o.y1 - 0.25, 0.02}, {x, o.y1 + 0.24, 0.75}, 0.018);
        }
    } else {
        add_surround(builder, style, o);
    }
}

/// Striped cloth over a shop window, on thin arms.
void add_awning(MeshBuilder& builder, const BuildingStyle& style, const Opening& o, double y) {
    const int stripes = 2 * static_cast<int>((o.x1 - o.x0 + 0.3) / 0.56) + 1;
    const double x0 = o.x0 - 0.15;
    const double step = (o.x1 - o.x0 + 0.3) / stripes;
    constexpr double kOut = 1.15;
    const double low = y - 0.62;
    for (int i = 0; i < stripes; ++i) {
        use_paint(builder, i % 2 == 0 ? style.accent_colour : tint(0xEFE6D4));
        const double a = x0 + i * step;
        const double b = a + step;
        builder.polygon({{a, low, kOut}, {b, low, kOut}, {b, y, 0.06}, {a, y, 0.06}});
        builder.polygon({{a, y - 0.03, 0.06}, {b, y - 0.03, 0.06}, {b, low - 0.03, kOut}, {a, low - 0.03, kOut}});
        builder.polygon({{a, low - 0.24, kOut}, {b, low - 0.24, kOut}, {b, low, kOut}, {a, low, kOut}});
        builder.polygon(
            {{b, low - 0.24, kOut - 0.01}, {a, low - 0.24, kOut - 0.01}, {a, low, kOut - 0.01}, {b, low, kOut - 0.01}});
    }
    builder.use_material(kIron);
    builder.use_colour(tint(0x3A3D40));
    for (const double x : {x0 + 0.06, x0 + stripes * step - 0.06}) {
        builder.bar({x, low - 0.25, 0.02}, {x, low - 0.04, kOut - 0.05}, 0.014);
    }
}

void add_shop_window(MeshBuilder& builder, const BuildingStyle& style, const Opening& o, const WallCuts& wall,
                     bool awning, Random& random) {
    use_paint(builder, style.accent_colour);
    add_reveal(builder, o, 0.0, -0.25, wall);
    add_ring(builder, o, 0.08, -0.06);
    const double riser = o.y0 + 0.55;
    builder.box({o.x0 + 0.08, o.y0 + 0.08, -0.2}, {o.x1 - 0.08, riser, -0.04}, kTop | kFront);
    builder.use_colour(scaled(style.accent_colour, 1.25));
    const int panes = std::max(2, static_cast<int>((o.x1 - o.x0) / 1.1));
    const double step = (o.x1 - o.x0 - 0.16) / panes;
    for (int i = 0; i < panes; ++i) {
        const double x = o.x0 + 0.08 + i * step;
        builder.box({x + 0.08, o.y0 + 0.16, -0.04}, {x + step - 0.08, riser - 0.1, -0.015}, kNoBack);
        if (i > 0) builder.box({x - 0.03, riser, -0.2}, {x + 0.03, o.y1 - 0.08, -0.06}, kLeft | kRight | kFront);
    }
    builder.box({o.x0 + 0.08, o.y1 - 0.62, -0.2}, {o.x1 - 0.08, o.y1 - 0.57, -0.08}, kTop | kBottom | kFront);
    add_glass(builder, {o.x0 + 0.08, o.x1 - 0.08, riser, o.y1 - 0.08}, -0.19, random);
    // Name board with a moulding.
    use_paint(builder, style.accent_colour);
    builder.box({o.x0 - 0.2, o.y1 + 0.05, 0.0}, {o.x1 + 0.2, o.y1 + 0.6, 0.12}, kNoBack);
    use_paint(builder, tint(0xEADFC4));
    builder.box({o.x0 - 0.25, o.y1 + 0.6, 0.0}, {o.x1 + 0.25, o.y1 + 0.68, 0.2}, kNoBack);
    const double letter = 0.22;  // blocks in the place of letters
    const int letters = static_cast<int>((o.x1 - o.x0) / letter * 0.55);
    const double start = 0.5 * (o.x0 + o.x1) - 0.5 * letters * letter;
    for (int i = 0; i < letters; ++i) {
        if (random.chance(0.15)) continue;
        const double x = start + i * letter;
        const double height = random.chance(0.3) ? 0.28 : 0.2;
        builder.box({x, o.y1 + 0.19, 0.12}, {x + random.between(0.09, 0.17), o.y1 + 0.19 + height, 0.14}, kNoBack);
    }
    if (awning) add_awning(builder, style, o, o.y1 + 0.02);
}

/// Where the front's openings are. The door is in column `door_column`.
std::vector<Opening> front_openings(const BuildingStyle& style, double width_m, int door_column) {
    std::vector<Opening> openings;
    const double module = width_m / style.columns;
    const double sill = style.shop ? 0.12 : 0.95;
    for (int storey = 0; storey < style.storeys; ++storey) {
        const double floor = storey == 0 ? 0.0 : style.ground_height_m + (storey - 1) * style.storey_height_m;
        for (int column = 0; column < style.columns; ++column) {
            const double x = -0.5 * width_m + (column + 0.5) * module;
            const double half = std::min(0.56, 0.5 * module - 0.45);
            if (storey == 0 && column == door_column) {
                openings.push_back({x - 0.62, x + 0.62, 0.3, 2.95, OpeningKind::door});
            } else if (storey == 0 && style.shop) {
                // Neighbouring shop columns share one window.
                const double shop_half = 0.5 * module - 0.28;
                openings.push_back({x - shop_half, x + shop_half, sill, 2.75, OpeningKind::shop_window});
            } else if (storey == 0) {
                openings.push_back({x - half, x + half, sill + 0.15, 2.75, OpeningKind::window});
            } else if (style.balconies && (column % 3 == 1 || style.columns - 1 - column == 1)) {
                openings.push_back(
                    {x - half - 0.08, x + half + 0.08, floor + 0.06, floor + 2.3, OpeningKind::balcony_door});
            } else {
                openings.push_back({x - half, x + half, floor + 0.85, floor + 2.35, OpeningKind::window});
            }
        }
    }
    return openings;
}

std::vector<Opening> plain_openings(const BuildingStyle& style, double width_m, int columns) {
    std::vector<Opening> openings;
    const double module = width_m / columns;
    for (int storey = 0; storey < style.storeys; ++storey) {
        const double floor = storey == 0 ? 0.25 : style.ground_height_m + (storey - 1) * style.storey_height_m;
        for (int column = 0; column < columns; ++column) {
            const double x = -0.5 * width_m + (column + 0.5) * module;
            openings.push_back({x - 0.5, x + 0.5, floor + 0.9, floor + 2.3, OpeningKind::window});
        }
    }
    return openings;
}

/// Of all walls of a house, which meet at its corners.
std::vector<double> heights_of_openings(const BuildingStyle& style) {
    std::vector<double> heights;
    for (const int door_column : {0, style.columns - 1}) {
        for (const Opening& o : front_openings(style, style.width_m, door_column)) {
            heights.insert(heights.end(), {o.y0, o.y1});
        }
    }
    for (const Opening& o : plain_openings(style, style.width_m, 1)) heights.insert(heights.end(), {o.y0, o.y1});
    return sorted_cuts(std::move(heights));
}

/// A band along the wall between y0 and y1, interrupted where an opening is.
void add_band(MeshBuilder& builder, double width_m, double y0, double y1, double thick_m,
              std::span<const Opening> openings) {
    double x = -0.5 * width_m;
    std::vector<std::array<double, 2>> gaps;
    for (const Opening& o : openings) {
        if (o.y0 < y1 && o.y1 > y0) gaps.push_back({o.x0, o.x1});
    }
    std::sort(gaps.begin(), gaps.end());
    gaps.push_back({0.5 * width_m, 0.5 * width_m});
    for (const auto& gap : gaps) {
        if (gap[0] - x > 1e-6) builder.box({x, y0, 0.0}, {gap[0], y1, thick_m}, kNoBack);
        x = gap[1];
    }
}

void add_trims(MeshBuilder& builder, const BuildingStyle& style, double width_m, bool front,
               std::span<const Opening> openings) {
    use_trim(builder, style);
    if (!style.shop || !front) add_band(builder, width_m, 0.0, 0.55, 0.05, openings);
    if (!front) return;
    if (style.storeys > 1)
        add_band(builder, width_m, style.ground_height_m - 0.12, style.ground_height_m + 0.06, 0.09, openings);
    const double eaves = style.eaves_height_m();
    builder.box({-0.5 * width_m, eaves - 0.42, 0.0}, {0.5 * width_m, eaves - 0.22, 0.1}, kNoBack);
    builder.box({-0.5 * width_m, eaves - 0.22, 0.0}, {0.5 * width_m, eaves, 0.22}, kNoBack);
    // Small blocks under the cornice.
    const int blocks = static_cast<int>(width_m / 0.6);
    for (int i = 0; i < blocks; ++i) {
        const double x = -0.5 * width_m + (i + 0.5) * width_m / blocks;
        builder.box({x - 0.07, eaves - 0.36, 0.1}, {x + 0.07, eaves - 0.22, 0.2}, kLeft | kRight | kBottom | kFront);
    }
}

}  // namespace

WallCuts add_wall(MeshBuilder& builder, double x0, double x1, double y0, double y1, std::span<const Opening> openings,
                  std::span<const double> edge_ys) {
    WallCuts cuts{{x0, x1}, {y0, y1}};
    for (const Opening& o : openings) {
        cuts.xs.insert(cuts.xs.end(), {o.x0, o.x1});
        cuts.ys.insert(cuts.ys.end(), {o.y0, o.y1});
    }
    cuts.xs = sorted_cuts(std::move(cuts.xs));
    cuts.ys = sorted_cuts(std::move(cuts.ys));
    const std::size_t columns = cuts.xs.size() - 1;
    std::map<std::pair<std::size_t, double>, std::uint32_t> corners;  // by column and height
    const auto corner = [&](std::size_t column, double y) {
        const auto [at, is_new] = corners.try_emplace({column, y});
        if (is_new) at->second = builder.vertex({cuts.xs[column], y, 0.0}, {0.0, 0.0, 1.0});
        return at->second;
    };
    const auto side = [&](std::size_t column, double low, double high) {
        const bool is_edge = column == 0 || column == columns;
        std::vector<std::uint32_t> line;
        for (const double y : steps_between(low, high, is_edge ? edge_ys : std::span<const double>{})) {
            line.push_back(corner(column, y));
        }
        return line;
    };
    for (std::size_t j = 0; j + 1 < cuts.ys.size(); ++j) {
        for (std::size_t i = 0; i < columns; ++i) {
            const double x = 0.5 * (cuts.xs[i] + cuts.xs[i + 1]);
            const double y = 0.5 * (cuts.ys[j] + cuts.ys[j + 1]);
            const bool open = std::any_of(openings.begin(), openings.end(), [&](const Opening& o) {
                return x > o.x0 && x < o.x1 && y > o.y0 && y < o.y1;
            });
            if (open) continue;
            builder.strip(side(i, cuts.ys[j], cuts.ys[j + 1]), side(i + 1, cuts.ys[j], cuts.ys[j + 1]));
        }
    }
    return cuts;
}

void add_window(MeshBuilder& builder, const BuildingStyle& style, const Opening& opening, int panes_x, int panes_y,
                const WallCuts& wall, Random& random) {
    use_wall(builder, style, 0.82);
    add_reveal(builder, opening, 0.0, -kReveal_m, wall);
    use_paint(builder, style.frame_colour);
    constexpr double kFront_m = -0.09;
    constexpr double kGlass_m = -0.14;
    add_ring(builder, opening, kFrame_m, kFront_m);
    const Opening pane{opening.x0 + kFrame_m, opening.x1 - kFrame_m, opening.y0 + kFrame_m, opening.y1 - kFrame_m};
    add_reveal(builder, pane, kFront_m, kGlass_m);
    for (int i = 1; i < panes_x; ++i) {
        const double x = pane.x0 + (pane.x1 - pane.x0) * i / panes_x;
        builder.box({x - 0.03, pane.y0, kGlass_m}, {x + 0.03, pane.y1, kFront_m + 0.01}, kLeft | kRight | kFront);
    }
    for (int i = 1; i < panes_y; ++i) {
        // The upper light is the smaller one.
        const double y =
            panes_y == 2 ? pane.y0 + (pane.y1 - pane.y0) * 0.68 : pane.y0 + (pane.y1 - pane.y0) * i / panes_y;
        builder.box({pane.x0, y - 0.02, kGlass_m}, {pane.x1, y + 0.02, kFront_m}, kTop | kBottom | kFront);
    }
    add_glass(builder, pane, kGlass_m, random);
}

void add_balcony(MeshBuilder& builder, const BuildingStyle& style, double x, double y, double width_m) {
    constexpr double kOut_m = 1.05;
    const double half = 0.5 * width_m;
    use_trim(builder, style);
    builder.box({x - half, y - 0.16, 0.0}, {x + half, y, kOut_m}, kNoBack);
    for (const double side : {x - half + 0.25, x + half - 0.4}) {
        builder.polygon({{side, y - 0.5, 0.0}, {side, y - 0.16, 0.8}, {side, y - 0.16, 0.0}});
        builder.polygon({{side + 0.15, y - 0.5, 0.0}, {side + 0.15, y - 0.16, 0.0}, {side + 0.15, y - 0.16, 0.8}});
        builder.polygon(
            {{side, y - 0.5, 0.0}, {side + 0.15, y - 0.5, 0.0}, {side + 0.15, y - 0.16, 0.8}, {side, y - 0.16, 0.8}});
    }
    builder.use_material(kIron);
    builder.use_colour(tint(0x26292C));
    const double front = kOut_m - 0.06;
    const double left = x - half + 0.06;
    const double right = x + half - 0.06;
    const double top = y + 1.02;
    const std::array<glm::dvec3, 4> corners{glm::dvec3{left, 0.0, 0.0}, glm::dvec3{left, 0.0, front},
                                            glm::dvec3{right, 0.0, front}, glm::dvec3{right, 0.0, 0.0}};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 a = corners[i];
        const glm::dvec3 b = corners[i + 1];
        builder.beam(a + glm::dvec3{0.0, top, 0.0}, b + glm::dvec3{0.0, top, 0.0}, 0.05, 0.035);
        builder.bar(a + glm::dvec3{0.0, y + 0.1, 0.0}, b + glm::dvec3{0.0, y + 0.1, 0.0}, 0.014);
        const double length = std::abs(b.x - a.x) + std::abs(b.z - a.z);
        const int bars = static_cast<int>(length / 0.13);
        for (int k = i == 1 ? 0 : 1; k <= bars - (i == 1 ? 0 : 1); ++k) {
            const glm::dvec3 foot = a + (b - a) * (static_cast<double>(k) / bars);
            builder.bar(foot + glm::dvec3{0.0, y, 0.0}, foot + glm::dvec3{0.0, top, 0.0}, 0.011, 3);
        }
    }
}

void add_facade(MeshBuilder& builder, const BuildingStyle& style, double width_m, bool front, bool windows,
                Random& random) {
    const int door_column = random.below(2) == 0 ? 0 : style.columns - 1;
    std::vector<Opening> openings;
    if (front) openings = front_openings(style, width_m, door_column);
    if (!front && windows) openings = plain_openings(style, width_m, 3);
    use_wall(builder, style);
    const WallCuts wall = add_wall(builder, -0.5 * width_m, 0.5 * width_m, 0.0, style.eaves_height_m(), openings,
                                   heights_of_openings(style));
    add_trims(builder, style, width_m, front, openings);
    const bool awnings = random.chance(0.7);
    for (const Opening& o : openings) {
        switch (o.kind) {
            case OpeningKind::door:
                add_door(builder, style, o, wall, random);
                break;
            case OpeningKind::shop_window:
                add_shop_window(builder, style, o, wall, awnings, random);
                break;
            case OpeningKind::balcony_door:
                add_window(builder, style, o, 2, 2, wall, random);
                add_surround(builder, style, o);
                add_balcony(builder, style, 0.5 * (o.x0 + o.x1), o.y0 - 0.02, 2.5);
                break;
            case OpeningKind::window:
                add_window(builder, style, o, 2, front ? 3 : 2, wall, random);
                add_sill(builder, style, o);
                if (front && style.shutters) {
                    const double leaf = 0.5 * (o.x1 - o.x0);
                    add_shutter(builder, style, o.x0 - leaf - 0.02, o.x0 - 0.02, o.y0, o.y1);
                    add_shutter(builder, style, o.x1 + 0.02, o.x1 + leaf + 0.02, o.y0, o.y1);
                } else if (front) {
                    add_surround(builder, style, o);
                }
                break;
        }
    }
}

}  // namespace lw::scene
