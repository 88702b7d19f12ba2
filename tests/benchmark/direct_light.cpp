// Exact direct light at random points of the reflecting surfaces: prepared (DirectLight), with the scene's tree asked
// at every point (point_factor), and without any blockers (Lambert's formula alone: the least it can cost), in one run.
//   direct_light [POINTS [SCENE.obj UNIT]]     default: three scenes of data/; exit 1 if the first two differ

#include "formfactor/direct_light.h"
#include "formfactor/lambert.h"
#include "formfactor/random_numbers.h"
#include "meshing/read_scene.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace patchlight {
namespace {

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

struct Place {
    Vec3 x;
    SurfaceId surface;
};

/// Uniform over the area of all that reflects.
std::vector<Place> random_places(const Scene& scene, std::size_t count)
{
    struct Piece {
        std::array<Vec3, 3> corners;
        SurfaceId surface;
        double until = 0;
    };
    std::vector<Piece> pieces;
    double area = 0;
    for (const SceneTriangle& t : scene.triangles)
        for (const SurfaceId side : {t.front, t.back}) {
            if (!side.valid() || !scene.material_of(side).reflects()) continue;
            const auto at = [&](std::size_t k) { return scene.vertices[t.vertices[k]]; };
            area += 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
            pieces.push_back({{at(0), at(1), at(2)}, side, area});
        }
    RandomNumbers random(1, 0xd1);
    std::vector<Place> places;
    for (std::size_t i = 0; i < count; ++i) {
        const double t = area * random.uniform(), root = std::sqrt(random.uniform()), v = random.uniform();
        const Piece& p = *std::ranges::lower_bound(pieces, t, {}, &Piece::until);
        places.push_back(
            {(1 - root) * p.corners[0] + root * (1 - v) * p.corners[1] + root * v * p.corners[2], p.surface});
    }
    return places;
}

bool measure(const std::string& file, std::size_t count, double unit)
{
    SceneOptions options;
    options.unit = unit;
    const Scene scene = read_scene(file, options).scene;
    std::vector<SurfaceId> sources;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).emits()) sources.emplace_back(s);
    const Stopwatch building;
    const DirectLight light(scene, sources);
    const double build = building.seconds();
    const std::vector<Place> places = random_places(scene, count);

    std::vector<double> prepared(count * sources.size());
    DirectLight::Scratch scratch;
    const Stopwatch first;
    for (std::size_t i = 0; i < count; ++i)
        light.factors(places[i].x, places[i].surface, std::span(prepared).subspan(i * sources.size(), sources.size()),
                      scratch);
    const double with_cells = first.seconds() / static_cast<double>(count);

    const Blockers blockers(scene);
    std::vector<std::vector<Facet>> facets;
    for (const SurfaceId s : sources) facets.push_back(facets_of(scene, s));
    const std::size_t asked = count / 20;
    double worst = 0;
    const Stopwatch second;
    for (std::size_t i = 0; i < asked; ++i)
        for (std::size_t k = 0; k < sources.size(); ++k) {
            const Vec3& n = scene.surface(places[i].surface).frame.n;
            const double f = point_factor(blockers, places[i].x, n, facets[k], scratch.point);
            worst = std::max(worst, std::abs(f - prepared[i * sources.size() + k]));
        }
    const double with_tree = second.seconds() / static_cast<double>(asked);

    double sum = 0;
    const Stopwatch third;
    for (const Place& place : places)
        for (const std::vector<Facet>& source : facets)
            for (const Facet& facet : source)
                sum += lambert_factor(place.x, scene.surface(place.surface).frame.n, facet.corners);
    const double unoccluded = third.seconds() / static_cast<double>(count);

    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    std::printf(
        "%s: %zu surfaces, %zu sources; built in %.3f s, %zu cells, %.1f MB (the process: at most %ld MB)\n"
        "  ns per point, all sources: prepared %.0f, point_factor %.0f (%.1f times), unoccluded %.0f (a %.2fth)\n"
        "  largest difference %.1e; sum of unoccluded factors %.6f\n",
        file.substr(file.rfind('/') + 1).c_str(), scene.surfaces.size(), sources.size(), build, light.cell_count(),
        static_cast<double>(light.bytes()) / 1e6, usage.ru_maxrss / 1024, with_cells * 1e9, with_tree * 1e9,
        with_tree / with_cells, unoccluded * 1e9, with_cells / unoccluded, worst, sum);
    return worst <= 1e-9;
}

int run(int argc, char** argv)
{
    const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200000;
    if (argc > 3) return measure(argv[2], count, std::atof(argv[3])) ? 0 : 1;
    const std::string scenes = std::string(PATCHLIGHT_DATA) + "/scenes/";
    bool same = true;
    for (const char* name : {"cornell-box", "furniture-room", "gallery"})
        same = measure(scenes + name + ".obj", count, std::string(name) == "cornell-box" ? 1e-3 : 1) && same;
    return same ? 0 : 1;
}

}  // namespace
}  // namespace patchlight

int main(int argc, char** argv)
{
    return patchlight::run(argc, argv);
}
