#pragma once

#include "meshing/vectors.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// A scene as the reference sees it: read, intersected and sampled by code of its own, so that a mistake of the
/// program under test is not repeated here. Shares vector types only.
namespace patchlight::reference {

/// A planar polygon without holes, convex or not, with a black back.
struct Polygon {
    std::vector<Vec3> corners;
    Vec3 u, v, n;               ///< right-handed, u along the first edge, n to the front
    double offset = 0;          ///< n · any corner
    std::vector<Vec2> outline;  ///< the corners in (u, v)
    Vec2 low, high;             ///< of the outline
    double area = 0;
    Rgb rho{0.0};
    Rgb radiance{0.0};
    std::string object;

    bool contains(const Vec2& q) const;
    double distance_to_border(const Vec2& q) const;
    Vec3 at(const Vec2& q) const { return q.x * u + q.y * v + offset * n; }
    bool emits() const { return radiance.r + radiance.g + radiance.b > 0; }
    bool reflects() const { return rho.r + rho.g + rho.b > 0; }
};

Polygon make_polygon(std::vector<Vec3> corners, const Rgb& rho, const Rgb& radiance, std::string object);

struct Hit {
    std::size_t polygon = 0;
    double t = 0;
    bool front = false;
};

/// All polygons, with a bounding box around each object's.
class ReferenceScene {
public:
    explicit ReferenceScene(std::vector<Polygon> polygons);

    const std::vector<Polygon>& polygons() const { return polygons_; }
    double diameter() const { return diameter_; }

    /// The first polygon on the ray. Of two back to back at one place the one that faces the ray answers.
    std::optional<Hit> closest(const Vec3& origin, const Vec3& direction) const;
    /// Whether nothing lies strictly between two points.
    bool sees(const Vec3& a, const Vec3& b) const;

private:
    struct Group {
        std::size_t first = 0, last = 0;
        Vec3 low, high;
        bool missed_by(const Vec3& origin, const Vec3& inverse, double reach) const;
    };
    double hit_distance(const Polygon& polygon, const Vec3& origin, const Vec3& direction, double reach) const;

    std::vector<Polygon> polygons_;
    std::vector<Group> groups_;
    double diameter_ = 0;
};

/// Reads v, f, o, usemtl and mtllib of an OBJ; newmtl, Kd and Ke of its MTL. Throws std::runtime_error.
ReferenceScene read_reference_scene(const std::filesystem::path& obj);

}  // namespace patchlight::reference
