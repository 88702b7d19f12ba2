#pragma once

#include "solver/element_light.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// A solution held against measured points of the surfaces.
namespace patchlight::verification {

/// The reflected part of B at a point, with its standard error; file coordinates.
struct ReferencePoint {
    Vec3 position{0.0}, normal{0.0};
    Rgb B{0.0}, standard_error{0.0};
};

/// Reads data/reference/*-points.csv: comment lines, a header, x,y,z,nx,ny,nz,Br,Bg,Bb,se_r,se_g,se_b,object.
inline std::vector<ReferencePoint> read_reference_points(const std::filesystem::path& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error("no reference " + file.string());
    std::vector<ReferencePoint> points;
    for (std::string line; std::getline(in, line);) {
        if (line.empty() || line[0] == '#' || line[0] == 'x') continue;
        std::array<double, 12> value{};
        std::stringstream fields(line);
        for (double& x : value) {
            std::string field;
            std::getline(fields, field, ',');
            x = std::stod(field);
        }
        points.push_back({{value[0], value[1], value[2]},
                          {value[3], value[4], value[5]},
                          {value[6], value[7], value[8]},
                          {value[9], value[10], value[11]}});
    }
    return points;
}

/// The linear reconstruction of B at a point of a surface (file coordinates, the normal picks the side); nothing where
/// there is no surface: a covered part.
inline std::optional<Rgb> radiosity_at(const Scene& scene, const PatchMesh& mesh, const PatchLocator& locator,
                                       const VertexRadiosity& B, const Vec3& file_position, const Vec3& normal)
{
    const Vec3 p = file_position * scene.unit - scene.center;
    PatchId best;
    double nearest = 1e-6 * scene.diameter;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        const PlaneFrame& frame = scene.surfaces[s].frame;
        const double height = std::abs(glm::dot(p - frame.origin, frame.n));
        if (height > nearest || glm::dot(normal, frame.n) < 0.9) continue;
        const Vec2 q = frame.to_plane(p);
        const PatchId patch = locator.locate(SurfaceId(s), static_cast<float>(q.x), static_cast<float>(q.y));
        const auto w = locator.barycentric(patch, q);
        const auto c = mesh.corners(patch);
        const Vec3 found = w[0] * mesh.position(c[0]) + w[1] * mesh.position(c[1]) + w[2] * mesh.position(c[2]);
        if (glm::distance(found, p) <= 1e-6 * scene.diameter) best = patch;
    }
    if (!best.valid()) return {};
    return ElementLight{mesh, locator, B}.at(best, scene.surface(mesh.surface(best)).frame.to_plane(p));
}

struct PointError {
    double relative_l2 = 0;   ///< design.md's error: √(Σ|B̃−B|² / Σ|B|²), three bands together
    double relative_rms = 0;  ///< √mean((B̃/B−1)²) over points and bands with B above a thousandth of its mean
};

inline PointError point_error(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& B,
                              const std::vector<ReferencePoint>& points)
{
    const PatchLocator locator(mesh);
    double num = 0, den = 0, relative = 0, mean = 0;
    for (const auto& point : points)
        mean += (point.B.r + point.B.g + point.B.b) / (3.0 * static_cast<double>(points.size()));
    std::size_t counted = 0;
    for (const auto& point : points) {
        const auto answer = radiosity_at(scene, mesh, locator, B, point.position, point.normal);
        if (!answer && point.B != Rgb(0.0)) throw std::runtime_error("a reference point lies on no surface");
        const Rgb found = answer.value_or(Rgb(0.0));
        for (int band = 0; band < 3; ++band) {
            const double d = found[band] - point.B[band];
            num += d * d;
            den += point.B[band] * point.B[band];
            if (point.B[band] < 1e-3 * mean) continue;
            relative += d * d / (point.B[band] * point.B[band]);
            ++counted;
        }
    }
    return {std::sqrt(num / den), std::sqrt(relative / static_cast<double>(counted))};
}

}  // namespace patchlight::verification
