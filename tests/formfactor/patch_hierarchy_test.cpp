// The tree over all patches: what its nodes say holds of every patch in them.
#include "formfactor/patch_hierarchy.h"

#include "formfactor/node_exchange.h"
#include "meshing/refinement.h"
#include "pairs.h"
#include "random_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

struct Forest {
    explicit Forest(std::uint64_t seed)
        : scene(testing::random_boxes(seed)), mesh(triangulate(scene, {.max_elements = 400})),
          tree(patch_hierarchy(scene, mesh))
    {}

    Scene scene;
    PatchMesh mesh;
    PatchHierarchy tree;
};

TEST(PatchHierarchy, HoldsEveryPatchOnceBelowEachAncestor)
{
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const Forest forest(seed);
        const PatchHierarchy& tree = forest.tree;
        ASSERT_EQ(tree.nodes.size(), 2 * forest.mesh.patch_count() - 1);
        std::vector<PatchId> sorted = tree.order;
        std::ranges::sort(sorted);
        for (std::size_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], PatchId(i));
        const PatchHierarchy::Node& root = tree.nodes[tree.root()];
        EXPECT_EQ(root.first, 0U);
        EXPECT_EQ(root.last, tree.order.size());
        for (std::size_t k = 0; k < tree.nodes.size(); ++k) {
            const PatchHierarchy::Node& node = tree.nodes[k];
            if (node.is_leaf()) continue;
            const auto l = static_cast<std::size_t>(node.left), r = static_cast<std::size_t>(node.right);
            ASSERT_TRUE(l < k && r < k);
            EXPECT_EQ(tree.nodes[l].last, tree.nodes[r].first);
            EXPECT_EQ(node.first, tree.nodes[l].first);
            EXPECT_EQ(node.last, tree.nodes[r].last);
        }
    }
}

TEST(PatchHierarchy, NodesBoundTheirPatches)
{
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const Forest forest(seed);
        const double slack = 1e-12 * forest.scene.diameter;
        for (const PatchHierarchy::Node& node : forest.tree.nodes) {
            double area = 0;
            for (std::uint32_t i = node.first; i < node.last; ++i) {
                const PatchId p = forest.tree.order[i];
                const SurfaceId surface = forest.mesh.surface(p);
                area += forest.mesh.area(p);
                EXPECT_TRUE(!node.surface.valid() || surface == node.surface);
                EXPECT_LE(glm::length(forest.scene.surface(surface).frame.n - node.axis), node.spread + 1e-8);
                for (const VertexId v : forest.mesh.corners(p)) {
                    const Vec3& x = forest.mesh.position(v);
                    EXPECT_TRUE(glm::all(glm::lessThanEqual(node.low, x)) &&
                                glm::all(glm::lessThanEqual(x, node.high)));
                    EXPECT_GE(glm::dot(node.axis, x), node.least - slack - 1e-8 * forest.scene.diameter);
                    EXPECT_LE(glm::dot(node.axis, x), node.most + slack + 1e-8 * forest.scene.diameter);
                }
            }
            EXPECT_NEAR(node.area / area, 1, 1e-12);
        }
    }
}

/// Random points of two nodes see each other by no more than what is said of the nodes.
TEST(PatchHierarchy, NoPairOfPointsExchangesMoreThanItsNodesMay)
{
    RandomNumbers random(7, 7);
    std::size_t facing = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE(seed);
        const Forest forest(seed);
        const PatchHierarchy& tree = forest.tree;
        const auto n = static_cast<std::uint32_t>(tree.nodes.size());
        for (int k = 0; k < 3000; ++k) {
            const PatchHierarchy::Node &p = tree.nodes[random.below(n)], &q = tree.nodes[random.below(n)];
            const auto corner = [&](const PatchHierarchy::Node& node, Vec3& normal) {
                const PatchId patch = tree.order[node.first + random.below(node.last - node.first)];
                normal = forest.scene.surface(forest.mesh.surface(patch)).frame.n;
                return forest.mesh.centroid(patch);
            };
            Vec3 u(0.0), v(0.0);
            const Vec3 x = corner(p, u), y = corner(q, v), d = y - x;
            const double r2 = glm::dot(d, d);
            if (!(r2 > 0)) continue;
            const double cosines = std::max(0.0, glm::dot(d, u)) * std::max(0.0, -glm::dot(d, v));
            if (!(std::sqrt(cosines) > 1e-6 * forest.scene.diameter)) continue;
            ++facing;
            EXPECT_TRUE(may_face(p, q, 1e-8 * forest.scene.diameter));
            const double closed = 1 / std::max(p.area, q.area), most = greatest_kernel(p, q);
            EXPECT_TRUE(most == closed || cosines / (std::numbers::pi * r2 * r2) <= most * (1 + 1e-9));
            EXPECT_EQ(most, greatest_kernel(q, p));
        }
    }
    EXPECT_GT(facing, 5000U);
}

// One slit a thousandth wide between two plates: the pair must not be dropped, and patches get what clipping says.
TEST(NodeExchange, FindsTheLightThroughASlit)
{
    Scene scene;
    scene.objects = {"plates"};
    scene.materials = {{.name = "white", .reflectance = Rgb(0.5)}};
    const auto plate = [&](double z, double x0, double x1, bool up) {
        std::vector<Vec3> c{{x0, 0, z}, {x1, 0, z}, {x1, 1, z}, {x0, 1, z}};
        if (!up) std::ranges::reverse(c);
        testing::add_surface(scene, c, 0);
    };
    plate(0, 0, 1, true);
    plate(1, 0, 1, false);
    plate(0.5, -1, 0.4995, true);
    plate(0.5, 0.5005, 2, true);
    const PatchMesh mesh = triangulate(scene, {.max_edge = 10, .min_angle = 0});
    const RayCaster caster(scene);
    const PatchHierarchy tree = patch_hierarchy(scene, mesh);
    const NodeExchange exchange(scene, caster, mesh, tree, 1);
    NodeExchange::Scratch scratch;
    double sum = 0;
    for (std::uint32_t p = 0; p < tree.nodes.size(); ++p)
        for (std::uint32_t q = 0; q < tree.nodes.size(); ++q) {
            const PatchHierarchy::Node &a = tree.nodes[p], &b = tree.nodes[q];
            if (!a.is_leaf() || !b.is_leaf() || a.surface.value != 0 || b.surface.value != 1) continue;
            ASSERT_TRUE(exchange.may_face(p, q));
            const MeanKernel coarse = exchange.between_points(p, q, 4, 0, 0.5, scratch);
            EXPECT_GT(std::max(coarse.spread_p, coarse.mean), 0);  // rays that all miss prove nothing
            sum += a.area * b.area * exchange.between_patches(p, q, 0, 0.5, scratch).mean;
        }
    // To first order in the width w: (w/π) ∫ over the slit ∫∫ da db / (1 + a² + b²)² over the slopes (a, b) of lines
    // that meet both squares. Clipping errs by 2e-5 of the factor allowed to a pair, 1 % of this one.
    double expected = 0;
    constexpr int cells = 100;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k) {
                const double y = (i + 0.5) / cells, reach = 2 * std::min(y, 1 - y);
                const double a = 2 * (j + 0.5) / cells - 1, b = reach * (2 * (k + 0.5) / cells - 1);
                expected += 4 * reach / std::pow(cells, 3) / std::pow(1 + a * a + b * b, 2);
            }
    expected *= 1e-3 / std::numbers::pi;
    EXPECT_NEAR(sum / expected, 1, 0.03);
}

}  // namespace
}  // namespace patchlight
