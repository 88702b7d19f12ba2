#include "meshing/patch_mesh.h"

#include "meshing/patch_topology.h"

#include <algorithm>
#include <stdexcept>

namespace patchlight {

struct PatchMesh::Topology {
    TriMesh mesh;
};

namespace {

template <class IdType>
std::vector<IdRange<IdType>> ranges_by_surface(const std::vector<SurfaceId>& surface_of, std::size_t surfaces)
{
    std::vector<IdRange<IdType>> ranges(surfaces);
    std::uint32_t i = 0;
    for (std::uint32_t s = 0; s < surfaces; ++s) {
        ranges[s].first = i;
        while (i < surface_of.size() && surface_of[i].value == s) ++i;
        ranges[s].last = i;
    }
    if (i != surface_of.size()) throw std::invalid_argument("patch mesh: surfaces out of order or past the end");
    return ranges;
}

void check_triangles(const PatchMeshArrays& arrays)
{
    if (arrays.patch_surface.size() != arrays.triangles.size() ||
        arrays.vertex_surface.size() != arrays.positions.size())
        throw std::invalid_argument("patch mesh: one surface is needed for each patch and vertex");
    for (std::size_t t = 0; t < arrays.triangles.size(); ++t)
        for (const std::uint32_t v : arrays.triangles[t])
            if (v >= arrays.positions.size() || arrays.vertex_surface[v] != arrays.patch_surface[t])
                throw std::invalid_argument("patch mesh: a triangle names a vertex that isn't its surface's");
}

std::vector<std::pair<std::size_t, std::size_t>> line_ranges(const PatchMeshArrays& arrays, std::size_t surfaces)
{
    std::vector<std::pair<std::size_t, std::size_t>> ranges(surfaces);
    std::size_t i = 0;
    const auto surface_of = [&](std::size_t k) { return arrays.vertex_surface[arrays.lines[k].left[0]].value; };
    for (std::uint32_t s = 0; s < surfaces; ++s) {
        ranges[s].first = i;
        while (i < arrays.lines.size() && surface_of(i) == s) ++i;
        ranges[s].second = i;
    }
    if (i != arrays.lines.size()) throw std::invalid_argument("patch mesh: lines out of order");
    return ranges;
}

void check_lines(const TriMesh& mesh, const PatchMeshArrays& arrays)
{
    const auto vertex = [&](std::uint32_t v) {
        if (v >= mesh.n_vertices()) throw std::invalid_argument("patch mesh: a line names no vertex");
        return OpenMesh::VertexHandle(static_cast<int>(v));
    };
    for (const MeshLine& line : arrays.lines) {
        for (const auto& [from, to] : {line.left, line.right})
            if (!mesh.find_halfedge(vertex(from), vertex(to)).is_valid())
                throw std::invalid_argument("patch mesh: a line isn't an edge");
        for (std::size_t k = 0; k < 2; ++k)
            if (arrays.vertex_surface[line.left[k]] != arrays.vertex_surface[line.right[k]] ||
                arrays.positions[line.left[k]] != arrays.positions[line.right[k]])
                throw std::invalid_argument("patch mesh: the sides of a line aren't at one place");
    }
}

}  // namespace

PatchMesh::PatchMesh() : topology_(std::make_unique<Topology>()) {}
PatchMesh::PatchMesh(PatchMesh&&) noexcept = default;
PatchMesh& PatchMesh::operator=(PatchMesh&&) noexcept = default;
PatchMesh::~PatchMesh() = default;

PatchMesh::PatchMesh(const Scene& scene, PatchMeshArrays arrays)
    : arrays_(std::move(arrays)), topology_(std::make_unique<Topology>())
{
    check_triangles(arrays_);
    patch_ranges_ = ranges_by_surface<PatchId>(arrays_.patch_surface, scene.surfaces.size());
    vertex_ranges_ = ranges_by_surface<VertexId>(arrays_.vertex_surface, scene.surfaces.size());

    TriMesh& mesh = topology_->mesh;
    mesh.reserve(vertex_count(), 3 * patch_count(), patch_count());
    plane_positions_.reserve(vertex_count());
    for (const VertexId v : vertices()) {
        mesh.add_vertex(position(v));
        plane_positions_.push_back(scene.surface(surface(v)).frame.to_plane(position(v)));
    }
    areas_ = PatchField<double>(patch_count());
    for (const PatchId p : patches()) {
        const auto c = corners(p);
        areas_[p] = 0.5 * cross2(plane_position(c[0]), plane_position(c[1]), plane_position(c[2]));
        if (!(areas_[p] > 0)) throw std::invalid_argument("patch mesh: a patch has no area or shows its back");
        const auto handle = [](VertexId v) { return OpenMesh::VertexHandle(static_cast<int>(v.value)); };
        const auto face = mesh.add_face(handle(c[0]), handle(c[1]), handle(c[2]));
        if (!face.is_valid()) throw std::invalid_argument("patch mesh: the triangles of a surface aren't a manifold");
    }
    for (const auto v : mesh.vertices())
        if (!mesh.is_manifold(v)) throw std::invalid_argument("patch mesh: patches meet in a vertex only");
    check_lines(mesh, arrays_);
    line_ranges_ = line_ranges(arrays_, scene.surfaces.size());
}

Vec3 PatchMesh::centroid(PatchId patch) const
{
    const auto c = corners(patch);
    return (position(c[0]) + position(c[1]) + position(c[2])) / 3.0;
}

double PatchMesh::longest_edge(PatchId patch) const
{
    const auto c = corners(patch);
    return std::max({glm::distance(position(c[0]), position(c[1])), glm::distance(position(c[1]), position(c[2])),
                     glm::distance(position(c[2]), position(c[0]))});
}

std::array<PatchId, 3> PatchMesh::neighbours(PatchId patch) const
{
    const TriMesh& mesh = topology_->mesh;
    const auto c = corners(patch);
    std::array<PatchId, 3> result;
    for (const auto halfedge : mesh.fh_range(OpenMesh::FaceHandle(static_cast<int>(patch.value)))) {
        const auto from = static_cast<std::uint32_t>(mesh.from_vertex_handle(halfedge).idx());
        const auto across = mesh.opposite_face_handle(halfedge);
        for (std::size_t k = 0; k < 3; ++k)
            if (c[k].value == from && across.is_valid()) result[k] = PatchId(static_cast<std::size_t>(across.idx()));
    }
    return result;
}

bool PatchMesh::on_border(VertexId vertex) const
{
    return topology_->mesh.is_boundary(OpenMesh::VertexHandle(static_cast<int>(vertex.value)));
}

std::vector<PatchId> PatchMesh::patches_around(VertexId vertex) const
{
    std::vector<PatchId> around;
    for (const auto face : topology_->mesh.vf_range(OpenMesh::VertexHandle(static_cast<int>(vertex.value))))
        around.emplace_back(static_cast<std::size_t>(face.idx()));
    std::sort(around.begin(), around.end());
    return around;
}

}  // namespace patchlight
