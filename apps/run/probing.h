#pragma once

#include "apps/run/stored_solution.h"
#include "solver/element_light.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// A CSV of points that can't be understood (exit 2): file, line, cause.
class PointsError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A point to probe, in the coordinates of the scene's file.
struct ProbePoint {
    Vec3 position{0.0};
    std::optional<Vec3> normal;             ///< the side that is asked for, any length > 0
    std::array<std::string, 3> as_written;  ///< x, y, z as they stand in the file
    std::optional<Rgb> B{};                 ///< what is known there, W/m²
};

/// Reads x,y,z[,nx,ny,nz] rows. A first line with names is a header: columns are then found by name, Br,Bg,Bb too, and
/// others left out. Blank lines are left out. Throws PointsError.
std::vector<ProbePoint> read_points(std::string_view text, const std::string& name);

/// What a point shows.
struct ProbeAnswer {
    Rgb B{0.0};  ///< W/m², the elements' reconstruction
    SurfaceId surface;
};

/// Radiosity at points of the surfaces.
class SurfaceProbe {
public:
    /// `solution` must live as long as this.
    explicit SurfaceProbe(const StoredSolution& solution);

    /// The radiosity at a point; nothing when it is further than 1e-6 × diameter from every surface that faces
    /// `normal` (every surface, without a normal). Of several surfaces there the one that faces the normal best
    /// answers, without a normal the nearest, then the first.
    std::optional<ProbeAnswer> at(const ProbePoint& point) const;

    /// All of them, in order, on all threads.
    std::vector<std::optional<ProbeAnswer>> at(const std::vector<ProbePoint>& points) const;

private:
    struct Facet {
        Vec3 low, high;  ///< its bounding box
        std::array<Vec3, 3> corners;
        SurfaceId front, back;
    };

    ProbeAnswer answer(SurfaceId surface, const Vec3& p) const;

    const StoredSolution& solution_;
    PatchLocator locator_;
    std::vector<Facet> facets_;
    double reach_ = 0;
};

/// x,y,z,Br,Bg,Bb,surface: a header and one row a point; empty values where there is no answer.
std::string probe_csv(const std::vector<ProbePoint>& points, const std::vector<std::optional<ProbeAnswer>>& answers);

}  // namespace patchlight
