#include "meshing/contact_lines.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

using Piece = std::pair<std::uint32_t, std::uint32_t>;  ///< scene vertices, ascending

struct EdgeUse {
    Piece edge;
    std::uint32_t triangle;
    std::uint32_t third;  ///< the triangle's other vertex
    auto operator<=>(const EdgeUse&) const = default;
};

std::vector<EdgeUse> edge_uses(const Scene& scene)
{
    std::vector<EdgeUse> uses;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto& v = scene.triangles[t].vertices;
        for (std::size_t k = 0; k < 3; ++k) uses.push_back({std::minmax(v[k], v[(k + 1) % 3]), t, v[(k + 2) % 3]});
    }
    std::sort(uses.begin(), uses.end());
    return uses;
}

/// The surfaces that lie on both sides of an edge.
std::vector<SurfaceId> surfaces_around(std::span<const EdgeUse> edge, const Scene& scene)
{
    std::vector<SurfaceId> sides, twice;
    for (const EdgeUse& use : edge) {
        const SceneTriangle& t = scene.triangles[use.triangle];
        for (const SurfaceId side : {t.front, t.back}) {
            if (side.valid()) sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t k = 0; k + 1 < sides.size(); ++k) {
        if (sides[k] == sides[k + 1]) twice.push_back(sides[k]);
    }
    return twice;
}

std::map<SurfaceId, std::set<Piece>> contact_pieces(const Scene& scene, double snap)
{
    std::map<SurfaceId, std::set<Piece>> pieces;
    const std::vector<EdgeUse> uses = edge_uses(scene);
    for (std::size_t first = 0; first < uses.size();) {
        std::size_t last = first;
        while (last < uses.size() && uses[last].edge == uses[first].edge) ++last;
        const std::span edge(uses.data() + first, last - first);
        first = last;
        if (edge.size() < 3) continue;
        for (const SurfaceId id : surfaces_around(edge, scene)) {
            const PlaneFrame& frame = scene.surface(id).frame;
            const bool stands = std::any_of(edge.begin(), edge.end(), [&](const EdgeUse& use) {
                return glm::dot(scene.vertices[use.third] - frame.origin, frame.n) > snap;
            });
            if (stands) pieces[id].insert(edge[0].edge);
        }
    }
    return pieces;
}

/// Chains the pieces of one surface.
class Chains {
public:
    Chains(const std::set<Piece>& pieces, const std::vector<Vec3>& vertices, double snap)
        : left_(pieces), vertices_(vertices), snap_(snap)
    {
        for (const auto& [a, b] : pieces) {
            around_[a].push_back(b);
            around_[b].push_back(a);
        }
    }

    /// The ends of the chain that the first piece left is part of, which are taken away; none when nothing is left.
    std::optional<Piece> take();

private:
    bool straight(const std::vector<std::uint32_t>& chain, std::uint32_t next) const;
    void extend(std::vector<std::uint32_t>& chain);

    std::set<Piece> left_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> around_;
    const std::vector<Vec3>& vertices_;
    double snap_;
};

/// Whether all of the chain lies on the segment from its start to the next vertex.
bool Chains::straight(const std::vector<std::uint32_t>& chain, std::uint32_t next) const
{
    const Vec3 &start = vertices_[chain.front()], d = vertices_[next] - start;
    double reached = 0;
    return std::all_of(chain.begin() + 1, chain.end(), [&](std::uint32_t v) {
        const double along = glm::dot(vertices_[v] - start, d) / glm::dot(d, d);
        const bool forward = along > reached && along < 1;
        reached = along;
        return forward && glm::distance(vertices_[v], start + along * d) <= snap_;
    });
}

void Chains::extend(std::vector<std::uint32_t>& chain)
{
    for (bool longer = true; longer;) {
        longer = false;
        const std::uint32_t end = chain.back();
        for (const std::uint32_t next : around_.at(end)) {
            if (!left_.contains(std::minmax(end, next)) || !straight(chain, next)) continue;
            left_.erase(std::minmax(end, next));
            chain.push_back(next);
            longer = true;
            break;
        }
    }
}

std::optional<Piece> Chains::take()
{
    if (left_.empty()) return {};
    std::vector<std::uint32_t> chain{left_.begin()->first, left_.begin()->second};
    left_.erase(left_.begin());
    extend(chain);
    std::reverse(chain.begin(), chain.end());
    extend(chain);
    return std::minmax(chain.front(), chain.back());
}

}  // namespace

std::vector<SurfaceLine> find_contact_lines(const Scene& scene, double snap)
{
    std::vector<SurfaceLine> lines;
    for (const auto& [id, pieces] : contact_pieces(scene, snap)) {
        Chains chains(pieces, scene.vertices, snap);
        const auto at = [&, id = id](std::uint32_t v) { return scene.surface(id).frame.to_plane(scene.vertices[v]); };
        while (const auto ends = chains.take())
            lines.push_back({id, LineKind::contact, at(ends->first), at(ends->second)});
    }
    std::sort(lines.begin(), lines.end(), [](const SurfaceLine& a, const SurfaceLine& b) {
        return std::tie(a.surface, a.start.x, a.start.y, a.end.x, a.end.y) <
               std::tie(b.surface, b.start.x, b.start.y, b.end.x, b.end.y);
    });
    return lines;
}

}  // namespace patchlight
