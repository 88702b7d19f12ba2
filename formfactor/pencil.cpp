#include "formfactor/pencil.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

constexpr double least_width = 1e-12;  ///< of t: narrower is rounding

double w_at(const PencilCut& cut, double t)
{
    return cut.w0 + (t - cut.t0) / (cut.t1 - cut.t0) * (cut.w1 - cut.w0);
}

/// window minus the union of `blocked`, which is sorted on the way.
void subtract(Span window, std::vector<Span>& blocked, std::vector<Span>& free)
{
    std::ranges::sort(blocked, {}, &Span::from);
    free.clear();
    double from = window.from;
    for (const Span& b : blocked) {
        if (b.from > from + least_width) free.push_back({from, std::min(b.from, window.to)});
        from = std::max(from, b.to);
        if (from >= window.to) return;
    }
    if (window.to > from + least_width) free.push_back({from, window.to});
}

}  // namespace

Pencil::Pencil(const FacetTree& tree, std::span<const Facet> facets, const Vec3& apex, const std::array<Vec3, 2>& base,
               double snap)
    : tree_(&tree), facets_(facets), apex_(apex), e0_(base[0] - apex), e1_(base[1] - apex), snap_(snap)
{
    const Vec3 normal = glm::cross(e0_, e1_);
    const double twice = glm::length(normal), along = glm::length(e1_ - e0_);
    const double longest = std::max({along, glm::length(e0_), glm::length(e1_)});
    if (!(twice > snap * longest)) return;
    valid_ = true;
    n_ = normal / twice;
    alpha_ = glm::cross(e1_, n_) / twice;
    beta_ = glm::cross(n_, e0_) / twice;
    height_ = glm::dot(n_, apex);
    reach_ = twice / along;
}

double Pencil::parameter_in(const Vec3& normal) const
{
    const double h0 = glm::dot(normal, e0_), h1 = glm::dot(normal, e1_);
    return (h0 < 0) == (h1 < 0) || h0 == h1 ? -1 : h0 / (h0 - h1);
}

Span Pencil::window_through(const std::array<Vec3, 2>& segment) const
{
    Span window{1, 0};
    for (const Vec3& p : segment) {
        const double a = glm::dot(alpha_, p - apex_), b = glm::dot(beta_, p - apex_);
        if (!(a + b > 0) || !(a + b < 1)) return {1, 0};
        const double t = std::clamp(b / (a + b), 0.0, 1.0);
        window = {std::min(window.from, t), std::max(window.to, t)};
    }
    return window;
}

bool Pencil::is_open(const std::array<Vec3, 2>& cut) const
{
    return std::ranges::any_of(open_, [&](const std::array<Vec3, 2>& edge) {
        const Vec3 along = glm::normalize(edge[1] - edge[0]);
        return std::ranges::all_of(
            cut, [&](const Vec3& p) { return glm::length(glm::cross(along, p - edge[0])) <= 2 * snap_; });
    });
}

/// The facet's cut with the plane on the side of the apex where the base is (sign 1) or on the other (−1).
bool Pencil::cut(const Facet& facet, double sign, PencilCut& result) const
{
    const Vec3 along = glm::cross(n_, facet.normal);
    std::array<Vec3, 2> ends;
    double least = 0, most = 0;
    int found = 0, zeros = 0;
    bool above = false, below = false;
    const auto add = [&](const Vec3& p) {
        const double s = glm::dot(along, p);
        if (found == 0 || s < least) least = s, ends[0] = p;
        if (found == 0 || s > most) most = s, ends[1] = p;
        ++found;
    };
    const auto snapped = [&](const Vec3& p) {
        const double h = glm::dot(n_, p) - height_;
        return std::abs(h) <= snap_ ? 0.0 : h;
    };
    Vec3 last = facet.corners.back();
    double last_height = snapped(last);
    for (const Vec3& p : facet.corners) {
        const double h = snapped(p);
        if (h * last_height < 0) add(last + (last_height / (last_height - h)) * (p - last));
        if (h == 0) add(p), ++zeros;
        above = above || h > 0;
        below = below || h < 0;
        last = p;
        last_height = h;
    }
    if (found < 2 || (!above && !below)) return false;
    result.sides = (above ? 1U : 0U) | (below ? 2U : 0U);

    if (result.sides != 3 && is_open(ends)) return false;
    const Vec3 p = ends[0] - apex_, q = ends[1] - apex_, pq = q - p;
    // A cut whose line passes through the apex is seen end on.
    if (!(glm::length(glm::cross(p, pq)) > snap_ * glm::length(pq))) return false;
    double a0 = sign * glm::dot(alpha_, p), b0 = sign * glm::dot(beta_, p);
    double a1 = sign * glm::dot(alpha_, q), b1 = sign * glm::dot(beta_, q);
    double from = 0, to = 1;
    for (const auto& [w0, w1] : {std::pair(a0, a1), std::pair(b0, b1)}) {
        if (w0 < 0 && w1 < 0) return false;
        if (w0 < 0) from = std::max(from, w0 / (w0 - w1));
        if (w1 < 0) to = std::min(to, w0 / (w0 - w1));
    }
    if (!(to > from)) return false;
    const auto place = [&](double s, double& t, double& w) {
        const double a = std::max(0.0, a0 + s * (a1 - a0)), b = std::max(0.0, b0 + s * (b1 - b0));
        w = 1 / (a + b);
        t = b * w;
    };
    place(from, result.t0, result.w0);
    place(to, result.t1, result.w1);
    if (result.t0 > result.t1) {
        std::swap(result.t0, result.t1);
        std::swap(result.w0, result.w1);
    }
    return result.t1 - result.t0 > least_width && std::isfinite(result.w0) && std::isfinite(result.w1);
}

void Pencil::collect(Part part, Span window, std::vector<PencilCut>& cuts) const
{
    const double sign = part == Part::past_apex ? -1 : 1;
    const Vec3 sum = alpha_ + beta_;
    const Vec3 low = sign * (beta_ - window.from * sum), high = sign * (window.to * sum - beta_);
    const auto from_apex = [&](const Vec3& normal, double offset) {
        return FacetTree::HalfSpace{normal, glm::dot(normal, apex_) + offset - snap_ * glm::length(normal)};
    };
    const std::array<FacetTree::HalfSpace, 5> region{from_apex(n_, 0), from_apex(-n_, 0), from_apex(low, 0),
                                                     from_apex(high, 0),
                                                     part == Part::to_base ? from_apex(-sum, -1) : from_apex(sum, 1)};
    cuts.clear();
    PencilCut found;
    const double enough = 1 + 8 * snap_ / reach_;  // one that covers all will do
    tree_->visit(std::span(region).first(part == Part::to_base || part == Part::past_base ? 5 : 4),
                 [&](std::uint32_t f) {
                     if (!cut(facets_[f], sign, found)) return true;
                     found.facet = f;
                     const bool closes = part == Part::to_base && found.sides == 3 && found.t0 <= window.from &&
                                         found.t1 >= window.to && found.w0 >= enough && found.w1 >= enough;
                     if (closes) cuts.clear();
                     cuts.push_back(found);
                     return !closes;
                 });
}

/// The parts of `window` in which no cut of this side reaches `least` in 1/μ: scratch.free.
void Pencil::block(std::span<const PencilCut> cuts, unsigned side, double least, Span window,
                   PencilScratch& scratch) const
{
    scratch.blocked.clear();
    for (const PencilCut& c : cuts) {
        if ((c.sides & side) == 0 || (c.w0 < least && c.w1 < least)) continue;
        Span part{c.t0, c.t1};
        const double until = c.t0 + (c.t1 - c.t0) * (c.w0 == c.w1 ? 0 : (least - c.w0) / (c.w1 - c.w0));
        if (c.w0 < least) part.from = until;
        if (c.w1 < least) part.to = until;
        if (part.to > part.from) scratch.blocked.push_back(part);
    }
    subtract(window, scratch.blocked, scratch.free[side - 1]);
}

void Pencil::beyond(Span window, PencilScratch& scratch) const
{
    scratch.hits.clear();
    collect(Part::to_base, window, scratch.cuts);
    for (const unsigned side : {1U, 2U}) block(scratch.cuts, side, 1 - 4 * snap_ / reach_, window, scratch);
    trace(Part::past_base, window, scratch);
}

void Pencil::opposite(Span window, PencilScratch& scratch) const
{
    scratch.hits.clear();
    collect(Part::to_base, window, scratch.cuts);
    for (const unsigned side : {1U, 2U}) block(scratch.cuts, side, 1 + 4 * snap_ / reach_, window, scratch);
    trace(Part::past_apex, window, scratch);
}

void Pencil::backward(Span window, PencilScratch& scratch) const
{
    scratch.hits.clear();
    for (std::vector<Span>& free : scratch.free) free.assign({window});
    trace(Part::past_apex, window, scratch);
}

void Pencil::outward(Span window, PencilScratch& scratch) const
{
    scratch.hits.clear();
    scratch.free[0].assign({window});
    scratch.free[1].clear();
    trace(Part::all, window, scratch);
}

/// What the light of the free rays meets.
void Pencil::trace(Part part, Span window, PencilScratch& scratch) const
{
    Span hull{window.to, window.from};
    for (const auto& free : scratch.free) {
        if (free.empty()) continue;
        hull.from = std::min(hull.from, free.front().from);
        hull.to = std::max(hull.to, free.back().to);
    }
    if (hull.from >= hull.to) return;
    collect(part, hull, scratch.cuts);
    std::ranges::sort(scratch.cuts,
                      [](const auto& a, const auto& b) { return std::pair(a.t0, a.facet) < std::pair(b.t0, b.facet); });
    for (const unsigned side : {1U, 2U})
        for (const Span& free : scratch.free[side - 1]) nearest(free, side, scratch);
}

/// The upper envelope of 1/μ over the cuts.
void Pencil::nearest(Span window, unsigned side, PencilScratch& scratch) const
{
    std::vector<double>& stops = scratch.stops;
    stops.assign({window.from, window.to});
    for (const PencilCut& c : scratch.cuts) {
        if ((c.sides & side) == 0) continue;
        for (const double t : {c.t0, c.t1})
            if (t > window.from && t < window.to) stops.push_back(t);
    }
    std::ranges::sort(stops);
    scratch.active.clear();
    std::size_t next = 0;
    for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        const double from = stops[k], to = stops[k + 1];
        if (to - from <= least_width) continue;
        const double middle = 0.5 * (from + to);
        for (; next < scratch.cuts.size() && scratch.cuts[next].t0 < middle; ++next)
            if ((scratch.cuts[next].sides & side) != 0) scratch.active.push_back(scratch.cuts[next]);
        std::erase_if(scratch.active, [&](const PencilCut& c) { return c.t1 < middle; });
        if (!scratch.active.empty()) nearest_between(from, to, scratch);
    }
}

/// The same where all active cuts run through.
void Pencil::nearest_between(double from, double to, PencilScratch& scratch) const
{
    const std::vector<PencilCut>& active = scratch.active;
    const auto ends = [&](const PencilCut& c) { return std::pair(w_at(c, from), w_at(c, to)); };
    std::size_t current = 0;
    for (std::size_t j = 1; j < active.size(); ++j)
        if (ends(active[j]) > ends(active[current])) current = j;
    double at = 0;
    for (std::size_t step = 0; step <= active.size(); ++step) {
        const auto [c0, c1] = ends(active[current]);
        double until = 1;
        std::size_t following = current;
        for (std::size_t j = 0; j < active.size(); ++j) {
            const auto [j0, j1] = ends(active[j]);
            if (!(j1 - j0 > c1 - c0) || !(j1 > c1)) continue;
            const double f = std::max(at, (c0 - j0) / ((c0 - j0) + (j1 - c1)));
            if (f < until || (f == until && following != current && j1 > ends(active[following]).second)) {
                until = f;
                following = j;
            }
        }
        const double t0 = from + at * (to - from), t1 = from + until * (to - from);
        if (t1 - t0 > least_width)
            for (const PencilCut& c : active)
                if (c.facet == active[current].facet || coincide(c, active[current], t0, t1))
                    add_hit(c.facet, t0, t1, scratch);
        if (following == current) return;
        current = following;
        at = until;
    }
}

/// Whether two cuts are the same within the snap between two parameters.
bool Pencil::coincide(const PencilCut& a, const PencilCut& b, double from, double to) const
{
    return std::ranges::all_of(std::array{from, to}, [&](double t) {
        const double wa = w_at(a, t), wb = w_at(b, t);
        return std::abs(wa - wb) * glm::length(direction(t)) <= 2 * snap_ * wa * wb;
    });
}

void Pencil::add_hit(std::uint32_t facet, double from, double to, PencilScratch& scratch)
{
    for (std::size_t k = scratch.hits.size(); k-- > 0;) {
        PencilHit& hit = scratch.hits[k];
        if (hit.facet != facet || hit.t.to != from) continue;
        hit.t.to = to;
        return;
    }
    scratch.hits.push_back({facet, {from, to}});
}

}  // namespace patchlight
