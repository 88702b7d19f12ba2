#include "meshing/trace_loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace patchlight {

namespace {

using Loop = std::vector<std::uint32_t>;
using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// A region's border in its plane.
class Border {
public:
    Border(std::vector<DirectedEdge> edges, const PlaneFrame& frame, const std::vector<Vec3>& vertices)
        : edges_(std::move(edges)), used_(edges_.size(), false)
    {
        std::sort(edges_.begin(), edges_.end());
        for (const auto& [a, b] : edges_) at_.try_emplace(a, frame.to_plane(vertices[a]));
        for (const auto& [a, b] : edges_) at_.try_emplace(b, frame.to_plane(vertices[b]));
    }

    std::vector<Loop> loops();
    const Vec2& at(std::uint32_t v) const { return at_.at(v); }
    double twice_area(const Loop& loop) const;

private:
    std::size_t next_edge(std::uint32_t from, std::uint32_t via) const;

    std::vector<DirectedEdge> edges_;
    std::vector<bool> used_;
    std::map<std::uint32_t, Vec2> at_;
};

double Border::twice_area(const Loop& loop) const
{
    double sum = 0;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) sum += cross2(at(loop[0]), at(loop[k]), at(loop[k + 1]));
    return sum;
}

/// Of the unused edges that leave `via`, the one most to the right: so a loop keeps clear of the holes that touch it.
std::size_t Border::next_edge(std::uint32_t from, std::uint32_t via) const
{
    const auto first = std::lower_bound(edges_.begin(), edges_.end(), DirectedEdge{via, 0});
    std::size_t best = edges_.size();
    double best_turn = 0;
    const Vec2 arriving = at(via) - at(from);
    for (auto edge = first; edge != edges_.end() && edge->first == via; ++edge) {
        const auto index = static_cast<std::size_t>(edge - edges_.begin());
        if (used_[index]) continue;
        const Vec2 leaving = at(edge->second) - at(via);
        const double cross = arriving.x * leaving.y - arriving.y * leaving.x;
        double turn = std::atan2(cross, glm::dot(arriving, leaving));
        if (edge->second == from) turn = std::numbers::pi;
        if (best == edges_.size() || turn < best_turn) {
            best = index;
            best_turn = turn;
        }
    }
    return best;
}

std::vector<Loop> Border::loops()
{
    std::vector<Loop> result;
    for (std::size_t start = 0; start < edges_.size(); ++start) {
        if (used_[start]) continue;
        Loop path{edges_[start].first};
        std::map<std::uint32_t, std::size_t> position{{path[0], 0}};
        std::size_t edge = start;
        while (edge != edges_.size()) {
            used_[edge] = true;
            const auto [from, to] = edges_[edge];
            if (const auto seen = position.find(to); seen != position.end()) {
                const auto begin = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
                result.emplace_back(begin, path.end());
                for (auto v = begin + 1; v != path.end(); ++v) position.erase(*v);
                path.erase(begin + 1, path.end());
                if (path.size() == 1 && seen->second == 0) break;
            } else {
                position[to] = path.size();
                path.push_back(to);
            }
            edge = next_edge(from, to);
        }
    }
    return result;
}

double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b)
{
    const Vec2 d = b - a;
    const double length2 = glm::dot(d, d);
    const double t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + t * d);
}

/// Where the loop turns for certain: the corner farthest from another one.
std::size_t surest_corner(const Loop& loop, const Border& border)
{
    std::size_t best = 0;
    for (std::size_t k = 1; k < loop.size(); ++k) {
        if (glm::distance(border.at(loop[k]), border.at(loop[0])) >
            glm::distance(border.at(loop[best]), border.at(loop[0]))) {
            best = k;
        }
    }
    return best;
}

Loop without_collinear(Loop loop, const Border& border, const std::map<std::uint32_t, int>& uses, double snap)
{
    std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(surest_corner(loop, border)), loop.end());
    Loop kept{loop[0]};
    Loop skipped;
    for (std::size_t k = 1; k < loop.size(); ++k) {
        const Vec2 &anchor = border.at(kept.back()), &next = border.at(loop[(k + 1) % loop.size()]);
        skipped.push_back(loop[k]);
        const bool straight =
            uses.at(loop[k]) == 1 && std::all_of(skipped.begin(), skipped.end(), [&](std::uint32_t v) {
                return distance_to_segment(border.at(v), anchor, next) <= snap;
            });
        if (straight) continue;
        kept.push_back(loop[k]);
        skipped.clear();
    }
    return kept.size() >= 3 ? kept : loop;
}

}  // namespace

std::vector<Loop> trace_loops(std::vector<DirectedEdge> edges, const PlaneFrame& frame,
                              const std::vector<Vec3>& vertices, double snap)
{
    Border border(std::move(edges), frame, vertices);
    std::vector<Loop> loops = border.loops();
    std::map<std::uint32_t, int> uses;
    for (const Loop& loop : loops) {
        for (const std::uint32_t v : loop) ++uses[v];
    }
    for (Loop& loop : loops) {
        loop = without_collinear(std::move(loop), border, uses, snap);
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    std::sort(loops.begin(), loops.end());
    const auto outer = std::max_element(loops.begin(), loops.end(), [&](const Loop& a, const Loop& b) {
        return border.twice_area(a) < border.twice_area(b);
    });
    std::rotate(loops.begin(), outer, outer + 1);
    return loops;
}

}  // namespace patchlight
