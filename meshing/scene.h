#pragma once

#include "meshing/ids.h"
#include "meshing/surface_line.h"
#include "meshing/vectors.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace patchlight {

/// A diffuse material, as the light sees it.
struct Material {
    std::string name;
    Rgb reflectance{0.5};    ///< ρ, in [0, 1)
    Rgb emission{0.0};       ///< exitance E, W/m²
    bool two_sided = false;  ///< a two-sided polygon is two surfaces back to back; both emit and reflect

    bool emits() const { return emission.r > 0 || emission.g > 0 || emission.b > 0; }
    bool reflects() const { return reflectance.r > 0 || reflectance.g > 0 || reflectance.b > 0; }
};

/// An orthonormal right-handed frame on a plane: n is the front's normal. For axis-aligned planes u and v are
/// axes too, so that plane coordinates are differences of space coordinates and as exact as these.
struct PlaneFrame {
    Vec3 origin{0.0};
    Vec3 u{1, 0, 0};
    Vec3 v{0, 1, 0};
    Vec3 n{0, 0, 1};

    Vec2 to_plane(const Vec3& p) const { return {glm::dot(p - origin, u), glm::dot(p - origin, v)}; }
    Vec3 lift(const Vec2& q) const { return origin + q.x * u + q.y * v; }
};

/// A planar polygon of one material, holes allowed, one-sided: its front emits and reflects, its back is black.
/// What a standing solid covers of it is a hole.
struct Surface {
    MaterialId material;
    ObjectId object;  ///< of the largest face it was joined from
    PlaneFrame frame;
    double area = 0;  ///< m²
    /// Indices into Scene::vertices: outer loop counter-clockwise seen from the front, then the holes clockwise.
    /// Without collinear vertices. Loops may touch in vertices, never cross.
    std::vector<std::vector<std::uint32_t>> loops;
};

/// A triangle of the ray caster's triangulation. It contains all T-vertices and contact segments, so that
/// surfaces that touch share vertices. `front` is the surface whose normal is the triangle's counter-clockwise
/// one, `back` the one that faces the other way; either or both may be invalid, which is a black side.
struct SceneTriangle {
    std::array<std::uint32_t, 3> vertices{};
    SurfaceId front;
    SurfaceId back;
};

/// A camera.
struct View {
    std::string name;
    Vec3 from{0.0};          ///< in the scene's recentred metres
    Vec3 forward{0, 0, -1};  ///< unit
    Vec3 up{0, 1, 0};
    double vertical_fov = 39.3;  ///< degrees
    double aspect = 0;           ///< width / height; 0 = the picture's own
};

/// What is solved: immutable once read. Coordinates are metres relative to `center`.
struct Scene {
    std::string name;
    Vec3 center{0.0};     ///< metres; file coordinates × unit = vertices + center
    double diameter = 0;  ///< of the bounding box, metres
    double unit = 1;      ///< metres per unit of the file
    bool closed = false;  ///< no light that surfaces emit can escape
    std::vector<Vec3> vertices;
    std::vector<SceneTriangle> triangles;
    std::vector<Surface> surfaces;
    std::vector<SurfaceLine> contact_lines;  ///< see find_contact_lines()
    std::vector<Material> materials;
    std::vector<std::string> objects;
    std::vector<View> views;

    const Surface& surface(SurfaceId id) const { return surfaces[id.value]; }
    const Material& material_of(SurfaceId id) const { return materials[surfaces[id.value].material.value]; }
};

}  // namespace patchlight
