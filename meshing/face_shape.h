#pragma once

#include "meshing/vectors.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// How a polygon lies in space.
struct FaceShape {
    Vec3 normal{0.0};         ///< unit; of a polygon that crosses itself, that of its larger part
    double area = 0;          ///< of the loop, m²
    double length = 0;        ///< about its longest extent, m
    double width = 0;         ///< across that, m: 0 when all corners lie on a line
    double out_of_plane = 0;  ///< largest distance of a corner from the mean plane, m
};

/// Without repeated neighbours and without spikes (a, b, a), begun at its smallest index. May come back with
/// fewer than three corners.
std::vector<std::uint32_t> canonical_loop(std::vector<std::uint32_t> loop);

FaceShape shape_of(const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& vertices);

/// Cuts a polygon that isn't planar: a quadrilateral at its shorter diagonal, others ear by ear as seen along the
/// normal.
std::vector<std::array<std::uint32_t, 3>> cut_into_triangles(const std::vector<std::uint32_t>& loop,
                                                             const std::vector<Vec3>& vertices, const Vec3& normal);

}  // namespace patchlight
