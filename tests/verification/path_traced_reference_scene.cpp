#include "tests/verification/path_traced_reference_scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace patchlight::reference {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of the diameter: far above what doubles confuse, far below any feature of a scene.
constexpr double gap = 1e-9;

struct ReferenceMaterial {
    Rgb rho{0.0};
    Rgb radiance{0.0};
};

std::ifstream open(const std::filesystem::path& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    return in;
}

std::map<std::string, ReferenceMaterial> read_materials(const std::filesystem::path& file)
{
    std::map<std::string, ReferenceMaterial> materials;
    std::ifstream in = open(file);
    ReferenceMaterial* current = nullptr;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string key, name;
        words >> key;
        if (key == "newmtl" && words >> name) current = &materials[name];
        Rgb value;
        if (current == nullptr || (key != "Kd" && key != "Ke")) continue;
        if (!(words >> value.r >> value.g >> value.b)) throw std::runtime_error("bad colour: " + line);
        (key == "Kd" ? current->rho : current->radiance) = value;
    }
    return materials;
}

std::vector<Vec3> read_face(std::istringstream& words, const std::vector<Vec3>& vertices)
{
    std::vector<Vec3> corners;
    for (std::string word; words >> word;) {
        const long index = std::stol(word);  // up to the first slash
        if (index < 1 || index > static_cast<long>(vertices.size())) throw std::runtime_error("bad index: " + word);
        corners.push_back(vertices[static_cast<std::size_t>(index) - 1]);
    }
    return corners;
}

}  // namespace

Polygon make_polygon(std::vector<Vec3> corners, const Rgb& rho, const Rgb& radiance, std::string object)
{
    Polygon polygon;
    Vec3 twice_area{0.0};
    for (std::size_t k = 0; k < corners.size(); ++k)
        twice_area += glm::cross(corners[k] - corners[0], corners[(k + 1) % corners.size()] - corners[0]);
    polygon.area = glm::length(twice_area) / 2;
    if (!(polygon.area > 0)) throw std::runtime_error("a face without area in " + object);
    polygon.n = twice_area / (2 * polygon.area);
    const Vec3 edge = corners[1] - corners[0];
    polygon.u = glm::normalize(edge - glm::dot(edge, polygon.n) * polygon.n);
    polygon.v = glm::cross(polygon.n, polygon.u);
    polygon.low = Vec2{infinity};
    polygon.high = Vec2{-infinity};
    for (const Vec3& corner : corners) {
        polygon.offset += glm::dot(polygon.n, corner) / static_cast<double>(corners.size());
        polygon.outline.emplace_back(glm::dot(corner, polygon.u), glm::dot(corner, polygon.v));
        polygon.low = glm::min(polygon.low, polygon.outline.back());
        polygon.high = glm::max(polygon.high, polygon.outline.back());
    }
    polygon.corners = std::move(corners);
    polygon.rho = rho;
    polygon.radiance = radiance;
    polygon.object = std::move(object);
    return polygon;
}

bool Polygon::contains(const Vec2& q) const
{
    bool inside = false;
    for (std::size_t k = 0, before = outline.size() - 1; k < outline.size(); before = k++) {
        const Vec2& a = outline[before];
        const Vec2& b = outline[k];
        if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
}

double Polygon::distance_to_border(const Vec2& q) const
{
    double nearest = infinity;
    for (std::size_t k = 0, before = outline.size() - 1; k < outline.size(); before = k++) {
        const Vec2 edge = outline[k] - outline[before];
        const double along = std::clamp(glm::dot(q - outline[before], edge) / glm::dot(edge, edge), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(q - outline[before] - along * edge));
    }
    return nearest;
}

ReferenceScene::ReferenceScene(std::vector<Polygon> polygons) : polygons_(std::move(polygons))
{
    Vec3 low{infinity}, high{-infinity};
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
        if (groups_.empty() || polygons_[i].object != polygons_[groups_.back().first].object)
            groups_.push_back({i, i, Vec3{infinity}, Vec3{-infinity}});
        Group& group = groups_.back();
        group.last = i + 1;
        for (const Vec3& corner : polygons_[i].corners) {
            group.low = glm::min(group.low, corner);
            group.high = glm::max(group.high, corner);
        }
        low = glm::min(low, group.low);
        high = glm::max(high, group.high);
    }
    diameter_ = glm::length(high - low);
    for (Group& group : groups_) {
        group.low -= Vec3{gap * diameter_};
        group.high += Vec3{gap * diameter_};
    }
}

bool ReferenceScene::Group::missed_by(const Vec3& origin, const Vec3& inverse, double reach) const
{
    // fmin and fmax drop the NaN of 0 × ∞, which is a ray inside a slab's own plane.
    double enter = 0, leave = reach;
    for (int k = 0; k < 3; ++k) {
        const double a = (low[k] - origin[k]) * inverse[k];
        const double b = (high[k] - origin[k]) * inverse[k];
        enter = std::fmax(enter, std::fmin(a, b));
        leave = std::fmin(leave, std::fmax(a, b));
    }
    return enter > leave;
}

/// Infinity where the ray misses the polygon or meets it beyond reach.
double ReferenceScene::hit_distance(const Polygon& polygon, const Vec3& origin, const Vec3& direction,
                                    double reach) const
{
    const double slope = glm::dot(polygon.n, direction);
    if (slope == 0) return infinity;
    const double t = (polygon.offset - glm::dot(polygon.n, origin)) / slope;
    if (!(t > gap * diameter_) || t >= reach) return infinity;
    const Vec3 p = origin + t * direction;
    return polygon.contains({glm::dot(p, polygon.u), glm::dot(p, polygon.v)}) ? t : infinity;
}

std::optional<Hit> ReferenceScene::closest(const Vec3& origin, const Vec3& direction) const
{
    std::optional<Hit> best;
    double reach = infinity;
    const Vec3 inverse = 1.0 / direction;
    for (const Group& group : groups_) {
        if (group.last - group.first > 3 && group.missed_by(origin, inverse, reach)) continue;
        for (std::size_t i = group.first; i < group.last; ++i) {
            const double t = hit_distance(polygons_[i], origin, direction, reach + gap * diameter_);
            if (t == infinity) continue;
            const bool front = glm::dot(polygons_[i].n, direction) < 0;
            const bool nearer = !best || t < best->t - gap * diameter_;
            if (!nearer && (best->front || !front)) continue;
            best = Hit{i, t, front};
            reach = t;
        }
    }
    return best;
}

bool ReferenceScene::sees(const Vec3& a, const Vec3& b) const
{
    const double distance = glm::length(b - a);
    const Vec3 direction = (b - a) / distance;
    const Vec3 inverse = 1.0 / direction;
    const double reach = distance - gap * diameter_;
    for (const Group& group : groups_) {
        if (group.last - group.first > 3 && group.missed_by(a, inverse, reach)) continue;
        for (std::size_t i = group.first; i < group.last; ++i)
            if (hit_distance(polygons_[i], a, direction, reach) != infinity) return false;
    }
    return true;
}

ReferenceScene read_reference_scene(const std::filesystem::path& obj)
{
    std::ifstream in = open(obj);
    std::map<std::string, ReferenceMaterial> materials;
    std::vector<Vec3> vertices;
    std::vector<Polygon> polygons;
    std::string object, material;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string key, name;
        words >> key;
        if (key == "mtllib" && words >> name) materials = read_materials(obj.parent_path() / name);
        if (key == "o") words >> object;
        if (key == "usemtl") words >> material;
        if (key == "v") {
            Vec3 p;
            if (!(words >> p.x >> p.y >> p.z)) throw std::runtime_error("bad vertex: " + line);
            vertices.push_back(p);
        }
        if (key == "f") {
            const ReferenceMaterial& m = materials.at(material);
            polygons.push_back(make_polygon(read_face(words, vertices), m.rho, m.radiance, object));
        }
    }
    return ReferenceScene(std::move(polygons));
}

}  // namespace patchlight::reference
