#include "meshing/refinement.h"
#include "meshing/union_find.h"

#include <algorithm>
#include <map>
#include <set>
#include <tbb/parallel_for.h>

namespace patchlight {

namespace {

using Polygon = std::vector<Vec2>;

std::array<Vec2, 3> flat(const PatchMesh& mesh, PatchId patch)
{
    const auto c = mesh.corners(patch);
    return {mesh.plane_position(c[0]), mesh.plane_position(c[1]), mesh.plane_position(c[2])};
}

/// Area common to two counter-clockwise triangles (Sutherland–Hodgman).
double common_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b)
{
    Polygon polygon(a.begin(), a.end()), next;
    for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
        const Vec2 &from = b[k], &to = b[(k + 1) % 3];
        next.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            const double dp = cross2(from, to, p), dq = cross2(from, to, q);
            if (dp >= 0) next.push_back(p);
            if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) next.push_back(p + (dp / (dp - dq)) * (q - p));
        }
        polygon.swap(next);
    }
    double twice = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) twice += cross2(polygon[0], polygon[i - 1], polygon[i]);
    return 0.5 * std::max(0.0, twice);
}

/// The copies of a vertex where contact lines are cut open: a new patch may lie across the end of such a cut.
class Copies {
public:
    explicit Copies(const PatchMesh& mesh)
    {
        UnionFind same(mesh.vertex_count());
        std::set<VertexId> cut;
        for (const MeshLine& line : mesh.lines())
            for (std::size_t k = 0; k < 2; ++k) {
                same.join(line.left[k], line.right[k]);
                if (line.left[k] != line.right[k]) cut.insert({VertexId(line.left[k]), VertexId(line.right[k])});
            }
        std::map<std::uint32_t, std::vector<VertexId>> together;
        for (const VertexId v : cut) together[same.root(v.value)].push_back(v);
        for (const VertexId v : cut) of_[v] = together[same.root(v.value)];
    }

    std::vector<VertexId> of(VertexId vertex) const
    {
        const auto found = of_.find(vertex);
        return found == of_.end() ? std::vector{vertex} : found->second;
    }

private:
    std::map<VertexId, std::vector<VertexId>> of_;
};

/// The old patches that a new one overlaps, found by walking over neighbours from the one under its centroid.
std::vector<PatchTransfer::Overlap> overlaps_of(const PatchMesh& old_mesh, const Copies& copies,
                                                const PatchLocator& locator, const PatchMesh& new_mesh, PatchId patch)
{
    const auto triangle = flat(new_mesh, patch);
    const Vec2 middle = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    std::vector<PatchId> walk{
        locator.locate(new_mesh.surface(patch), static_cast<float>(middle.x), static_cast<float>(middle.y))};
    std::vector<PatchTransfer::Overlap> found;
    double covered = 0;
    const double area = new_mesh.area(patch);
    for (std::size_t i = 0; i < walk.size() && covered < area * (1 - 1e-12); ++i) {
        const double common = common_area(triangle, flat(old_mesh, walk[i]));
        if (!(common > 1e-14 * area) && i > 0) continue;
        found.push_back({walk[i], common});
        covered += common;
        for (const VertexId corner : old_mesh.corners(walk[i]))
            for (const VertexId copy : copies.of(corner))
                for (const PatchId around : old_mesh.patches_around(copy))
                    if (std::find(walk.begin(), walk.end(), around) == walk.end()) walk.push_back(around);
    }
    // What rounding at the surface's border left out goes where the rest is.
    for (auto& overlap : found) overlap.area = covered > 0 ? overlap.area * (area / covered) : area;
    return found;
}

}  // namespace

PatchTransfer overlap(const PatchMesh& old_mesh, const PatchLocator& old_locator, const PatchMesh& new_mesh)
{
    std::vector<std::vector<PatchTransfer::Overlap>> rows(new_mesh.patch_count());
    const Copies copies(old_mesh);
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
        rows[i] = overlaps_of(old_mesh, copies, old_locator, new_mesh, PatchId(i));
    });
    PatchTransfer transfer;
    transfer.start.reserve(rows.size() + 1);
    for (const auto& row : rows) {
        transfer.start.push_back(static_cast<std::uint32_t>(transfer.overlaps.size()));
        transfer.overlaps.insert(transfer.overlaps.end(), row.begin(), row.end());
    }
    transfer.start.push_back(static_cast<std::uint32_t>(transfer.overlaps.size()));
    return transfer;
}

}  // namespace patchlight
