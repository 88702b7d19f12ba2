#pragma once

#include "formfactor/random_numbers.h"
#include "meshing/build_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// Scenes put together in code from polygons, and random ones in which much coincides.
namespace patchlight::testing {

using Corners = std::vector<Vec3>;

/// Polygons gathered for build_scene, each with corners of its own.
class SceneWriter {
public:
    static constexpr std::size_t white = 0, lamp = 1, shade = 2, glowing = 3;

    SceneWriter()
    {
        raw_.format = "obj";
        raw_.file_name = "written.obj";
        raw_.objects = {"all"};
        raw_.materials = {Material{.name = "white", .reflectance = Rgb(0.7)},
                          Material{.name = "lamp", .reflectance = Rgb(0.0), .emission = Rgb(10.0)},
                          Material{.name = "shade", .reflectance = Rgb(0.4), .two_sided = true},
                          Material{.name = "glowing", .reflectance = Rgb(0.3), .emission = Rgb(5.0)}};
    }

    /// Counter-clockwise seen from the front.
    void face(const Corners& corners, std::size_t material = white)
    {
        RawFace face;
        face.first_corner = raw_.corners.size();
        face.count = corners.size();
        face.material = MaterialId(material);
        face.object = ObjectId(std::size_t{0});
        for (const Vec3& p : corners) {
            raw_.corners.push_back(static_cast<std::int64_t>(raw_.vertices.size()));
            raw_.vertices.push_back(p);
        }
        raw_.faces.push_back(face);
    }

    /// c[0…3] the bottom, counter-clockwise seen from above, c[4…7] the top over it; fronts outside.
    void box(const Corners& c, bool bottom)
    {
        if (bottom) face({c[0], c[3], c[2], c[1]});
        face({c[4], c[5], c[6], c[7]});
        for (std::size_t k = 0; k < 4; ++k) face({c[k], c[(k + 1) % 4], c[4 + (k + 1) % 4], c[4 + k]});
    }

    RawScene& raw() { return raw_; }
    Scene build() const { return build_scene(raw_, SceneOptions{}).scene; }

private:
    RawScene raw_;
};

inline Corners box_corners(const Vec3& low, const Vec3& size)
{
    Corners corners;
    for (const double z : {low.z, low.z + size.z}) {
        corners.emplace_back(low.x, low.y, z);
        corners.emplace_back(low.x + size.x, low.y, z);
        corners.emplace_back(low.x + size.x, low.y + size.y, z);
        corners.emplace_back(low.x, low.y + size.y, z);
    }
    return corners;
}

/// p turned about the axis (unit) through `centre`.
inline Vec3 turned_about(const Vec3& p, const Vec3& centre, const Vec3& axis, double angle)
{
    const Vec3 r = p - centre;
    return centre + r * std::cos(angle) + glm::cross(axis, r) * std::sin(angle) +
           axis * (glm::dot(axis, r) * (1 - std::cos(angle)));
}

/// Makes one random scene; see random_boxes.
class RandomBoxes {
public:
    explicit RandomBoxes(std::uint64_t seed) : random_(seed, 0xb0c5) {}

    Scene make()
    {
        writer_.face({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
        const std::uint32_t boxes = 1 + random_.below(6);
        for (std::uint32_t k = 0; k < boxes; ++k) add_box();
        const std::uint32_t lights = 1 + random_.below(2);
        for (std::uint32_t k = 0; k < lights; ++k) add_light();
        if (random_.below(4) == 0) turn_all();
        return writer_.build();
    }

private:
    struct Placed {
        Vec3 low, size;
    };

    /// On a grid, where much coincides, or anywhere.
    double length(double least, double most)
    {
        const double t = least + (most - least) * random_.uniform();
        return random_.below(3) > 0 ? std::max(0.25, 0.25 * std::round(4 * t)) : t;
    }

    Placed place()
    {
        Placed box{{0, 0, 0}, {length(0.2, 1.2), length(0.2, 1.2), length(0.2, 1.5)}};
        box.low = {length(0, 3.5) - 2, length(0, 3.5) - 2, 0};
        if (placed_.empty()) return box;
        const Placed& other = placed_[random_.below(static_cast<std::uint32_t>(placed_.size()))];
        switch (random_.below(6)) {
        case 0:  // touching its side
            box.low = {other.low.x + other.size.x, other.low.y, other.low.z};
            break;
        case 1:  // stacked
            box.low = {other.low.x + 0.5 * (other.size.x - box.size.x), other.low.y, other.low.z + other.size.z};
            break;
        case 2:  // intersecting
            box.low = other.low + Vec3(0.5 * other.size.x, 0.3 * other.size.y, 0);
            break;
        case 3:  // tops and one side coplanar, apart or not
            box.low.y = other.low.y;
            box.size.z = other.low.z + other.size.z;
            break;
        case 4:  // in the air, or touching an edge from above
            box.low.z = random_.below(2) > 0 ? 0.5 : other.size.z;
            break;
        default:
            break;
        }
        return box;
    }

    double angle()
    {
        switch (random_.below(4)) {
        case 0:
            return 1e-9;
        case 1:
            return 2 * std::numbers::pi * random_.uniform();
        default:
            return 0;
        }
    }

    void add_box()
    {
        const Placed box = place();
        placed_.push_back(box);
        Corners corners = box_corners(box.low, box.size);
        const double about_z = angle(), tilt = random_.below(4) == 0 ? angle() : 0;
        for (Vec3& p : corners) {
            p = turned_about(p, box.low + 0.5 * box.size, {0, 0, 1}, about_z);
            p = turned_about(p, box.low, glm::normalize(Vec3(1, 0.4, 0)), tilt);
        }
        writer_.box(corners, random_.below(3) > 0);
    }

    /// Facing down; convex with 3 to 6 corners, a square or an L; some in the plane of a box's top, some tilted.
    void add_light()
    {
        const double z = random_.below(4) == 0 ? placed_[0].low.z + placed_[0].size.z : length(1.5, 3);
        const double size = 0.1 + 0.7 * random_.uniform(), x = length(0, 3) - 1.5, y = length(0, 3) - 1.5;
        Corners outline;
        const std::uint32_t kind = random_.below(3);
        if (kind == 0) {
            const std::uint32_t corners = 3 + random_.below(4);
            for (std::uint32_t k = 0; k < corners; ++k) {
                const double t = 2 * std::numbers::pi * (k + 0.6 * random_.uniform()) / corners;
                outline.emplace_back(x + size * std::cos(t), y + size * std::sin(t), z);
            }
        } else if (kind == 1) {
            outline = {{x, y, z}, {x + size, y, z}, {x + size, y + size, z}, {x, y + size, z}};
        } else {
            const double half = 0.5 * size;
            outline = {{x, y, z},
                       {x + size, y, z},
                       {x + size, y + half, z},
                       {x + half, y + half, z},
                       {x + half, y + size, z},
                       {x, y + size, z}};
        }
        const double tilt = random_.below(3) == 0 ? 0.6 * random_.uniform() : angle_of_nothing();
        for (Vec3& p : outline) p = turned_about(p, {x, y, z}, glm::normalize(Vec3(0.3, 1, 0)), tilt);
        std::reverse(outline.begin(), outline.end());
        writer_.face(outline, random_.below(3) == 0 ? SceneWriter::glowing : SceneWriter::lamp);
    }

    double angle_of_nothing() { return random_.below(3) == 0 ? 1e-9 : 0; }

    void turn_all()
    {
        const Vec3 axis = glm::normalize(Vec3(random_.uniform() - 0.4, random_.uniform(), random_.uniform() - 0.3));
        const double by = 3 * random_.uniform();
        for (Vec3& p : writer_.raw().vertices) p = turned_about(p, {0.3, -0.2, 0.1}, axis, by);
    }

    RandomNumbers random_;
    SceneWriter writer_;
    std::vector<Placed> placed_;
};

/// One to six boxes on, over and through a floor of 4 × 4 m under one or two polygonal lights: touching, stacked,
/// intersecting, coplanar, turned and tilted by 0, by 1e-9 rad and by any angle; every fourth scene turned as a whole.
inline Scene random_boxes(std::uint64_t seed)
{
    return RandomBoxes(seed).make();
}

}  // namespace patchlight::testing
