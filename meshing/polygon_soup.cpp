#include "meshing/polygon_soup.h"

#include "meshing/face_shape.h"
#include "meshing/scene_error.h"
#include "meshing/vertex_grid.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace patchlight {

namespace {

constexpr double needle_ratio = 1e5;
// Products of eight lengths must neither overflow nor vanish, nor a length in single precision.
constexpr double least_diameter = 1e-15, largest_diameter = 1e15;  // m

auto as_tuple(const Vec3& v)
{
    return std::tuple(v.x, v.y, v.z);
}

auto as_tuple(const Material& m)
{
    return std::tuple(m.name, as_tuple(m.reflectance), as_tuple(m.emission), m.two_sided);
}

struct Extent {
    Vec3 low{0.0}, high{0.0};
};

Extent extent_of_used(const RawScene& raw)
{
    Extent box{raw.vertices[static_cast<std::size_t>(raw.corners.front())],
               raw.vertices[static_cast<std::size_t>(raw.corners.front())]};
    for (const std::int64_t corner : raw.corners) {
        const Vec3& v = raw.vertices[static_cast<std::size_t>(corner)];
        box.low = glm::min(box.low, v);
        box.high = glm::max(box.high, v);
    }
    return box;
}

/// Values of one coordinate that differ by rounding become one, so that axis-aligned planes are exactly that.
void align_coordinate(std::vector<Vec3>& vertices, int axis, double tolerance)
{
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return vertices[a][axis] < vertices[b][axis]; });
    double anchor = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        double& value = vertices[order[i]][axis];
        if (i == 0 || value - anchor > tolerance) anchor = value;
        value = anchor;
    }
}

/// Fills soup.vertices; returns each raw corner's welded vertex.
std::vector<std::uint32_t> weld(const RawScene& raw, double align_tolerance, PolygonSoup& soup, SceneReport& report)
{
    std::vector<std::uint32_t> slot(raw.vertices.size(), Id<void>::invalid_value);
    std::vector<Vec3> used;
    for (const std::int64_t corner : raw.corners) {
        auto& place = slot[static_cast<std::size_t>(corner)];
        if (place != Id<void>::invalid_value) continue;
        place = static_cast<std::uint32_t>(used.size());
        used.push_back(raw.vertices[static_cast<std::size_t>(corner)] - soup.center);
    }
    for (int axis = 0; axis < 3; ++axis) align_coordinate(used, axis, align_tolerance);
    std::vector<std::uint32_t> order(used.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return as_tuple(used[a]) < as_tuple(used[b]); });
    VertexGrid grid(soup.snap);
    std::vector<std::uint32_t> welded(used.size());
    for (const std::uint32_t v : order) {
        if (const auto found = grid.find(used[v])) {
            welded[v] = *found;
            ++report.welded_vertices;
        } else {
            welded[v] = static_cast<std::uint32_t>(soup.vertices.size());
            grid.insert(used[v], welded[v]);
            soup.vertices.push_back(used[v]);
        }
    }
    std::vector<std::uint32_t> corners(raw.corners.size());
    for (std::size_t c = 0; c < corners.size(); ++c) {
        corners[c] = welded[slot[static_cast<std::size_t>(raw.corners[c])]];
    }
    return corners;
}

/// Sorts names and drops what no face uses; returns the new index of each old one.
template <class Item, class Key>
std::vector<std::uint32_t> sort_used(const std::vector<Item>& items, const std::vector<bool>& used, Key key,
                                     std::vector<Item>& sorted)
{
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < items.size(); ++i) {
        if (used[i]) order.push_back(i);
    }
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(items[a]) < key(items[b]); });
    std::vector<std::uint32_t> renamed(items.size(), Id<void>::invalid_value);
    for (const std::uint32_t i : order) {
        if (sorted.empty() || key(sorted.back()) != key(items[i])) sorted.push_back(items[i]);
        renamed[i] = static_cast<std::uint32_t>(sorted.size() - 1);
    }
    return renamed;
}

void name_faces(const RawScene& raw, PolygonSoup& soup, std::vector<SoupFace>& faces)
{
    std::vector<bool> material_used(raw.materials.size(), false), object_used(raw.objects.size(), false);
    for (const SoupFace& face : faces) {
        material_used[face.material.value] = true;
        object_used[face.object.value] = true;
    }
    const auto materials = sort_used(
        raw.materials, material_used, [](const Material& m) { return as_tuple(m); }, soup.materials);
    const auto objects = sort_used(
        raw.objects, object_used, [](const std::string& s) { return s; }, soup.objects);
    for (SoupFace& face : faces) {
        face.material = MaterialId(materials[face.material.value]);
        face.object = ObjectId(objects[face.object.value]);
    }
}

/// Objects that had faces in the file and have none left.
std::vector<std::string> empty_objects(const RawScene& raw, const std::vector<SoupFace>& faces)
{
    std::vector<std::string> names;
    std::vector<bool> used(raw.objects.size(), false);
    for (const SoupFace& face : faces) used[face.object.value] = true;
    for (const RawFace& face : raw.faces) {
        if (!used[face.object.value]) names.push_back(raw.objects[face.object.value]);
        used[face.object.value] = true;
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// Snapping moves corners by up to its distance either way, and may turn over what is narrower than both.
bool is_face(const SoupFace& face, const FaceShape& shape, const PolygonSoup& soup)
{
    return face.loop.size() >= 3 && shape.width > 2 * soup.snap;
}

void add_face(const SoupFace& face, PolygonSoup& soup, std::vector<SoupFace>& faces, SceneReport& report)
{
    const FaceShape shape = shape_of(face.loop, soup.vertices);
    if (!is_face(face, shape, soup)) {
        ++report.zero_area_faces;
        return;
    }
    if (shape.length > needle_ratio * shape.width) ++report.needles;
    if (shape.out_of_plane <= soup.snap) {
        faces.push_back(face);
        faces.back().normal = shape.normal;
        faces.back().area = shape.area;
        return;
    }
    ++report.nonplanar_faces;
    for (const auto& triangle : cut_into_triangles(face.loop, soup.vertices, shape.normal)) {
        SoupFace part{canonical_loop({triangle.begin(), triangle.end()}), face.material, face.object, {}, 0};
        const FaceShape flat = shape_of(part.loop, soup.vertices);
        if (!is_face(part, flat, soup)) continue;
        part.normal = flat.normal;
        part.area = flat.area;
        faces.push_back(std::move(part));
    }
}

void drop_duplicates(std::vector<SoupFace>& faces, SceneReport& report)
{
    std::sort(faces.begin(), faces.end(), [](const SoupFace& a, const SoupFace& b) {
        return std::tie(a.loop, a.material, a.object) < std::tie(b.loop, b.material, b.object);
    });
    const auto kept = std::unique(faces.begin(), faces.end(), [](const SoupFace& a, const SoupFace& b) {
        return a.loop == b.loop && a.material == b.material;
    });
    report.duplicate_faces += static_cast<std::size_t>(faces.end() - kept);
    faces.erase(kept, faces.end());
}

}  // namespace

PolygonSoup make_polygon_soup(const RawScene& raw, const SceneOptions& options, SceneReport& report)
{
    const auto no_area = [&] {
        throw SceneError("zeroarea", fmt::format("{}: all {} faces have no area", raw.file_name, raw.faces.size()));
    };
    if (raw.corners.empty()) no_area();
    PolygonSoup soup;
    const Extent box = extent_of_used(raw);
    const Vec3 largest = glm::max(glm::abs(box.low), glm::abs(box.high));
    const double resolution = raw.relative_precision * std::max({largest.x, largest.y, largest.z});
    soup.center = 0.5 * box.low + 0.5 * box.high;
    soup.diameter = glm::length(box.high - box.low);
    if (!(soup.diameter > 0)) no_area();
    if (!(soup.diameter >= least_diameter && soup.diameter <= largest_diameter)) {
        throw SceneError("size",
                         fmt::format("{}: the scene is {:.3g} m across, but {:g} … {:g} m is what can be computed "
                                     "with; give its coordinates in another unit",
                                     raw.file_name, soup.diameter, least_diameter, largest_diameter));
    }
    // What the file's own precision can't tell apart must weld, too.
    soup.snap = std::max(options.snap * soup.diameter, 4 * resolution);
    report.snap_distance = soup.snap;
    const double align_tolerance = std::max(1e-12 * soup.diameter, 2 * resolution);
    const std::vector<std::uint32_t> corners = weld(raw, align_tolerance, soup, report);
    std::vector<SoupFace> faces;
    for (const RawFace& raw_face : raw.faces) {
        const auto first = corners.begin() + static_cast<std::ptrdiff_t>(raw_face.first_corner);
        SoupFace face;
        face.loop = canonical_loop({first, first + static_cast<std::ptrdiff_t>(raw_face.count)});
        face.material = raw_face.material;
        face.object = raw_face.object;
        add_face(face, soup, faces, report);
    }
    if (faces.empty()) no_area();
    report.empty_objects = empty_objects(raw, faces);
    name_faces(raw, soup, faces);
    drop_duplicates(faces, report);
    soup.faces = std::move(faces);
    return soup;
}

}  // namespace patchlight
