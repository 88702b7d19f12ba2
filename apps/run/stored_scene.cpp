#include "apps/run/stored_scene.h"

#include "apps/run/sha256.h"
#include "meshing/scene_error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t frame_numbers = 13;  // origin, u, v, n, area
constexpr std::size_t deepest_json = 64;

Json json_of(const Vec3& v)
{
    return Json::array({v.x, v.y, v.z});
}

Json header_of(const Scene& scene)
{
    Json materials = Json::array();
    for (const Material& m : scene.materials) {
        materials.push_back({{"name", m.name},
                             {"reflectance", json_of(m.reflectance)},
                             {"emission", json_of(m.emission)},
                             {"two_sided", m.two_sided}});
    }
    Json views = Json::array();
    for (const View& v : scene.views) {
        views.push_back({{"name", v.name},
                         {"from", json_of(v.from)},
                         {"forward", json_of(v.forward)},
                         {"up", json_of(v.up)},
                         {"vertical_fov", v.vertical_fov},
                         {"aspect", v.aspect}});
    }
    return {
        {"name", scene.name},     {"center", json_of(scene.center)}, {"diameter", scene.diameter}, {"unit", scene.unit},
        {"closed", scene.closed}, {"materials", materials},          {"objects", scene.objects},   {"views", views}};
}

double number(const Json& value)
{
    const double x = value.get<double>();
    if (!std::isfinite(x)) {
        throw SceneError("solution", "the stored scene holds a number that is not finite");
    }
    return x;
}

Vec3 vector_in(const Json& value)
{
    return {number(value.at(0)), number(value.at(1)), number(value.at(2))};
}

Scene scene_in(const Json& header)
{
    Scene scene;
    scene.name = header.at("name").get<std::string>();
    scene.center = vector_in(header.at("center"));
    scene.diameter = number(header.at("diameter"));
    scene.unit = number(header.at("unit"));
    scene.closed = header.at("closed").get<bool>();
    scene.objects = header.at("objects").get<std::vector<std::string>>();
    for (const Json& m : header.at("materials")) {
        scene.materials.push_back({m.at("name").get<std::string>(), vector_in(m.at("reflectance")),
                                   vector_in(m.at("emission")), m.at("two_sided").get<bool>()});
    }
    for (const Json& v : header.at("views")) {
        scene.views.push_back({v.at("name").get<std::string>(), vector_in(v.at("from")), vector_in(v.at("forward")),
                               vector_in(v.at("up")), number(v.at("vertical_fov")), number(v.at("aspect"))});
    }
    return scene;
}

void store_surfaces(const Scene& scene, ByteViews& views)
{
    std::vector<double> frames;
    std::vector<std::uint32_t>
        integers;  // a surface: material, object, number of loops, then each loop's length and vertices
    for (const Surface& s : scene.surfaces) {
        for (const Vec3* v : {&s.frame.origin, &s.frame.u, &s.frame.v, &s.frame.n}) {
            frames.insert(frames.end(), {v->x, v->y, v->z});
        }
        frames.push_back(s.area);
        integers.insert(integers.end(), {s.material.value, s.object.value, static_cast<std::uint32_t>(s.loops.size())});
        for (const auto& loop : s.loops) {
            integers.push_back(static_cast<std::uint32_t>(loop.size()));
            integers.insert(integers.end(), loop.begin(), loop.end());
        }
    }
    views["scene_frames"] = bytes_of(frames);
    views["scene_surfaces"] = bytes_of(integers);
}

/// Hands out integers one by one, each below its limit.
class IntegerReader {
public:
    explicit IntegerReader(const std::vector<std::uint32_t>& values) : values_(values) {}

    bool done() const { return next_ == values_.size(); }
    std::size_t left() const { return values_.size() - next_; }
    std::uint32_t below(std::size_t limit, bool or_invalid = false)
    {
        if (done()) {
            throw SceneError("solution", "the stored scene is cut short");
        }
        const std::uint32_t value = values_[next_++];
        if (value >= limit && !(or_invalid && value == SurfaceId::invalid_value)) {
            throw SceneError("solution", "an index of the stored scene leaves its array");
        }
        return value;
    }

private:
    const std::vector<std::uint32_t>& values_;
    std::size_t next_ = 0;
};

/// Orthonormal up to far more than rounding, or what is computed in it overflows.
PlaneFrame frame_in(const double* numbers)
{
    const auto vector = [&](int i) { return Vec3{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]}; };
    const PlaneFrame frame{vector(0), vector(1), vector(2), vector(3)};
    const bool unit =
        std::abs(glm::dot(frame.u, frame.u) - 1) < 1e-6 && std::abs(glm::dot(frame.v, frame.v) - 1) < 1e-6;
    if (!unit || !(std::abs(glm::dot(frame.u, frame.v)) < 1e-6) ||
        !(glm::length(glm::cross(frame.u, frame.v) - frame.n) < 1e-6)) {
        throw SceneError("solution", "a stored surface has no frame");
    }
    return frame;
}

/// Sizes that reading a scene lets pass, and places near the centre: up to rounding within half the diameter.
void check_sizes(const Scene& scene)
{
    if (!(scene.diameter > 1e-100) || !(scene.diameter < 1e100) || !(scene.unit > 0)) {
        throw SceneError("solution", "the stored scene has no size");
    }
    const auto near = [&](const Vec3& p) { return glm::length(p) <= scene.diameter; };
    const bool all = std::ranges::all_of(scene.vertices, near) &&
                     std::ranges::all_of(scene.surfaces, [&](const Surface& s) { return near(s.frame.origin); });
    if (!all) {
        throw SceneError("solution", "a stored vertex lies outside the scene");
    }
}

void restore_surfaces(const ByteViews& views, Scene& scene)
{
    const std::vector<double> frames = doubles_in(views, "scene_frames");
    const std::vector<std::uint32_t> integers = integers_in(views, "scene_surfaces");
    IntegerReader reader(integers);
    if (frames.size() % frame_numbers != 0) {
        throw SceneError("solution", "the stored scene is cut short");
    }
    for (std::size_t i = 0; i < frames.size(); i += frame_numbers) {
        Surface s;
        s.material = MaterialId(reader.below(scene.materials.size()));
        s.object = ObjectId(reader.below(scene.objects.size(), true));
        s.frame = frame_in(frames.data() + i);
        s.area = frames[i + frame_numbers - 1];
        s.loops.resize(reader.below(reader.left() + 1));
        for (auto& loop : s.loops) {
            loop.resize(reader.below(reader.left() + 1));
            for (auto& vertex : loop) {
                vertex = reader.below(scene.vertices.size());
            }
        }
        scene.surfaces.push_back(std::move(s));
    }
    if (!reader.done()) {
        throw SceneError("solution", "the stored scene holds more than its surfaces");
    }
}

void restore_triangles(const ByteViews& views, Scene& scene)
{
    const std::vector<std::uint32_t> integers = integers_in(views, "scene_triangles");
    IntegerReader reader(integers);
    while (!reader.done()) {
        SceneTriangle t;
        for (auto& vertex : t.vertices) {
            vertex = reader.below(scene.vertices.size());
        }
        t.front = SurfaceId(reader.below(scene.surfaces.size(), true));
        t.back = SurfaceId(reader.below(scene.surfaces.size(), true));
        scene.triangles.push_back(t);
    }
}

void store_contact_lines(const Scene& scene, ByteViews& views)
{
    std::vector<std::uint32_t> surfaces;
    std::vector<double> ends;
    for (const SurfaceLine& line : scene.contact_lines) {
        surfaces.push_back(line.surface.value);
        ends.insert(ends.end(), {line.start.x, line.start.y, line.end.x, line.end.y});
    }
    if (surfaces.empty()) return;  // glTF knows no empty array
    views["scene_contact_surfaces"] = bytes_of(surfaces);
    views["scene_contact_ends"] = bytes_of(ends);
}

void restore_contact_lines(const ByteViews& views, Scene& scene)
{
    if (!views.contains("scene_contact_surfaces")) return;
    const std::vector<std::uint32_t> surfaces = integers_in(views, "scene_contact_surfaces");
    const std::vector<double> ends = doubles_in(views, "scene_contact_ends");
    IntegerReader reader(surfaces);
    if (ends.size() != 4 * surfaces.size()) {
        throw SceneError("solution", "the stored scene is cut short");
    }
    for (const double* end = ends.data(); !reader.done(); end += 4) {
        scene.contact_lines.push_back(
            {SurfaceId(reader.below(scene.surfaces.size())), LineKind::contact, {end[0], end[1]}, {end[2], end[3]}});
    }
}

}  // namespace

void store_scene(const Scene& scene, ByteViews& views)
{
    const std::string header = header_of(scene).dump(-1, ' ', false, Json::error_handler_t::replace);
    views["scene_header"] = {header.begin(), header.end()};
    views["scene_vertices"] = bytes_of(std::span<const Vec3>(scene.vertices));
    std::vector<std::uint32_t> triangles;
    for (const SceneTriangle& t : scene.triangles) {
        triangles.insert(triangles.end(), {t.vertices[0], t.vertices[1], t.vertices[2], t.front.value, t.back.value});
    }
    views["scene_triangles"] = bytes_of(triangles);
    store_surfaces(scene, views);
    store_contact_lines(scene, views);
}

Scene restore_scene(const ByteViews& views)
{
    const std::string header = text_in(views, "scene_header");
    if (json_depth(header) > deepest_json) {
        throw SceneError("solution", "the stored scene is nested too deeply");
    }
    Scene scene;
    try {
        scene = scene_in(Json::parse(header));
    } catch (const nlohmann::json::exception& error) {
        throw SceneError("solution", std::string("the stored scene can't be read: ") + error.what());
    }
    scene.vertices = vectors_in(views, "scene_vertices");
    restore_surfaces(views, scene);
    restore_triangles(views, scene);
    restore_contact_lines(views, scene);
    check_sizes(scene);
    return scene;
}

std::string scene_digest(const Scene& scene)
{
    ByteViews views;
    store_scene(scene, views);
    std::string all;
    for (const auto& [name, bytes] : views) {
        all += name + ' ' + std::to_string(bytes.size()) + '\n';
        all.append(bytes.begin(), bytes.end());
    }
    return sha256_hex(all);
}

std::string as_utf8(const std::string& text)
{
    return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::size_t json_depth(std::string_view text)
{
    std::size_t depth = 0, deepest = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            i += c == '\\' ? 1 : 0;
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            deepest = std::max(deepest, ++depth);
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return deepest;
}

}  // namespace patchlight
