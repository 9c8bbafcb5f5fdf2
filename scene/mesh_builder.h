#pragma once
/// Builds a mesh from simple solids. Flat faces share vertices, thin bars have smooth normals (half the vertices).

#include <glm/glm.hpp>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// Linear vertex colour of an sRGB hex value 0xRRGGBB, times `scale`. Same bits everywhere. Pure.
[[nodiscard]] Rgba8 tint(std::uint32_t srgb_hex, double scale = 1.0);

/// Rotation about +Y by `turns` (counter-clockwise from above), then a move. Pure.
[[nodiscard]] glm::dmat4 placement(const glm::dvec3& origin, double turns_about_y = 0.0);

/// Sides of a box to draw, in its own axes; combine with |.
enum BoxSides : unsigned {
    kLeft = 1,
    kRight = 2,
    kBottom = 4,
    kTop = 8,
    kBack = 16,
    kFront = 32,
    kAllSides = 63,
    kNoBottom = kAllSides & ~4u,
    kNoBack = kAllSides & ~16u,  ///< for what is fixed to a wall
};

/// A point of a profile turned about +Y.
struct ProfilePoint {
    double radius_m;
    double height_m;
};

/// Coordinates are local: metres, taken through the placement into the mesh's object space. Texture coordinates are
/// metres along the face (horizontal, down), divided by the material's texture size, continuous over neighbouring faces
/// of one plane. One thread at a time.
class MeshBuilder {
public:
    explicit MeshBuilder(std::string name) : name_{std::move(name)} {}

    /// Faces added from now on. `texture_size_m`: metres one repeat of the texture covers, > 0.
    void use_material(int material, double texture_size_m = 1.0);
    void use_colour(Rgba8 colour) { colour_ = colour; }
    /// Rigid object_from_local for what is added from now on.
    void place(const glm::dmat4& object_from_local) { object_from_local_ = object_from_local; }
    [[nodiscard]] const glm::dmat4& placed() const { return object_from_local_; }

    /// Low level: a vertex with metric texture coordinates for its normal, and a triangle of such vertices.
    std::uint32_t vertex(const glm::dvec3& position, const glm::dvec3& normal);
    /// With texture coordinates in repeats.
    std::uint32_t vertex(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& uv);
    /// Left out when two corners are the same vertex.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

    /// A flat convex polygon, counter-clockwise from its front. Without area: nothing.
    void polygon(std::span<const glm::dvec3> corners);
    void polygon(std::initializer_list<glm::dvec3> corners) { polygon(std::span{corners.begin(), corners.size()}); }

    /// A flat strip between two lines of vertices, at least two each; from its front, `right` lies to the right of
    /// `left` when both lead up. Their vertices need not stand opposite each other: edges of neighbours can be met at
    /// all of their corners, so that no crack opens between.
    void strip(std::span<const std::uint32_t> left, std::span<const std::uint32_t> right);

    /// Axis-aligned in local space, min < max.
    void box(const glm::dvec3& min, const glm::dvec3& max, unsigned sides = kAllSides);
    /// A box along `from` -> `to` with the given cross-section; `up` gives the direction of its height.
    void beam(const glm::dvec3& from, const glm::dvec3& to, double width_m, double height_m,
              const glm::dvec3& up = {0.0, 1.0, 0.0});
    /// A thin open prism with smooth normals: `sides` * 2 triangles and vertices.
    void bar(const glm::dvec3& from, const glm::dvec3& to, double radius_m, int sides = 4);
    /// The same along a path of at least two points.
    void tube(std::span<const glm::dvec3> path, double radius_m, int sides = 4);
    /// A smooth surface of revolution about the local y axis through `base`; profile from bottom to top. `sharp`: each
    /// ring has its own normals.
    void lathe(const glm::dvec3& base, std::span<const ProfilePoint> profile, int sides, bool sharp = false);
    void lathe(const glm::dvec3& base, std::initializer_list<ProfilePoint> profile, int sides, bool sharp = false) {
        lathe(base, std::span{profile.begin(), profile.size()}, sides, sharp);
    }
    /// The outer face of a wheel at `face`, turned to the sign of `width_m` along local x, and its tread behind it.
    void wheel(const glm::dvec3& face, double radius_m, double width_m, int sides);

    /// Multiplies the colours of all vertices so far by `1 - strength` at height 0, fading out at `reach_m`: the
    /// darkness where things meet the ground, which light without shadows does not give.
    void darken_towards_ground(double strength, double reach_m);

    [[nodiscard]] std::size_t triangle_count() const;

    /// Ends the building: one primitive per material, in ascending order of material.
    [[nodiscard]] Mesh take();

private:
    struct Part {
        int material = kNone;
        double texture_size_m = 1.0;
        std::vector<std::uint32_t> indices;
    };

    std::string name_;
    std::vector<Vertex> vertices_;
    std::vector<Part> parts_;
    std::size_t part_ = 0;
    Rgba8 colour_{255, 255, 255, 255};
    glm::dmat4 object_from_local_{1.0};
};

}  // namespace lw::scene
