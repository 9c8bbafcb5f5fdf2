#pragma once
/// A small scene whose every pixel is known in closed form: ray casting draws layers at any camera and time, and the
/// truth at any other. Coordinates, depth and ids follow the conventions of the frame (docs/conventions.md).

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"

namespace lw::test {

enum class Shape {
    ground,    ///< the infinite plane y = 0 of its object space, seen from above
    box,       ///< |x|, |y|, |z| <= half_size_m
    sphere,    ///< radius half_size_m.x
    cylinder,  ///< around y: radius half_size_m.x, half height half_size_m.y, without caps
};

enum class Pattern {
    plain,    ///< one colour per face
    waves,    ///< smooth: sums of sines, shortest wave = period_m
    checker,  ///< hard squares of period_m / 2
    windows,  ///< dark panes in a wall, with frames of a tenth of a pane
};

/// One object. Its linear-light colour depends on the place on its surface only: no highlights, no shadows.
struct Solid {
    Shape shape = Shape::box;
    glm::dvec3 half_size_m{0.5};
    glm::dvec3 position_m{0.0};    ///< world place of its centre at time 0
    glm::dvec3 velocity_m_s{0.0};  ///< of the centre
    double turn_rad = 0.0;         ///< about world Y at time 0
    double spin_rad_s = 0.0;       ///< about world Y
    ObjectId id = 0;               ///< 0 for static solids, which must not move
    Pattern pattern = Pattern::waves;
    double period_m = 0.5;
    glm::dvec3 colour{0.6};          ///< linear
    glm::dvec3 second_colour{0.15};  ///< linear

    [[nodiscard]] glm::dmat4 world_from_object(double time_s) const;
};

/// Where a ray first meets a solid.
struct Hit {
    int solid = -1;
    int face = 0;             ///< 0..5 on a box (-x, +x, -y, +y, -z, +z), else 0
    double distance_m = 0.0;  ///< along the eye's -z axis
    glm::dvec3 position_object{0.0};
    glm::dvec3 normal_object{0.0};

    /// On one smooth surface.
    [[nodiscard]] bool same_surface(const Hit& other) const { return solid == other.solid && face == other.face; }
};

class AnalyticScene {
public:
    std::vector<Solid> solids;

    /// A street: textured ground, house fronts, poles, a railing and wires about one pixel wide at 512 px over 90
    /// degrees, a ball, a box sliding at 2 m/s (id 1), a box spinning at 360 degrees/s (id 2), sky. The camera of
    /// street_camera() stands in it.
    [[nodiscard]] static AnalyticScene street();
    /// One textured plane facing the camera of street_camera(), 2 m away, large enough to fill any small motion.
    [[nodiscard]] static AnalyticScene wall(double distance_m = 2.0, double slant_rad = 0.0);

    /// What a renderer would publish. With `samples` > 1 each pixel's NxN samples are resolved per surface: colour and
    /// depth are averaged over the samples on the surface of the pixel's median sample by depth, and alpha is their
    /// share of all.
    [[nodiscard]] Layer draw(const Camera& camera, double time_s, int samples = 1) const;

    /// The ideal picture: NxN samples per pixel averaged in linear light.
    [[nodiscard]] ColourImage truth(const Camera& camera, double time_s, int samples = 2) const;

    /// Depth and id at pixel centres.
    [[nodiscard]] DepthImage truth_depth(const Camera& camera, double time_s) const;

    /// 1 where the surface at the target pixel's centre is the one that the source saw there: not hidden, not outside
    /// its picture.
    [[nodiscard]] Image<std::uint8_t> seen_by_source(const Camera& target, double target_time_s, const Camera& source,
                                                     double source_time_s) const;

    /// Solid index at pixel centres, -1 for sky.
    [[nodiscard]] Image<int> solid_at(const Camera& camera, double time_s) const;

    /// Placements of every solid with an id, by ascending id.
    [[nodiscard]] std::vector<ObjectTransform> movers(double time_s) const;
};

/// Eye height 1.6 m at the origin, looking along -Z, 90 degrees high and wide for square sizes.
[[nodiscard]] Camera street_camera(glm::ivec2 size_px);

/// `camera` moved by an offset in its own axes, metres, then turned by yaw (left positive), pitch and roll, degrees.
[[nodiscard]] Camera moved(const Camera& camera, const glm::dvec3& offset_eye_m, double yaw_deg, double pitch_deg = 0.0,
                           double roll_deg = 0.0);

}  // namespace lw::test
