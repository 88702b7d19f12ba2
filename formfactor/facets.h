#pragma once

#include "meshing/scene.h"

#include <span>
#include <vector>

namespace patchlight {

/// A planar convex polygon that light leaves and reaches, as form factors between polygons take it.
struct Facet {
    std::vector<Vec3> corners;  ///< counter-clockwise seen from the front, none collinear
    Vec3 normal{0.0};           ///< unit, of the front
    double area = 0;            ///< m²
    SurfaceId surface;
};

/// A surface cut into convex facets: its polygon itself where that is convex, else the scene's triangles over it,
/// joined across their edges as long as the result stays convex [HertelMehlhorn83].
std::vector<Facet> facets_of(const Scene& scene, SurfaceId surface);

/// All surfaces of an object, in their order.
std::vector<Facet> facets_of(const Scene& scene, ObjectId object);

/// All surfaces of the scene, in their order.
std::vector<Facet> facets_of(const Scene& scene);

/// m².
double total_area(std::span<const Facet> facets);

}  // namespace patchlight
