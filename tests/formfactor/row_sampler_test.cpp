#include "formfactor/row_sampler.h"

#include "formfactor/first_hits.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace patchlight {
namespace {

using testing::add_surface;
using testing::cube_inside;

Material grey(double rho, double E)
{
    return {.name = "grey", .reflectance = Rgb(rho), .emission = Rgb(E)};
}

struct Sampled {
    Scene scene;
    RayCaster caster;
    PatchMesh mesh;
    PatchLocator locator;

    Sampled(Scene s, double max_edge)
        : scene(std::move(s)), caster(scene), mesh(triangulate(scene, {.max_edge = max_edge})), locator(mesh)
    {}
    RowSampler sampler(const FormFactorOptions& options, std::vector<SurfaceId> sources = {}) const
    {
        return RowSampler(scene, caster, mesh, locator, sources, options);
    }
    /// Σ_i A_i F_i(surface)/A from one surface to another.
    double between(const RowSampler& sampler, SurfaceId from, SurfaceId to) const
    {
        RowScratch scratch;
        double sum = 0, area = 0;
        for (const PatchId p : mesh.patches_of(from)) {
            sampler.patch_row(p, scratch);
            area += mesh.area(p);
            for (std::size_t k = 0; k < scratch.row.patches.size(); ++k)
                if (mesh.surface(scratch.row.patches[k]) == to) sum += mesh.area(p) * scratch.row.factors[k];
        }
        return sum / area;
    }
};

const double opposed = 0.19982489569838738304, adjacent = 0.20004377607540315424;

// reference-values.md §1 for the cube: opposite and adjacent faces. 50 patches × 1024 stratified rays: 5e4 rays,
// standard error below √(.2·.8/5e4) = 1.8e-3; strata make it several times smaller.
TEST(RowSampler, TheCubesFactors)
{
    const Sampled cube(cube_inside({0, 0, 0, 0, 0, 0}, {grey(0.5, 1)}), 0.5);
    for (const auto directions : {HemisphereDirections::stratified, HemisphereDirections::regular_grid}) {
        const auto sampler = cube.sampler({.directions = directions, .rays = 1024});
        EXPECT_NEAR(cube.between(sampler, SurfaceId(0UL), SurfaceId(1UL)), opposed, 2e-3);
        for (const std::size_t wall : {2UL, 3UL, 4UL, 5UL})
            EXPECT_NEAR(cube.between(sampler, SurfaceId(0UL), SurfaceId(wall)), adjacent, 2e-3);
    }
}

TEST(RowSampler, RowsOfAClosedRoomSumToOneAndMissThemselves)
{
    const Sampled cube(cube_inside({0, 0, 0, 0, 0, 0}, {grey(0.5, 1)}), 0.5);
    const auto sampler = cube.sampler({.rays = 512});
    RowScratch scratch;
    for (const PatchId p : cube.mesh.patches()) {
        sampler.patch_row(p, scratch);
        EXPECT_NEAR(std::accumulate(scratch.row.factors.begin(), scratch.row.factors.end(), 0.0), 1, 1e-5) << p.value;
        EXPECT_EQ(scratch.row.escaped, 0) << p.value;
        EXPECT_EQ(scratch.row.backs, 0) << p.value;
        for (const PatchId q : scratch.row.patches) EXPECT_NE(cube.mesh.surface(q), cube.mesh.surface(p));
    }
}

Scene small_light(bool blocked)
{
    Scene scene;
    scene.objects = {"o"};
    scene.materials = {grey(0.5, 0), grey(0, 10), grey(0, 0)};
    add_surface(scene, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0);
    add_surface(scene, {{-.1, -.1, 1}, {-.1, .1, 1}, {.1, .1, 1}, {.1, -.1, 1}}, 1);
    // Both sides black, and as large as to hide the light's half x > 0 from points below it.
    if (blocked) {
        add_surface(scene, {{0, -1, .5}, {1, -1, .5}, {1, 1, .5}, {0, 1, .5}}, 2);
        scene.triangles[scene.triangles.size() - 1].back = scene.triangles[scene.triangles.size() - 1].front;
    }
    return scene;
}

// With nothing in between, the swapped source has Lambert's value to rounding, not a count of hits; and what it
// takes comes from the rest, so that the whole is still 1.
TEST(RowSampler, SmallSourcesAreSeenByLambertsFormula)
{
    const Sampled open(small_light(false), 0.5);
    const SurfaceId light(1UL);
    const auto sampler = open.sampler({.rays = 256}, {light});
    const Source source(open.scene, light);
    RowScratch scratch;
    sampler.point_row({0.2, 0.1, 0}, SurfaceId(0UL), 0, 1, scratch);
    double seen = 0, all = scratch.row.escaped + scratch.row.backs;
    for (std::size_t k = 0; k < scratch.row.patches.size(); ++k) {
        all += scratch.row.factors[k];
        if (open.mesh.surface(scratch.row.patches[k]) == light) seen += scratch.row.factors[k];
    }
    EXPECT_NEAR(seen, source.unoccluded({0.2, 0.1, 0}, {0, 0, 1}), 1e-7);
    EXPECT_NEAR(all, 1, 1e-5);
}

TEST(RowSampler, HalfHiddenSourceCountsHalf)
{
    const Sampled half(small_light(true), 0.5);
    const Source source(half.scene, SurfaceId(1UL));
    RandomNumbers random(1, 1);
    ShadowScratch scratch;
    // Below the blocker's edge, just in its shadow by half: the ray through (0, y, .5) ends at x = 0 of the light.
    const ReceiverPoint below{{0, 0, 0}, {0, 0, 1}};
    const double whole = source.unoccluded(below.position, below.normal);
    const double seen = visible_factor(half.caster, source, {&below, 1}, 1024, random, scratch);
    // The edge runs along a line of strata: only their own weights differ.
    EXPECT_NEAR(seen / whole, 0.5, 0.01);
}

// The swap is off where sources hold half of the row: a furnace stays exact.
TEST(RowSampler, SourcesThatFillTheRowAreLeftToTheRays)
{
    const Sampled cube(cube_inside({0, 0, 0, 0, 0, 0}, {grey(0.5, 1)}), 1);
    std::vector<SurfaceId> all;
    for (std::size_t s = 0; s < 6; ++s) all.emplace_back(s);
    const auto plain = cube.sampler({.rays = 256}), swapping = cube.sampler({.rays = 256, .small_source = 1}, all);
    RowScratch a, b;
    plain.patch_row(PatchId(3UL), a);
    swapping.patch_row(PatchId(3UL), b);
    EXPECT_EQ(a.row.patches, b.row.patches);
    EXPECT_EQ(a.row.factors, b.row.factors);
}

TEST(FirstHits, TellFlippedSurfacesAndOpenSides)
{
    Scene room = cube_inside({0, 0, 0, 0, 0, 0}, {grey(0.5, 1)});
    const FirstHits closed = sample_first_hits(room, RayCaster(room));
    EXPECT_EQ(closed.backs, 0);
    EXPECT_EQ(closed.escaped, 0);
    // Turn the ceiling over: what others see of it is its back, and it shines outside.
    for (SceneTriangle& t : room.triangles)
        if (t.front == SurfaceId(1UL)) std::swap(t.vertices[1], t.vertices[2]);
    room.surfaces[1].frame.n *= -1.0;
    std::swap(room.surfaces[1].loops[0][1], room.surfaces[1].loops[0][3]);
    const FirstHits flipped = sample_first_hits(room, RayCaster(room));
    EXPECT_NEAR(flipped.backs, 5.0 / 6 * 0.2, 0.01);
    EXPECT_NEAR(flipped.emitted_escaped, 1.0 / 6, 0.01);
}

}  // namespace
}  // namespace patchlight
