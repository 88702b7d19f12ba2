#pragma once

#include "meshing/build_scene.h"
#include "meshing/raw_scene.h"
#include "solver/adaptive.h"
#include "solver/element_light.h"
#include "tests/verification/rectangle_light.h"

#include <glm/mat3x3.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// The cases of reference-values.md §5: one light, one blocker, the unit square as receiver.
namespace patchlight::verification {

/// Where the case stands: turned, then moved.
struct Placement {
    glm::dmat3 turn{1.0};
    Vec3 move{0.0};

    Vec3 operator()(const Vec3& p) const { return turn * p + move; }
};

struct ShadowCase {
    std::string name;
    reference::Loop light;    ///< facing down
    reference::Loop blocker;  ///< seen from both sides
};

inline reference::Loop rectangle(double x0, double x1, double y0, double y1, double z)
{
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

inline ShadowCase shadow_case(const std::string& name)
{
    const auto turned_over = [](reference::Loop loop) {
        std::ranges::reverse(loop);
        return loop;
    };
    if (name == "narrow")
        return {name, turned_over(rectangle(.45, .55, .45, .55, 1)), rectangle(.31, .67, .36, .71, .15)};
    if (name == "wide") return {name, turned_over(rectangle(.2, .6, .3, .7, 1)), rectangle(.35, .65, .4, .7, .5)};
    return {name,
            turned_over(rectangle(.1, .4, .3, .6, 1)),
            {{.52, .25, 0}, {.52, .75, 0}, {.52, .75, .3}, {.52, .25, .3}}};
}

/// Built, solved and compared with the exactly clipped light on a grid of points over the receiver.
class SolvedShadow {
public:
    explicit SolvedShadow(ShadowCase shadow, const Placement& placement = {}, std::size_t side = 600)
        : shadow_(std::move(shadow)), placement_(placement), side_(side), exact_(side * side)
    {
        RawScene raw;
        raw.materials = {{.name = "receiver", .reflectance = Rgb(0.5)},
                         {.name = "light", .reflectance = Rgb(0.0), .emission = Rgb(10.0)},
                         {.name = "blocker", .reflectance = Rgb(0.0)}};
        const auto add = [&](const reference::Loop& loop, std::size_t material) {
            raw.faces.push_back({raw.corners.size(), loop.size(), MaterialId(material), ObjectId(std::size_t{0}), 0});
            for (const Vec3& p : loop) {
                raw.corners.push_back(static_cast<std::int64_t>(raw.vertices.size()));
                raw.vertices.push_back(placement_(p));
            }
        };
        add(rectangle(0, 1, 0, 1, 0), 0);
        add(shadow_.light, 1);
        reference::Loop back = shadow_.blocker;
        std::ranges::reverse(back);
        add(shadow_.blocker, 2);
        add(back, 2);
        raw.objects = {"all"};
        scene = build_scene(raw, {}).scene;
        for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
            if (scene.material_of(SurfaceId(s)).reflects()) receiver = SurfaceId(s);
        tbb::parallel_for(std::size_t{0}, side_, [&](std::size_t i) {
            for (std::size_t j = 0; j < side_; ++j)
                exact_[i * side_ + j] =
                    5 * reference::lit_factor(point(i, j), {0, 0, 1}, shadow_.light, {shadow_.blocker});
        });
    }

    AdaptiveSolution solve(Refine refine, std::size_t elements, Elements kind = Elements::linear) const
    {
        AdaptiveOptions options;
        options.refine = refine;
        options.elements = kind;
        options.max_elements = elements;
        options.iterations = 60;
        options.form_factors.rays = options.gather.rays = 64;  // nothing is seen but the light, and that exactly
        if (refine == Refine::none || refine == Refine::discontinuity) options.meshing.max_elements = elements;
        options.mark.local = 0;  // the squared error over the surface is what counts here
        return solve_adaptively(scene, options);
    }

    /// Triangles of the receiver alone.
    std::size_t count(const AdaptiveSolution& solution) const { return solution.mesh.patches_of(receiver).size(); }

    /// Relative L2 error of the linear reconstruction; of the quadratic one, if it was solved for.
    double error(const AdaptiveSolution& solution, Elements kind = Elements::linear) const
    {
        const PatchLocator locator(solution.mesh);
        const ElementLight light{solution.mesh, locator, solution.vertex_B,
                                 kind == Elements::quadratic ? &solution.middle_B : nullptr};
        double num = 0, den = 0;
        for (std::size_t i = 0; i < side_; ++i)
            for (std::size_t j = 0; j < side_; ++j) {
                const double known = exact_[i * side_ + j];
                const Vec2 q = scene.surface(receiver).frame.to_plane(placement_(point(i, j)) - scene.center);
                const double found = light.at(receiver, q).r;
                num += (found - known) * (found - known);
                den += known * known;
            }
        return std::sqrt(num / den);
    }

    Scene scene;
    SurfaceId receiver;

private:
    Vec3 point(std::size_t i, std::size_t j) const
    {
        const auto at = [&](std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(side_); };
        return {at(i), at(j), 0};
    }

    ShadowCase shadow_;
    Placement placement_;
    std::size_t side_;
    std::vector<double> exact_;
};

}  // namespace patchlight::verification
