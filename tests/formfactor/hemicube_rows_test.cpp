#include "formfactor/hemicube_rows.h"
#include "formfactor/lambert.h"
#include "meshing/refinement.h"
#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace patchlight {
namespace {

Scene cube()
{
    return testing::cube_inside({0, 0, 0, 0, 0, 0}, {Material{}});
}

double factor(const FormFactorMatrix& F, PatchId i, PatchId j)
{
    for (std::size_t k = F.row_start[i.value]; k < F.row_start[i.value + 1]; ++k)
        if (F.columns[k] == j.value) return F.factors[k];
    return 0;
}

/// The root mean square over all pairs of the difference to Lambert's formula at the centroid.
double pixel_error(const Scene& scene, const PatchMesh& mesh, int resolution)
{
    const FormFactorMatrix F = hemicube_rows(scene, mesh, {.resolution = resolution}, {});
    double squares = 0;
    for (const PatchId i : mesh.patches())
        for (const PatchId j : mesh.patches()) {
            if (mesh.surface(i) == mesh.surface(j)) continue;
            const auto c = mesh.corners(j);
            const std::array<Vec3, 3> triangle{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])};
            const Vec3& n = scene.surface(mesh.surface(i)).frame.n;
            const double e = factor(F, i, j) - lambert_factor(mesh.centroid(i), n, triangle);
            squares += e * e;
        }
    return std::sqrt(squares) / static_cast<double>(mesh.patch_count());
}

/// A_i F_ij summed over the patches of two surfaces, by the area of the first.
double between(const PatchMesh& mesh, const FormFactorMatrix& F, SurfaceId from, SurfaceId to)
{
    double sum = 0, area = 0;
    for (const PatchId i : mesh.patches_of(from)) {
        area += mesh.area(i);
        for (const PatchId j : mesh.patches_of(to)) sum += mesh.area(i) * factor(F, i, j);
    }
    return sum / area;
}

// The pixels of a hemicube sum to 1 + 0.54196/resolution² (hemicube_test.cpp); the next order is 1/resolution² smaller.
TEST(HemicubeRows, OfAClosedSceneSumToOne)
{
    const Scene scene = cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.5});
    for (const int resolution : {32, 128}) {
        const FormFactorMatrix F = hemicube_rows(scene, mesh, {.resolution = resolution}, {});
        const double pixels = 3.0 * resolution * resolution;
        EXPECT_EQ(static_cast<double>(F.rays), pixels * static_cast<double>(mesh.patch_count()));
        for (const PatchId i : mesh.patches()) {
            EXPECT_NEAR(F.raw_sum[i], 1 + 0.54196 / (resolution * resolution), 3e-6 + 2 * std::pow(resolution, -4.0));
            EXPECT_EQ(F.escaped[i], 0);
            EXPECT_EQ(F.backs[i], 0);
            EXPECT_EQ(factor(F, i, i), 0);
        }
    }
}

// Of the centroid's factors only the pixels' error is left: r^-3/2, 0.35 for twice the resolution; 0.7 with scatter.
TEST(HemicubeRows, PixelErrorsFallWithTheResolution)
{
    const Scene scene = cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.7});
    double last = 1e9;
    for (const int resolution : {16, 32, 64, 128}) {
        const double error = pixel_error(scene, mesh, resolution);
        EXPECT_LE(error, 0.7 * last) << resolution;
        last = error;
    }
}

// The centroid stands for its patch: an error of second order far away, and of first order along the shared edges,
// so that adjacent faces converge like the patches' edge. 0.75 for half the edge leaves room for the meshes' scatter.
TEST(HemicubeRows, TheCubesFactorsConvergeWithTheMesh)
{
    const Scene scene = cube();
    const double opposed = 0.19982489569838738304, adjacent = 0.20004377607540315424;
    double last = 1e9;
    for (const double edge : {1.0, 0.5, 0.25}) {
        const PatchMesh mesh = triangulate(scene, {.max_edge = edge});
        const FormFactorMatrix F = hemicube_rows(scene, mesh, {.resolution = 128}, {});
        const double error = std::abs(between(mesh, F, SurfaceId(0UL), SurfaceId(2UL)) - adjacent);
        EXPECT_LE(error, 0.75 * last) << edge;
        last = error;
        // Smooth: (edge/distance)²/24 of the curvature of cos⁴, below a fiftieth of the square here.
        EXPECT_NEAR(between(mesh, F, SurfaceId(0UL), SurfaceId(1UL)), opposed, 0.02 * edge * edge);
    }
    EXPECT_LE(last, 0.02 * adjacent);
}

// The roof of the cube taken away: what escaped is what the roof received, for each patch.
TEST(HemicubeRows, WhatMeetsNothingEscapes)
{
    const Scene closed = cube();
    Scene open = closed;
    std::erase_if(open.triangles, [](const SceneTriangle& t) { return t.front.value == 1; });
    open.surfaces.erase(open.surfaces.begin() + 1);
    for (SceneTriangle& t : open.triangles)
        if (t.front.value > 1) t.front = SurfaceId(t.front.value - 1);
    const PatchMesh mesh = triangulate(closed, {.max_edge = 1}), rest = triangulate(open, {.max_edge = 1});
    const FormFactorMatrix F = hemicube_rows(closed, mesh, {}, {}), G = hemicube_rows(open, rest, {}, {});
    const SurfaceId floor(std::size_t{0}), roof(std::size_t{1});
    for (const PatchId i : mesh.patches_of(floor)) {
        double seen = 0;
        for (const PatchId j : mesh.patches_of(roof)) seen += factor(F, i, j);
        // The floor's patches are the first of both meshes, alike, and turned alike: the same pixels.
        EXPECT_NEAR(G.escaped[i], seen, 1e-12);
        EXPECT_NEAR(G.raw_sum[i] + G.escaped[i], F.raw_sum[i], 1e-12);
    }
}

// A sheet over the floor that shows its black back hides as much as it would receive, and receives nothing.
TEST(HemicubeRows, BacksBlockAndAreToldApart)
{
    Scene scene = cube();
    testing::add_surface(scene, {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}}, 0);
    const PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    const FormFactorMatrix F = hemicube_rows(scene, mesh, {}, {});
    const SurfaceId floor(std::size_t{0}), sheet(std::size_t{6});
    for (const PatchId i : mesh.patches_of(floor)) {
        EXPECT_GT(F.backs[i], 0.01);
        EXPECT_NEAR(F.raw_sum[i] + F.backs[i], 1 + 0.54196 / (256 * 256), 3e-6);
        for (const PatchId j : mesh.patches_of(sheet)) EXPECT_EQ(factor(F, i, j), 0);
    }
    for (const PatchId i : mesh.patches_of(sheet)) EXPECT_EQ(F.backs[i], 0);
}

// Snapping moves a corner of one side of a sheet in front of the other by a billionth: neither side sees the other.
TEST(HemicubeRows, TheOtherSideOfASheetIsNotSeen)
{
    Scene scene;
    scene.materials = {Material{}};
    scene.diameter = 2 * std::sqrt(2.0);
    testing::add_surface(scene, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0);
    testing::add_surface(scene, {{-1, 1, 0}, {1, 1, 0}, {1, -1, 3e-9}, {-1, -1, 3e-9}}, 0);
    const PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    const FormFactorMatrix F = hemicube_rows(scene, mesh, {.resolution = 8}, {});
    for (const PatchId i : mesh.patches()) {
        EXPECT_EQ(F.raw_sum[i] + F.backs[i], 0) << i.value;
        EXPECT_NEAR(F.escaped[i], 1, 0.01) << i.value;  // 1 + 0.54/resolution²
    }
}

TEST(HemicubeRows, ThreadsDoNotChangeABitAndSeedsTurn)
{
    const Scene scene = cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 0.7});
    const FormFactorMatrix many = hemicube_rows(scene, mesh, {.resolution = 64}, {});
    const FormFactorMatrix turned = hemicube_rows(scene, mesh, {.resolution = 64, .seed = 2}, {});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const FormFactorMatrix alone = hemicube_rows(scene, mesh, {.resolution = 64}, {});
    EXPECT_EQ(many.columns, alone.columns);
    EXPECT_EQ(many.factors, alone.factors);
    EXPECT_NE(many.factors, turned.factors);
}

TEST(HemicubeRows, RefuseWhatHemicubesDoAndStopWhenAsked)
{
    const Scene scene = cube();
    const PatchMesh mesh = triangulate(scene, {.max_edge = 1});
    EXPECT_THROW(hemicube_rows(scene, mesh, {.resolution = 7}, {}), std::invalid_argument);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(hemicube_rows(scene, mesh, {}, {source.get_token(), {}}), Interrupted);
}

}  // namespace
}  // namespace patchlight
