#include "formfactor/facet_points.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace patchlight {

namespace {

bool is_parallelogram(std::span<const Vec3> corners)
{
    if (corners.size() != 4) return false;
    const Vec3 gap = corners[0] + corners[2] - corners[1] - corners[3], diagonal = corners[2] - corners[0];
    return glm::dot(gap, gap) <= 1e-20 * glm::dot(diagonal, diagonal);
}

}  // namespace

FacetPoints::FacetPoints(std::span<const Facet> facets)
{
    for (std::size_t f = 0; f < facets.size(); ++f) add(facets[f].corners, f);
    divide();
}

FacetPoints::FacetPoints(std::span<const Vec3> polygon)
{
    add(polygon, 0);
    divide();
}

void FacetPoints::divide()
{
    if (!(area_ > 0)) throw std::invalid_argument("a form factor needs facets with an area on both sides");
    for (Piece& piece : pieces_) piece.until /= area_;
}

void FacetPoints::add(std::span<const Vec3> p, std::size_t index)
{
    const bool parallelogram = is_parallelogram(p);
    for (std::size_t k = 2; k < (parallelogram ? 3 : p.size()); ++k) {
        const Vec3 edge0 = p[k - 1] - p[0], edge1 = (parallelogram ? p[3] : p[k]) - p[0];
        area_ += (parallelogram ? 1 : 0.5) * glm::length(glm::cross(edge0, edge1));
        pieces_.push_back({p[0], edge0, edge1, area_, index, parallelogram});
    }
}

FacetPoint FacetPoints::at(double u, double v) const
{
    const auto found = std::upper_bound(pieces_.begin(), pieces_.end() - 1, u,
                                        [](double x, const Piece& piece) { return x < piece.until; });
    const double from = found == pieces_.begin() ? 0 : std::prev(found)->until;
    const double within = std::clamp((u - from) / (found->until - from), 0.0, 1.0);
    if (found->parallelogram) return {found->corner + within * found->edge0 + v * found->edge1, found->facet};
    const double root = std::sqrt(within);
    return {found->corner + root * (1 - v) * found->edge0 + root * v * found->edge1, found->facet};
}

}  // namespace patchlight
