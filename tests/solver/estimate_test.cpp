#include "solver/estimate.h"

#include "tests/formfactor/boxes.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace patchlight {
namespace {

struct Flat {
    Scene scene;
    PatchMesh mesh;

    Flat()
    {
        scene.objects = {"o"};
        scene.materials = {{.name = "grey", .reflectance = Rgb(0.5)}};
        testing::add_surface(scene, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 0);
        mesh = triangulate(scene, {.max_edge = 0.5});
    }
};

/// Light that is everywhere the same.
Radiosity even(const PatchMesh& mesh)
{
    return Radiosity(mesh.patch_count(), Rgb(1));
}

ErrorEstimate rising(const PatchMesh& mesh)
{
    ErrorEstimate error;
    error.eta = PatchField<double>(mesh.patch_count());
    error.edge = PatchField<std::uint8_t>(mesh.patch_count());
    for (const PatchId p : mesh.patches()) {
        error.eta[p] = 1.0 + p.value;
        error.edge[p] = static_cast<std::uint8_t>(p.value % 3);
    }
    return error;
}

// Dörfler: the marked ones hold the share of Σ η², and without the last of them they don't.
TEST(Mark, DoerflerTakesTheFewestPatchesThatHoldTheShare)
{
    const Flat flat;
    const ErrorEstimate error = rising(flat.mesh);
    for (const double share : {0.1, 0.5, 0.9, 1.0}) {
        const RefinementPlan plan = mark(flat.scene, flat.mesh, even(flat.mesh), error, {.share = share, .least = 0});
        double all = 0, held = 0;
        for (const double eta : error.eta.values()) all += eta * eta;
        for (const auto& split : plan.bisections) held += error.eta[split.patch] * error.eta[split.patch];
        EXPECT_GE(held, share * all * (1 - 1e-12));
        const double last = error.eta[plan.bisections.back().patch];
        EXPECT_LT(held - last * last, share * all);
        for (std::size_t i = 1; i < plan.bisections.size(); ++i)
            EXPECT_GE(error.eta[plan.bisections[i - 1].patch], error.eta[plan.bisections[i].patch])
                << "the worst first";
    }
}

TEST(Mark, FixedFractionTakesThatManyPatches)
{
    const Flat flat;
    const RefinementPlan plan = mark(flat.scene, flat.mesh, even(flat.mesh), rising(flat.mesh),
                                     {.marking = Marking::fixed_fraction, .share = 0.25});
    EXPECT_NEAR(static_cast<double>(plan.bisections.size()), 0.25 * static_cast<double>(flat.mesh.patch_count()), 1);
}

TEST(Mark, NothingWrongNothingToSplit)
{
    const Flat flat;
    ErrorEstimate error;
    error.eta = PatchField<double>(flat.mesh.patch_count(), 0.0);
    error.edge = PatchField<std::uint8_t>(flat.mesh.patch_count(), 0);
    EXPECT_TRUE(mark(flat.scene, flat.mesh, even(flat.mesh), error, {}).empty());
}

TEST(Mark, HalvesTheEdgesTheEstimateNames)
{
    const Flat flat;
    const ErrorEstimate error = rising(flat.mesh);
    const RefinementPlan plan = mark(flat.scene, flat.mesh, even(flat.mesh), error, {});
    EXPECT_FALSE(plan.bisections.empty());
    EXPECT_TRUE(plan.lines.empty());
    for (const auto& split : plan.bisections) EXPECT_EQ(split.edge, error.edge[split.patch]);
}

// A few with huge errors must not cost a cycle each.
TEST(Mark, ATenthOfThePatchesIsSplitInAnyCase)
{
    const Flat flat;
    ErrorEstimate error = rising(flat.mesh);
    error.eta[PatchId(0)] = 1e9;
    const double n = static_cast<double>(flat.mesh.patch_count());
    EXPECT_EQ(mark(flat.scene, flat.mesh, even(flat.mesh), error, {.least = 0}).bisections.size(), 1U);
    EXPECT_NEAR(
        static_cast<double>(mark(flat.scene, flat.mesh, even(flat.mesh), error, {.least = 0.1}).bisections.size()),
        0.1 * n, 1);
}

TEST(Mark, EdgesBelowTheSmallestStayWhole)
{
    const Flat flat;
    const ErrorEstimate error = rising(flat.mesh);
    const auto length = [&](PatchId p, std::size_t k) {
        const auto c = flat.mesh.corners(p);
        return glm::distance(flat.mesh.position(c[k]), flat.mesh.position(c[(k + 1) % 3]));
    };
    const double smallest = 0.35;
    const RefinementPlan plan =
        mark(flat.scene, flat.mesh, even(flat.mesh), error, {.share = 1, .smallest = smallest / flat.scene.diameter});
    std::size_t longer = 0;
    for (const PatchId p : flat.mesh.patches()) longer += length(p, error.edge[p]) > smallest;
    ASSERT_LT(longer, flat.mesh.patch_count());
    EXPECT_EQ(plan.bisections.size(), longer);
    for (const auto& split : plan.bisections) EXPECT_GT(length(split.patch, split.edge), smallest);
}

// On one half the light is a tenth as bright: the same error counts for more there, by 1 − local + local · b²/(B² +
// (.03 b)²), b² the mean square.
TEST(Mark, ErrorsInDarkPlacesCountRelativeToTheLightThere)
{
    const Flat flat;
    Radiosity B = even(flat.mesh);
    ErrorEstimate error = rising(flat.mesh);
    for (const PatchId p : flat.mesh.patches()) {
        error.eta[p] = 1;
        if (flat.mesh.centroid(p).x < 0) B[p] = Rgb(0.1);
    }
    for (const double local : {0.5, 1.0}) {
        const RefinementPlan plan = mark(flat.scene, flat.mesh, B, error, {.share = 0.5, .least = 0, .local = local});
        ASSERT_FALSE(plan.bisections.empty());
        for (const auto& split : plan.bisections) EXPECT_LT(flat.mesh.centroid(split.patch).x, 0);
    }
    // With all errors alike and no regard to light the first patches are taken, wherever they are.
    const RefinementPlan plan = mark(flat.scene, flat.mesh, B, error, {.share = 1, .least = 0, .local = 0});
    EXPECT_EQ(plan.bisections.size(), flat.mesh.patch_count());
    // Weights 1 and b²/(.01 + 9e-4 b²) ≈ 48 for b² = .505: of all, halves hold 48/49 and 1/49.
    EXPECT_EQ(mark(flat.scene, flat.mesh, B, error, {.share = 0.97, .least = 0, .local = 1}).bisections.size(),
              mark(flat.scene, flat.mesh, B, error, {.share = 0.9701, .least = 0, .local = 1}).bisections.size());
}

// ∫|B|² of a linear function over [−1,1]²: B = x has 4/3 for each band.
TEST(ReflectedNorm, IsExactForLinearFunctions)
{
    const Flat flat;
    VertexRadiosity B(flat.mesh.vertex_count());
    for (const VertexId v : flat.mesh.vertices()) B[v] = Rgb(flat.mesh.position(v).x);
    EXPECT_NEAR(reflected_norm(flat.scene, flat.mesh, B), std::sqrt(3 * 4.0 / 3), 1e-12);
}

// A floor that sees only the dark has B = 0: error 0/0 counts as 0.
TEST(Evaluate, DarkFloorHasNoError)
{
    const Flat flat;
    const RayCaster caster(flat.scene);
    const PatchLocator locator(flat.mesh);
    for (const Indicator indicator : {Indicator::residual, Indicator::vertex_difference}) {
        const Exchange exchange{flat.scene, caster, flat.mesh, locator};
        const Radiosity B = emittance(flat.scene, flat.mesh);
        const Evaluation dark = evaluate(exchange, light_from_patches(exchange, B, {}), indicator, 30);
        EXPECT_EQ(dark.error.relative, 0);
        EXPECT_EQ(dark.error.total, 0);
    }
}

// Facets of one material within the crease angle share irradiance where they meet; those beyond it don't.
TEST(Crease, FacetsOfACurvedObjectShareIrradianceAtCommonCorners)
{
    Scene scene;
    scene.objects = {"o"};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5)}};
    const double s = std::sin(0.2), c = std::cos(0.2);
    testing::add_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
    testing::add_surface(scene, {{-c, 0, -s}, {0, 0, 0}, {0, 1, 0}, {-c, 1, -s}}, 0);  // bent by 0.2 rad = 11.5°
    const PatchMesh mesh = triangulate(scene, {.max_edge = 10});
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    const Exchange exchange{scene, caster, mesh, locator};
    std::vector<Rgb> H(mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) H[v.value] = Rgb(mesh.surface(v).value == 0 ? 1.0 : 3.0);
    auto shared = H, kept = H;
    share_irradiance(exchange, 30, shared);
    share_irradiance(exchange, 5, kept);
    EXPECT_EQ(kept, H);
    for (const VertexId v : mesh.vertices())
        EXPECT_EQ(shared[v.value].r, mesh.position(v).x == 0 ? 2.0 : H[v.value].r) << v.value;
}

// Two floors that meet in one point, coplanar and of one material, are in different rooms.
TEST(Crease, SurfacesThatMeetInAPointShareNothing)
{
    Scene scene;
    scene.objects = {"o"};
    scene.materials = {{.name = "grey", .reflectance = Rgb(0.5)}};
    testing::add_surface(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
    testing::add_surface(scene, {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}}, 0);
    const PatchMesh mesh = triangulate(scene, {.max_edge = 10});
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    std::vector<Rgb> H(mesh.vertex_count());
    for (const VertexId v : mesh.vertices()) H[v.value] = Rgb(mesh.surface(v).value == 0 ? 1.0 : 0.0);
    auto shared = H;
    share_irradiance({scene, caster, mesh, locator}, 30, shared);
    EXPECT_EQ(shared, H);
}

}  // namespace
}  // namespace patchlight
