#include "scene/rooms_shell.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/city_materials.h"
#include "scene/mesh_builder.h"

namespace lw::scene {

namespace {

void use(MeshBuilder& builder, CityMaterial material, std::uint32_t srgb_hex) {
    builder.use_material(material, texture_size_m(material));
    builder.use_colour(tint(srgb_hex));
}

struct Range {
    double low;
    double high;
};

/// A rectangle across `axis` at `place`, facing up (sign > 0) or down that axis; `u` and `v` are its extents on the
/// next two axes, in cyclic order.
void add_quad(MeshBuilder& builder, int axis, double place, double sign, Range u, Range v) {
    const int u_axis = (axis + 1) % 3;
    const int v_axis = (axis + 2) % 3;
    const auto corner = [&](double at_u, double at_v) {
        glm::dvec3 point{0.0};
        point[axis] = place;
        point[u_axis] = at_u;
        point[v_axis] = at_v;
        return point;
    };
    if (sign > 0.0) {
        builder.polygon({corner(u.low, v.low), corner(u.high, v.low), corner(u.high, v.high), corner(u.low, v.high)});
    } else {
        builder.polygon({corner(u.low, v.low), corner(u.low, v.high), corner(u.high, v.high), corner(u.high, v.low)});
    }
}

/// Where faces are cut, by axis: at the edges of all openings of a room. Every face of the room is cut there, so that
/// faces meet corner to corner: a corner in the middle of another face's edge lets single pixels shine through.
using Cuts = std::array<std::vector<double>, 3>;

std::vector<double> cuts_within(const Cuts& cuts, int axis, Range range) {
    std::vector<double> places{range.low};
    for (const double cut : cuts[static_cast<std::size_t>(axis)]) {
        if (cut > range.low + 1e-9 && cut < range.high - 1e-9) places.push_back(cut);
    }
    places.push_back(range.high);
    return places;
}

void add_wall(MeshBuilder& builder, int axis, double place, double sign, Range u, Range v, const Cuts& cuts,
              const std::vector<const Opening3*>& holes) {
    const int u_axis = (axis + 1) % 3;
    const int v_axis = (axis + 2) % 3;
    const std::vector<double> us = cuts_within(cuts, u_axis, u);
    const std::vector<double> vs = cuts_within(cuts, v_axis, v);
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
        for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
            const double middle_u = 0.5 * (us[i] + us[i + 1]);
            const double middle_v = 0.5 * (vs[j] + vs[j + 1]);
            const bool open = std::any_of(holes.begin(), holes.end(), [&](const Opening3* hole) {
                return middle_u > hole->min_m[u_axis] && middle_u < hole->max_m[u_axis] &&
                       middle_v > hole->min_m[v_axis] && middle_v < hole->max_m[v_axis];
            });
            if (!open) add_quad(builder, axis, place, sign, {us[i], us[i + 1]}, {vs[j], vs[j + 1]});
        }
    }
}

/// The four inner sides of an opening, from the wall's surface at `place` to the middle of the wall. Each is cut where
/// the wall is, towards the wall only: in the middle it meets the side that belongs to the other room.
void add_reveal(MeshBuilder& builder, const Opening3& opening, double place, const Cuts& cuts) {
    const int axis = opening.axis;
    const double middle = 0.5 * (opening.min_m[axis] + opening.max_m[axis]);
    for (const int step : {1, 2}) {
        const int across = (axis + step) % 3;
        const int along = (axis + 3 - step) % 3;
        const std::vector<double> places = cuts_within(cuts, along, {opening.min_m[along], opening.max_m[along]});
        for (const bool upper : {false, true}) {
            const auto corner = [&](double at_along, double at_axis) {
                glm::dvec3 point{0.0};
                point[across] = upper ? opening.max_m[across] : opening.min_m[across];
                point[along] = at_along;
                point[axis] = at_axis;
                return point;
            };
            std::vector<glm::dvec3> outline{corner(places.front(), middle)};
            for (const double at : places) outline.push_back(corner(at, place));
            outline.push_back(corner(places.back(), middle));
            // It faces into the opening.
            glm::dvec3 inwards{0.0};
            inwards[across] = upper ? -1.0 : 1.0;
            const glm::dvec3 normal = glm::cross(outline[1] - outline[0], outline.back() - outline[0]);
            if (glm::dot(normal, inwards) < 0.0) std::reverse(outline.begin() + 1, outline.end());
            builder.polygon(outline);
        }
    }
}

std::vector<const Opening3*> openings_of(const RoomsLayout& layout, int room, int axis, bool room_is_lower) {
    std::vector<const Opening3*> found;
    for (const Opening3& opening : layout.openings) {
        if (opening.axis == axis && opening.rooms[room_is_lower ? 0 : 1] == room) found.push_back(&opening);
    }
    return found;
}

Cuts cuts_of(const RoomsLayout& layout, int room) {
    Cuts cuts;
    for (const Opening3& opening : layout.openings) {
        if (opening.rooms[0] != room && opening.rooms[1] != room) continue;
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == opening.axis) continue;
            auto& places = cuts[static_cast<std::size_t>(axis)];
            places.insert(places.end(), {opening.min_m[axis], opening.max_m[axis]});
        }
    }
    for (std::vector<double>& places : cuts) {
        std::sort(places.begin(), places.end());
        const auto same = [](double a, double b) { return b - a < 1e-9; };
        places.erase(std::unique(places.begin(), places.end(), same), places.end());
    }
    return cuts;
}

void use_surface(MeshBuilder& builder, RoomUse room_use, int axis, bool upper, int room) {
    static constexpr std::array<std::uint32_t, 6> kWalls{0xF3EEE2, 0xE6EADF, 0xDDE6EA, 0xF0E2D2, 0xE9E4EE, 0xEFE9C9};
    const bool passage = room_use == RoomUse::corridor || room_use == RoomUse::lobby;
    if (axis != 1) {
        use(builder, kPlaster, passage ? 0xF6F3EC : kWalls[static_cast<std::size_t>(room) % kWalls.size()]);
    } else if (upper) {
        use(builder, kPlaster, 0xFFFFFF);
    } else {
        use(builder, passage ? kPaving : kWood, passage ? 0xDADADA : 0xE0C49A);
    }
}

}  // namespace

Mesh make_room_shell(const RoomsLayout& layout, int room) {
    const RoomSpace& space = layout.rooms[static_cast<std::size_t>(room)];
    MeshBuilder builder{fmt::format("walls {}", room)};
    const Cuts cuts = cuts_of(layout, room);
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            use_surface(builder, space.use, axis, upper, room);
            const double place = upper ? space.max_m[axis] : space.min_m[axis];
            const Range u{space.min_m[(axis + 1) % 3], space.max_m[(axis + 1) % 3]};
            const Range v{space.min_m[(axis + 2) % 3], space.max_m[(axis + 2) % 3]};
            // At its upper end the room is on the lower side of the wall.
            const std::vector<const Opening3*> holes = openings_of(layout, room, axis, upper);
            add_wall(builder, axis, place, upper ? -1.0 : 1.0, u, v, cuts, holes);
            use(builder, kPaint, 0xE8E2D4);
            for (const Opening3* hole : holes) add_reveal(builder, *hole, place, cuts);
        }
    }
    return builder.take();
}

Mesh make_facade(const RoomsLayout& layout) {
    MeshBuilder builder{"facade"};
    const Cuts cuts = cuts_of(layout, 0);
    for (const int axis : {0, 2}) {
        for (const bool upper : {false, true}) {
            use(builder, kBrick, 0xFFE9DC);
            const double place = upper ? layout.max_m[axis] : layout.min_m[axis];
            const Range u{layout.min_m[(axis + 1) % 3], layout.max_m[(axis + 1) % 3]};
            const Range v{layout.min_m[(axis + 2) % 3], layout.max_m[(axis + 2) % 3]};
            // The outside is beyond the upper wall: on the upper side of its openings.
            const std::vector<const Opening3*> holes = openings_of(layout, 0, axis, !upper);
            add_wall(builder, axis, place, upper ? 1.0 : -1.0, u, v, cuts, holes);
            use(builder, kStone, 0xE2DAC8);
            for (const Opening3* hole : holes) add_reveal(builder, *hole, place, cuts);
        }
    }
    use(builder, kRoofFelt, 0xB0B0B0);
    add_wall(builder, 1, layout.max_m.y, 1.0, {layout.min_m.z, layout.max_m.z}, {layout.min_m.x, layout.max_m.x}, cuts,
             {});
    return builder.take();
}

}  // namespace lw::scene
