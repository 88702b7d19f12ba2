#include "formfactor/exact_rows.h"

#include "boxes.h"
#include "formfactor/black_backs.h"
#include "formfactor/form_factor_matrix.h"
#include "formfactor/pair_factor.h"
#include "formfactor/random_numbers.h"
#include "meshing/read_scene.h"
#include "meshing/refinement.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace patchlight {
namespace {

struct Meshed {
    Scene scene;
    PatchMesh mesh;
};

PatchMesh mesh_of(const Scene& scene, std::size_t elements)
{
    MeshingOptions options;
    options.max_elements = elements;
    return triangulate(scene, options);
}

Scene cube()
{
    return testing::cube_inside({0, 0, 0, 0, 0, 0}, {Material{}});
}

Scene read(const std::string& name, double unit = 1)
{
    SceneOptions options;
    options.unit = unit;
    options.require_emitter = false;
    return read_scene(std::string(PATCHLIGHT_DATA) + "/scenes/" + name, options).scene;
}

struct Closure {
    double mean = 0, worst = 0;
};

/// |1 − Σ F − backs|, nothing normalised.
Closure closure(const FormFactorMatrix& F)
{
    Closure c;
    for (std::size_t i = 0; i < F.size(); ++i) {
        double sum = F.backs[PatchId(i)];
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) sum += F.factors[k];
        c.mean += std::abs(1 - sum) / static_cast<double>(F.size());
        c.worst = std::max(c.worst, std::abs(1 - sum));
    }
    return c;
}

double factor(const FormFactorMatrix& F, std::size_t i, std::uint32_t j)
{
    const auto first = F.columns.begin() + static_cast<std::ptrdiff_t>(F.row_start[i]);
    const auto last = F.columns.begin() + static_cast<std::ptrdiff_t>(F.row_start[i + 1]);
    const auto found = std::lower_bound(first, last, j);
    return found != last && *found == j ? F.factors[static_cast<std::size_t>(found - F.columns.begin())] : 0;
}

// The bounds for an empty cube; at 500 patches the nodes are farther apart in the patches' own size than at
// 8,000.
TEST(ExactRows, AnEmptyCubeCloses)
{
    const Scene scene = cube();
    const PatchMesh mesh = mesh_of(scene, 500);
    ExactCounts counts;
    const Closure c = closure(exact_rows(scene, RayCaster(scene), mesh, {}, {}, true, &counts));
    EXPECT_LE(c.mean, 1e-6);
    EXPECT_LE(c.worst, 1e-5);
    EXPECT_EQ(counts.partial, 0U) << "the walls of a convex room hide nothing";
}

// Concave, turned out of the axes, touching everywhere. Two in ten of the pairs are partly hidden by the inner corner.
TEST(ExactRows, ATurnedLShapedRoomCloses)
{
    const Scene scene = read("furnace.obj");
    const Closure c = closure(exact_rows(scene, RayCaster(scene), mesh_of(scene, 600), {}, {}));
    EXPECT_LE(c.mean, 2e-5);
    EXPECT_LE(c.worst, 2e-4);
}

// With the floor under the blocks in the mesh: what patches across their feet miss in fronts they see in backs.
TEST(ExactRows, TheClosedCornellBoxClosesWithItsBacks)
{
    const Scene scene = read("cornell-box-closed.obj", 0.001);
    ASSERT_TRUE(scene.closed);
    const PatchMesh mesh = mesh_of(scene, 700);
    ExactCounts counts;
    const FormFactorMatrix F = exact_rows(scene, RayCaster(scene), mesh, {}, {}, true, &counts);
    const Closure c = closure(F);
    EXPECT_LE(c.mean, 2e-5);
    EXPECT_LE(c.worst, 2e-4);
    EXPECT_GT(counts.partial, counts.facing / 10);
    std::size_t covered = 0;
    for (const PatchId p : mesh.patches()) covered += F.backs[p] > 0.99 ? 1 : 0;
    EXPECT_EQ(covered, 0U) << "the floor under the blocks is no surface";
}

TEST(ExactRows, ReciprocityIsExactAndNothingSeesItself)
{
    const Scene scene = read("cornell-box-closed.obj", 0.001);
    const PatchMesh mesh = mesh_of(scene, 300);
    const FormFactorMatrix F = exact_rows(scene, RayCaster(scene), mesh, {}, {});
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) {
            const std::uint32_t j = F.columns[k];
            const double there = mesh.area(PatchId(i)) * F.factors[k];
            const double back = mesh.area(PatchId(j)) * factor(F, j, static_cast<std::uint32_t>(i));
            ASSERT_NEAR(there, back, 4.5e-16 * there);  // one division and one product each: 4 roundings of 2⁻⁵³
            ASSERT_NE(mesh.surface(PatchId(i)), mesh.surface(PatchId(j)));
            ASSERT_GT(F.factors[k], 0) << "what is invisible is not stored";
            ASSERT_LE(F.factors[k], 1);
        }
}

// Against the pairs' own exact method, which shares the clipping but neither the shafts' tree nor the nodes.
TEST(ExactRows, AgreesWithExactPairs)
{
    const Scene scene = read("cornell-box-closed.obj", 0.001);
    const PatchMesh mesh = mesh_of(scene, 500);
    const FormFactorMatrix F = exact_rows(scene, RayCaster(scene), mesh, {}, {});
    const auto facet = [&](std::size_t i) {
        const PatchId p(i);
        const auto c = mesh.corners(p);
        return Facet{{mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])},
                     scene.surface(mesh.surface(p)).frame.n,
                     mesh.area(p),
                     mesh.surface(p)};
    };
    RandomNumbers random(5, 5);
    PairOptions options;
    options.tolerance = 1e-8;
    double squares = 0;
    constexpr int pairs = 300;
    for (int n = 0; n < pairs; ++n) {
        const std::size_t i = random.below(static_cast<std::uint32_t>(F.size())),
                          j = random.below(static_cast<std::uint32_t>(F.size()));
        if (mesh.surface(PatchId(i)) == mesh.surface(PatchId(j))) continue;
        const Facet a = facet(i), b = facet(j);
        const double exact = pair_by_exact(scene, std::span(&a, 1), std::span(&b, 1), options).value;
        const double error = factor(F, i, static_cast<std::uint32_t>(j)) - exact;
        // A pair's error may be a few times the 1e-5 at which it stops being quartered.
        EXPECT_NEAR(error, 0, 1e-4) << i << ' ' << j;
        squares += error * error;
    }
    EXPECT_LE(std::sqrt(squares / pairs), 1e-5);
}

TEST(ExactRows, OccludedIsNeverMoreThanUnoccluded)
{
    const Scene scene = read("cornell-box-closed.obj", 0.001);
    const PatchMesh mesh = mesh_of(scene, 300);
    const FormFactorMatrix F = exact_rows(scene, RayCaster(scene), mesh, {}, {}),
                           free = exact_rows(scene, RayCaster(scene), mesh, {}, {}, false);
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k)
            ASSERT_LE(F.factors[k], factor(free, i, F.columns[k]) * (1 + 1e-12));
}

TEST(ExactRows, TheNumberOfThreadsChangesNoBit)
{
    const Scene scene = read("cornell-box-closed.obj", 0.001);
    const PatchMesh mesh = mesh_of(scene, 300);
    const FormFactorMatrix two = exact_rows(scene, RayCaster(scene), mesh, {}, {});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const FormFactorMatrix single = exact_rows(scene, RayCaster(scene), mesh, {}, {});
    EXPECT_EQ(two.columns, single.columns);
    EXPECT_EQ(two.factors, single.factors);
}

// Two rooms back to back share a wall's plane: nothing crosses it.
TEST(ExactRows, SealedRoomsExchangeNothing)
{
    Scene scene = cube();
    const std::size_t first = scene.surfaces.size();
    for (std::size_t s = 0; s < first; ++s) {
        std::vector<Vec3> corners;
        for (const std::uint32_t v : scene.surfaces[s].loops[0]) corners.push_back(scene.vertices[v] + Vec3(2, 0, 0));
        testing::add_surface(scene, corners, 0);
    }
    const PatchMesh mesh = mesh_of(scene, 400);
    const FormFactorMatrix F = exact_rows(scene, RayCaster(scene), mesh, {}, {});
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k)
            ASSERT_EQ(mesh.surface(PatchId(i)).value < first, mesh.surface(PatchId(F.columns[k])).value < first);
    EXPECT_LE(closure(F).worst, 1e-5);
}

// Found by fuzzing: a closed room whose walls have an outside. No light gets there, but rows sum to 1 there, too.
// Found by fuzzing: where pairs were too large already, rays that began beyond a narrow gap added backs.
TEST(ExactRows, BacksAreLookedForWhereSomethingIsMissing)
{
    Scene scene = cube();
    testing::add_surface(scene, {{0.5, 0.2, 0.2}, {0.5, 0.8, 0.2}, {0.5, 0.8, 0.8}, {0.5, 0.2, 0.8}}, 0);
    const RayCaster caster(scene);
    const PatchMesh mesh = mesh_of(scene, 100);
    const Blockers blockers(scene);
    for (const double sum : {0.9, 1.1}) {
        FormFactorMatrix F;
        F.raw_sum = PatchField<double>(mesh.patch_count(), sum);
        F.backs = F.escaped = PatchField<double>(mesh.patch_count(), 0.0);
        add_backs(scene, caster, mesh, blockers, 1e-4, 1, F, {});
        std::size_t with_backs = 0;
        for (const PatchId p : mesh.patches()) with_backs += F.backs[p] > 0 ? 1 : 0;
        EXPECT_EQ(with_backs > 0, sum < 1);
    }
}

TEST(ExactRows, OutsidesOfClosedRoomsLookOut)
{
    Scene scene = cube();
    const std::size_t first = scene.surfaces.size();
    for (std::size_t s = 0; s < first; ++s) {
        std::vector<Vec3> corners;
        for (const std::uint32_t v : scene.surfaces[s].loops[0]) corners.push_back(1.2 * scene.vertices[v]);
        std::ranges::reverse(corners);
        testing::add_surface(scene, corners, 0);
    }
    const RayCaster caster(scene);
    const PatchMesh mesh = mesh_of(scene, 300);
    const PatchLocator locator(mesh);
    for (const FormFactorMethod method : {FormFactorMethod::exact, FormFactorMethod::quadrature}) {
        FormFactorOptions options;
        options.method = method;
        const FormFactorMatrix F = form_factor_matrix(scene, caster, mesh, locator, options, {});
        for (const PatchId p : mesh.patches()) {
            const bool outside = mesh.surface(p).value >= first;
            EXPECT_EQ(F.escaped[p], outside ? 1 : 0);
            EXPECT_EQ(F.backs[p], 0);
            // Of quadrature, by its default tolerance of 1e-3.
            EXPECT_NEAR(F.raw_sum[p], outside ? 0 : 1, 2e-3);
        }
    }
}

TEST(ExactRows, ScaleDoesNotMatter)
{
    const auto sums = [](double unit) {
        const Scene scene = read("cornell-box-closed.obj", unit);
        return exact_rows(scene, RayCaster(scene), mesh_of(scene, 300), {}, {});
    };
    const FormFactorMatrix small = sums(1e-6), large = sums(1.0);
    ASSERT_EQ(small.size(), large.size());
    // Decisions at a rounding may fall otherwise: then two values of one error bound stand beside each other.
    for (std::size_t i = 0; i < small.size(); ++i)
        EXPECT_NEAR(small.raw_sum[PatchId(i)], large.raw_sum[PatchId(i)], 2e-4);
}

}  // namespace
}  // namespace patchlight
