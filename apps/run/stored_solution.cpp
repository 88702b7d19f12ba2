#include "apps/run/stored_solution.h"

#include "apps/run/file_writer.h"
#include "apps/run/glb_file.h"
#include "apps/run/stored_scene.h"
#include "meshing/scene_error.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace patchlight {

namespace {

std::vector<std::uint32_t> surface_values(std::span<const SurfaceId> ids)
{
    std::vector<std::uint32_t> values;
    values.reserve(ids.size());
    for (SurfaceId id : ids) {
        values.push_back(id.value);
    }
    return values;
}

std::vector<SurfaceId> surface_ids(const ByteViews& views, const std::string& name, const Scene& scene)
{
    std::vector<SurfaceId> ids;
    for (std::uint32_t value : integers_in(views, name)) {
        if (value >= scene.surfaces.size()) {
            throw SceneError("solution", "an index in \"" + name + "\" leaves its array");
        }
        ids.push_back(SurfaceId(value));
    }
    return ids;
}

constexpr std::size_t line_numbers = 6;  // kind, left, right, beyond

std::vector<std::uint32_t> numbers_of(std::span<const MeshLine> lines)
{
    std::vector<std::uint32_t> numbers;
    for (const MeshLine& line : lines) {
        numbers.insert(numbers.end(), {static_cast<std::uint32_t>(line.kind), line.left[0], line.left[1], line.right[0],
                                       line.right[1], line.beyond ? 1U : 0U});
    }
    return numbers;
}

std::vector<MeshLine> lines_in(const ByteViews& views)
{
    if (!views.contains("lines")) {
        return {};  // empty arrays aren't stored
    }
    const std::vector<std::uint32_t> numbers = integers_in(views, "lines");
    if (numbers.size() % line_numbers != 0) {
        throw SceneError("solution", "the array \"lines\" is cut short");
    }
    std::vector<MeshLine> lines;
    for (std::size_t i = 0; i < numbers.size(); i += line_numbers) {
        const std::uint32_t* n = &numbers[i];
        if (n[0] >= line_kinds.size()) {
            throw SceneError("solution", "a line is of no known kind");
        }
        lines.push_back({line_kinds[n[0]], {n[1], n[2]}, {n[3], n[4]}, n[5] != 0});
    }
    return lines;
}

PatchMeshArrays arrays_in(const ByteViews& views, const Scene& scene)
{
    PatchMeshArrays arrays;
    arrays.positions = vectors_in(views, "positions");
    const std::vector<std::uint32_t> corners = integers_in(views, "patches");
    if (corners.size() % 3 != 0) {
        throw SceneError("solution", "the array \"patches\" is cut short");
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        arrays.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    arrays.patch_surface = surface_ids(views, "patch_surface", scene);
    arrays.vertex_surface = surface_ids(views, "vertex_surface", scene);
    if (arrays.patch_surface.size() != arrays.triangles.size() ||
        arrays.vertex_surface.size() != arrays.positions.size()) {
        throw SceneError("solution", "its arrays don't fit together");
    }
    arrays.lines = lines_in(views);
    return arrays;
}

template <class Values>
Values of_size(Values values, std::size_t size)
{
    if (values.size() != size) {
        throw SceneError("solution", "its arrays don't fit together");
    }
    return values;
}

MidpointRadiosity midpoints_in(const ByteViews& views, std::size_t patches)
{
    const std::vector<Rgb> values = of_size(vectors_in(views, "midpoint_radiosity"), 3 * patches);
    MidpointRadiosity middle_B(patches);
    for (std::size_t i = 0; i < values.size(); ++i) {
        middle_B[PatchId(i / 3)][i % 3] = values[i];
    }
    return middle_B;
}

StoredSolution restore(const ByteViews& views)
{
    StoredSolution stored;
    stored.scene = restore_scene(views);
    PatchMeshArrays arrays = arrays_in(views, stored.scene);
    if (std::ranges::any_of(arrays.positions,
                            [&](const Vec3& p) { return !(glm::length(p) <= stored.scene.diameter); })) {
        throw SceneError("solution", "a vertex lies outside the scene");
    }
    stored.mesh = PatchMesh(stored.scene, std::move(arrays));
    const std::size_t patches = stored.mesh.patch_count(), vertices = stored.mesh.vertex_count();
    stored.B = Radiosity(of_size(vectors_in(views, "patch_radiosity"), patches));
    stored.vertex_B = VertexRadiosity(of_size(vectors_in(views, "vertex_radiosity"), vertices));
    if (views.contains("midpoint_radiosity")) {
        stored.middle_B = midpoints_in(views, patches);
    }
    stored.eta = PatchField<double>(of_size(doubles_in(views, "eta"), patches));
    stored.edge = PatchField<std::uint8_t>(patches);
    const std::vector<std::uint32_t> edges = of_size(integers_in(views, "edge"), patches);
    for (std::size_t i = 0; i < patches; ++i) {
        if (edges[i] > 2) {
            throw SceneError("solution", "a patch has no such edge");
        }
        stored.edge[PatchId(i)] = static_cast<std::uint8_t>(edges[i]);
    }
    return stored;
}

}  // namespace

std::string encode_solution(const Scene& scene, const PatchMesh& mesh, const Radiosity& B,
                            const VertexRadiosity& vertex_B, const PatchField<double>& eta,
                            const PatchField<std::uint8_t>& edge, const MidpointRadiosity& middle_B)
{
    const PatchMeshArrays& arrays = mesh.arrays();
    std::vector<std::uint32_t> corners;
    corners.reserve(arrays.triangles.size() * 3);
    for (const auto& t : arrays.triangles) {
        corners.insert(corners.end(), t.begin(), t.end());
    }
    ByteViews views;
    store_scene(scene, views);
    views["positions"] = bytes_of(std::span<const Vec3>(arrays.positions));
    views["patches"] = bytes_of(corners);
    views["patch_surface"] = bytes_of(surface_values(arrays.patch_surface));
    views["vertex_surface"] = bytes_of(surface_values(arrays.vertex_surface));
    views["patch_radiosity"] = bytes_of(B.values());
    views["vertex_radiosity"] = bytes_of(vertex_B.values());
    if (!middle_B.empty()) {
        views["midpoint_radiosity"] =
            bytes_of(std::span<const Rgb>(middle_B.values().front().data(), 3 * middle_B.size()));
    }
    views["eta"] = bytes_of(eta.values());
    views["edge"] = bytes_of(std::vector<std::uint32_t>(edge.values().begin(), edge.values().end()));
    views["lines"] = bytes_of(numbers_of(mesh.lines()));
    return encode_glb(scene, mesh, vertex_B, views);
}

StoredSolution decode_solution(std::string_view bytes, const std::string& name)
{
    try {
        return restore(decode_glb(bytes));
    } catch (const SceneError& error) {
        throw SceneError("solution", name + ": " + error.what());
    } catch (const std::invalid_argument& error) {
        throw SceneError("solution", name + ": " + error.what());
    }
}

StoredSolution read_solution(const std::filesystem::path& file)
{
    std::string bytes;
    try {
        bytes = read_bytes(file);
    } catch (const std::runtime_error& error) {
        throw SceneError("solution", error.what());
    }
    return decode_solution(bytes, file.string());
}

}  // namespace patchlight
