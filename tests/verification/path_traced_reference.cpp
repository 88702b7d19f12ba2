/// Writes the reference radiosity of a scene at random points: see data/README.md for the file's columns.

#include "tests/verification/path_traced_reference_light.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace patchlight;
using namespace patchlight::reference;

struct Settings {
    std::string scene;
    std::string output;
    std::string at;  ///< a file of points; empty: random ones
    std::size_t points = 2000;
    PathOptions paths;
};

struct Row {
    SurfacePoint point;
    Measured reflected;
};

/// The point on the polygon that it lies on and whose front the normal names.
SurfacePoint placed(const ReferenceScene& scene, const Vec3& p, const Vec3& normal)
{
    for (std::size_t i = 0; i < scene.polygons().size(); ++i) {
        const Polygon& polygon = scene.polygons()[i];
        const bool in_plane = std::abs(glm::dot(polygon.n, p) - polygon.offset) < 1e-6 * scene.diameter();
        if (in_plane && glm::dot(polygon.n, normal) > 0.99 &&
            polygon.contains(Vec2(glm::dot(polygon.u, p), glm::dot(polygon.v, p))))
            return {i, p};
    }
    throw std::runtime_error(fmt::format("no surface at {} {} {}", p.x, p.y, p.z));
}

/// Lines x,y,z,nx,ny,nz and whatever follows; those that begin otherwise are left out.
std::vector<SurfacePoint> points_of(const ReferenceScene& scene, const std::string& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error("can't read " + file);
    std::vector<SurfacePoint> points;
    for (std::string line; std::getline(in, line);) {
        Vec3 p, n;
        if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &p.x, &p.y, &p.z, &n.x, &n.y, &n.z) == 6)
            points.push_back(placed(scene, p, n));
    }
    return points;
}

std::vector<Row> measure(const ReferenceScene& scene, const Settings& settings)
{
    const std::vector<SurfacePoint> points = settings.at.empty()
                                                 ? sample_points(scene, settings.points, settings.paths.seed)
                                                 : points_of(scene, settings.at);
    std::vector<Row> rows(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const Polygon& polygon = scene.polygons()[points[i].polygon];
        Measured H = measure_irradiance(scene, points[i].position, polygon.n, settings.paths, i).total;
        rows[i] = {points[i], {polygon.rho * H.mean, polygon.rho * H.standard_error}};
    });
    return rows;
}

/// Root mean square of the standard errors beside the mean of B, for each band.
std::string achieved(const std::vector<Row>& rows)
{
    Rgb squares{0.0}, mean{0.0};
    const auto n = static_cast<double>(rows.size());
    for (const Row& row : rows) {
        squares += row.reflected.standard_error * row.reflected.standard_error / n;
        mean += row.reflected.mean / n;
    }
    const Rgb error = glm::sqrt(squares) / mean;
    return fmt::format("mean of B: {:.6g} {:.6g} {:.6g} W/m2; rms standard error / mean of B: {:.3f} {:.3f} {:.3f} %",
                       mean.r, mean.g, mean.b, 100 * error.r, 100 * error.g, 100 * error.b);
}

void write(std::ostream& out, const ReferenceScene& scene, const Settings& s, const std::vector<Row>& rows)
{
    const PathOptions& p = s.paths;
    const std::string name = std::filesystem::path(s.scene).filename().string();
    const std::string points = s.at.empty() ? fmt::format("--points {}", s.points) : "--at this file";
    out << fmt::format("# path_traced_reference data/scenes/{} {} --replicates {} --light-strata {} "
                       "--direction-strata {} --seed {}\n",
                       name, points, p.replicates, p.light_strata, p.direction_strata, p.seed);
    out << fmt::format("# seed {}; a point: {} paths, {} shadow rays to each emitter\n", p.seed,
                       p.replicates * p.direction_strata * p.direction_strata,
                       p.replicates * p.light_strata * p.light_strata);
    out << "# reflected part B - E, W/m2, Ke taken as radiance; " << achieved(rows) << "\n";
    out << "x,y,z,nx,ny,nz,Br,Bg,Bb,se_r,se_g,se_b,object\n";
    for (const auto& [point, B] : rows) {
        const Polygon& polygon = scene.polygons()[point.polygon];
        const Vec3& x = point.position;
        // + 0.0 turns -0 into 0.
        const Vec3 n = polygon.n + 0.0;
        out << fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},", x.x, x.y, x.z, n.x, n.y, n.z);
        out << fmt::format("{:.7g},{:.7g},{:.7g},{:.3g},{:.3g},{:.3g},{}\n", B.mean.r, B.mean.g, B.mean.b,
                           B.standard_error.r, B.standard_error.g, B.standard_error.b, polygon.object);
    }
}

}  // namespace

int main(int argc, char** argv)
{
    Settings settings;
    CLI::App app("Reference radiosity at random points of a scene, path traced", "path_traced_reference");
    app.option_defaults()->always_capture_default();
    app.add_option("scene", settings.scene, "OBJ file")->required();
    app.add_option("-o", settings.output, "CSV file; stdout without");
    app.add_option("--at", settings.at, "points to measure instead: lines x,y,z,nx,ny,nz of a CSV file");
    app.add_option("--points", settings.points)->check(CLI::PositiveNumber);
    app.add_option("--replicates", settings.paths.replicates)->check(CLI::Range(2, 10000));
    app.add_option("--light-strata", settings.paths.light_strata)->check(CLI::PositiveNumber);
    app.add_option("--direction-strata", settings.paths.direction_strata)->check(CLI::PositiveNumber);
    app.add_option("--seed", settings.paths.seed);
    CLI11_PARSE(app, argc, argv);
    try {
        const ReferenceScene scene = read_reference_scene(settings.scene);
        const std::vector<Row> rows = measure(scene, settings);
        if (settings.output.empty()) {
            write(std::cout, scene, settings, rows);
            return 0;
        }
        std::ofstream out(settings.output);
        write(out, scene, settings, rows);
        std::cerr << achieved(rows) << "\n";
        return out.flush() ? 0 : 1;
    } catch (const std::exception& problem) {
        std::cerr << "error: " << problem.what() << "\n";
        return 1;
    }
}
