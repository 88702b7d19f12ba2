#include "meshing/surface_triangulation.h"
#include "meshing/union_find.h"

#include <algorithm>
#include <map>
#include <utility>

namespace patchlight {

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Line = SurfaceTriangulation::Line;

/// The triangles round each vertex and beside each edge.
class Surroundings {
public:
    explicit Surroundings(const SurfaceTriangulation& triangulation) : around(triangulation.positions.size())
    {
        for (std::uint32_t t = 0; t < triangulation.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& corners = triangulation.triangles[t];
                around[corners[k]].push_back(t);
                left_of_[{corners[k], corners[(k + 1) % 3]}] = t;
            }
    }

    const std::uint32_t* left_of(std::uint32_t a, std::uint32_t b) const
    {
        const auto found = left_of_.find({a, b});
        return found == left_of_.end() ? nullptr : &found->second;
    }

    bool on_border(const SurfaceTriangulation& triangulation, std::uint32_t v) const
    {
        return std::ranges::any_of(around[v], [&](std::uint32_t t) {
            const auto& c = triangulation.triangles[t];
            const auto k = static_cast<std::size_t>(std::ranges::find(c, v) - c.begin());
            return !left_of(c[(k + 1) % 3], v) || !left_of(v, c[(k + 2) % 3]);
        });
    }

    std::vector<std::vector<std::uint32_t>> around;

private:
    std::map<Pair, std::uint32_t> left_of_;
};

/// The edge on which a line that ends at `end`, coming from `from`, goes on most nearly straight.
std::uint32_t straight_on(const PlaneFrame& frame, const SurfaceTriangulation& triangulation,
                          const Surroundings& surroundings, std::uint32_t from, std::uint32_t end)
{
    const auto at = [&](std::uint32_t v) { return frame.to_plane(triangulation.positions[v]); };
    const Vec2 way = glm::normalize(at(end) - at(from));
    std::uint32_t best = from;
    double straightest = -1;
    for (const std::uint32_t t : surroundings.around[end])
        for (const std::uint32_t v : triangulation.triangles[t]) {
            if (v == end || v == from) continue;
            const double cosine = glm::dot(way, glm::normalize(at(v) - at(end)));
            if (cosine > straightest || (cosine == straightest && v < best)) {
                straightest = cosine;
                best = v;
            }
        }
    return best;
}

/// Contact edges, and the edges that continue those which end inside the surface.
std::vector<std::pair<Line, bool>> cuts_of(const PlaneFrame& frame, const SurfaceTriangulation& triangulation,
                                           const Surroundings& surroundings)
{
    std::vector<std::pair<Line, bool>> cuts;
    std::map<std::uint32_t, std::vector<std::uint32_t>> partners;
    for (const Line& line : triangulation.lines) {
        if (line.kind != LineKind::contact) continue;
        cuts.emplace_back(line, false);
        partners[line.vertices[0]].push_back(line.vertices[1]);
        partners[line.vertices[1]].push_back(line.vertices[0]);
    }
    for (const auto& [end, from] : partners) {
        if (from.size() != 1 || surroundings.on_border(triangulation, end)) continue;
        const std::uint32_t next = straight_on(frame, triangulation, surroundings, from[0], end);
        if (next != from[0]) cuts.push_back({{{end, next}, LineKind::contact}, true});
    }
    return cuts;
}

}  // namespace

CutTriangulation cut_contacts(const PlaneFrame& frame, const SurfaceTriangulation& triangulation)
{
    CutTriangulation cut{triangulation.positions, triangulation.triangles, {}};
    const Surroundings surroundings(triangulation);
    const auto cuts = cuts_of(frame, triangulation, surroundings);
    std::map<Pair, bool> is_cut;
    std::vector<std::uint32_t> touched;
    for (const auto& [line, beyond] : cuts) {
        is_cut[std::minmax(line.vertices[0], line.vertices[1])] = true;
        touched.insert(touched.end(), line.vertices.begin(), line.vertices.end());
    }
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());

    for (const std::uint32_t v : touched) {
        // Triangles round the vertex hang together over edges that aren't cut: each such fan has its own copy.
        const auto& fan = surroundings.around[v];
        UnionFind fans(fan.size());
        for (std::size_t i = 0; i < fan.size(); ++i)
            for (const std::uint32_t w : triangulation.triangles[fan[i]]) {
                if (w == v || is_cut.contains(std::minmax(v, w))) continue;
                for (const std::uint32_t* other : {surroundings.left_of(v, w), surroundings.left_of(w, v)})
                    if (other)
                        fans.join(static_cast<std::uint32_t>(i),
                                  static_cast<std::uint32_t>(std::ranges::find(fan, *other) - fan.begin()));
            }
        std::map<std::uint32_t, std::uint32_t> copy_of;
        for (std::size_t i = 0; i < fan.size(); ++i) {
            const std::uint32_t root = fans.root(static_cast<std::uint32_t>(i));
            const auto next = copy_of.empty() ? v : static_cast<std::uint32_t>(cut.positions.size());
            const auto [copy, added] = copy_of.try_emplace(root, next);
            if (added && next != v) cut.positions.push_back(triangulation.positions[v]);
            std::ranges::replace(cut.triangles[fan[i]], v, copy->second);
        }
    }
    const auto named_by = [&](std::uint32_t triangle, std::uint32_t v) {
        const auto& before = triangulation.triangles[triangle];
        return cut.triangles[triangle][static_cast<std::size_t>(std::ranges::find(before, v) - before.begin())];
    };
    const auto add = [&](const Line& line, bool beyond) {
        const auto [a, b] = line.vertices;
        const std::uint32_t left = *surroundings.left_of(a, b), right = *surroundings.left_of(b, a);
        cut.lines.push_back(
            {line.kind, {named_by(left, a), named_by(left, b)}, {named_by(right, a), named_by(right, b)}, beyond});
    };
    for (const Line& line : triangulation.lines) add(line, false);
    for (const auto& [line, beyond] : cuts)
        if (beyond) add(line, true);
    return cut;
}

SurfaceTriangulation triangulation_of(const PatchMesh& mesh, SurfaceId surface)
{
    const auto vertices = mesh.vertices_of(surface);
    const auto local = [&](std::uint32_t v) { return v - vertices.first; };
    UnionFind copies(vertices.size());
    SurfaceTriangulation result;
    for (const MeshLine& line : mesh.lines_of(surface)) {
        for (std::size_t k = 0; k < 2; ++k) copies.join(local(line.left[k]), local(line.right[k]));
    }
    std::vector<std::uint32_t> named(vertices.size());
    std::map<std::uint32_t, std::uint32_t> name_of_root;
    for (const VertexId v : vertices) {
        const auto [name, added] =
            name_of_root.try_emplace(copies.root(local(v.value)), static_cast<std::uint32_t>(result.positions.size()));
        if (added) result.positions.push_back(mesh.position(v));
        named[local(v.value)] = name->second;
    }
    for (const PatchId p : mesh.patches_of(surface)) {
        const auto c = mesh.corners(p);
        result.triangles.push_back({named[local(c[0].value)], named[local(c[1].value)], named[local(c[2].value)]});
    }
    for (const MeshLine& line : mesh.lines_of(surface))
        if (!line.beyond) result.lines.push_back({{named[local(line.left[0])], named[local(line.left[1])]}, line.kind});
    return result;
}

}  // namespace patchlight
