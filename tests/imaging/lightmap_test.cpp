#include "apps/imaging/lightmap.h"

#include "meshing/read_scene.h"
#include "meshing/refinement.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <random>

namespace patchlight {
namespace {

/// A bilinear look-up between texel centres, as graphics hardware does it.
Rgb looked_up(const Image& image, const Vec2& texel)
{
    const Vec2 p = texel - 0.5, base = glm::floor(p), f = p - base;
    const int x = static_cast<int>(base.x), y = static_cast<int>(base.y);
    const auto at = [&](int i, int j) {
        return image.at(std::clamp(x + i, 0, image.width - 1), std::clamp(y + j, 0, image.height - 1));
    };
    return (1 - f.y) * ((1 - f.x) * at(0, 0) + f.x * at(1, 0)) + f.y * ((1 - f.x) * at(0, 1) + f.x * at(1, 1));
}

bool overlap(const LightmapChart& a, const LightmapChart& b)
{
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

void expect_charts_apart(const LightmapAtlas& atlas)
{
    for (std::size_t i = 0; i < atlas.charts.size(); ++i) {
        const LightmapChart& a = atlas.charts[i];
        EXPECT_GE(std::min(a.x, a.y), 0);
        EXPECT_LE(a.x + a.width, atlas.width);
        EXPECT_LE(a.y + a.height, atlas.height);
        EXPECT_GE(std::min(a.width, a.height), 2 + 2 * lightmap_gutter);
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(a, atlas.charts[j])) << i << " and " << j;
    }
}

struct Lit {
    Scene scene;
    PatchMesh mesh;
    Radiosity B;
    VertexRadiosity vertex_B;
    PatchLocator locator;

    Lit(Scene s, PatchMesh m)
        : scene(std::move(s)), mesh(std::move(m)), B(mesh.patch_count()), vertex_B(mesh.vertex_count()), locator(mesh)
    {}
    ShownSolution shown() const { return {scene, mesh, locator, B, vertex_B}; }
};

Lit lit_floor()
{
    Scene scene = testing::floor_and_lamp();
    PatchMesh mesh = testing::grid_mesh(scene, 5);
    Lit lit(std::move(scene), std::move(mesh));
    for (const VertexId v : lit.mesh.vertices()) {
        const Vec3& p = lit.mesh.position(v);
        lit.vertex_B[v] = {4 + p.x, 4 + p.y, 4 + 2 * p.x - 3 * p.y};
    }
    return lit;
}

TEST(Lightmap, OfLinearLightIsExactRightToTheEdges)
{
    const Lit lit = lit_floor();
    const LightmapAtlas atlas = lay_out_lightmap(lit.scene, {.size = 64});
    expect_charts_apart(atlas);
    const Image image = lightmap_image(lit.shown(), atlas, LightmapQuantity::radiosity);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    for (int i = 0; i < 500; ++i) {
        // Corners and edges, too.
        const Vec2 q(i % 5 == 0 ? 0 : any(random), i % 7 == 0 ? 1 : any(random));
        const Rgb B = looked_up(image, atlas.texel_at(SurfaceId(0), q));
        // Single precision of values about 5.
        EXPECT_NEAR(B.r, 4 + q.x, 2e-6);
        EXPECT_NEAR(B.g, 4 + q.y, 2e-6);
        EXPECT_NEAR(B.b, 4 + 2 * q.x - 3 * q.y, 2e-6);
        const Vec2 back = atlas.plane_at(SurfaceId(0), atlas.texel_at(SurfaceId(0), q));
        EXPECT_NEAR(glm::distance(back, q), 0, 1e-12);
    }
}

TEST(Lightmap, IrradianceIsWhatArrives)
{
    Lit lit = lit_floor();
    lit.scene.materials[0].emission = {1, 0, 20};
    lit.scene.materials[0].reflectance = {0.5, 0, 0.25};
    const LightmapAtlas atlas = lay_out_lightmap(lit.scene, {.size = 64});
    const Image image = lightmap_image(lit.shown(), atlas, LightmapQuantity::irradiance);
    const Rgb H = looked_up(image, atlas.texel_at(SurfaceId(0), {0.25, 0.5}));
    EXPECT_NEAR(H.r, 2 * (4.25 - 1), 1e-5);
    EXPECT_EQ(H.g, 0) << "it reflects no green, so nobody knows what arrives";
    EXPECT_EQ(H.b, 0) << "less than it emits is nothing";
}

TEST(Lightmap, GuttersGoOnAsTheChartEnds)
{
    const Lit lit = lit_floor();
    const LightmapAtlas atlas = lay_out_lightmap(lit.scene, {.size = 64});
    const Image image = lightmap_image(lit.shown(), atlas, LightmapQuantity::radiosity);
    const LightmapChart& chart = atlas.charts[0];
    const int inner = chart.x + lightmap_gutter;
    for (int y = chart.y; y < chart.y + chart.height; ++y) {
        EXPECT_EQ(image.at(chart.x, y), image.at(inner, y));
        EXPECT_EQ(image.at(chart.x + chart.width - 1, y), image.at(chart.x + chart.width - 1 - lightmap_gutter, y));
    }
}

TEST(Lightmap, TexelsPerMetreAreHeldOrRefused)
{
    const Scene scene = testing::floor_and_lamp();
    const LightmapAtlas atlas = lay_out_lightmap(scene, {.size = 8192, .texels_per_metre = 100});
    expect_charts_apart(atlas);
    for (const LightmapChart& chart : atlas.charts) {
        EXPECT_GE(std::min(chart.texels_per_metre.x, chart.texels_per_metre.y), 100 * (1 - 1e-12));
    }
    EXPECT_LT(atlas.width, 200) << "no larger than it must be";
    EXPECT_THROW(lay_out_lightmap(scene, {.size = 64, .texels_per_metre = 100}), std::invalid_argument);
    EXPECT_THROW(lay_out_lightmap(scene, {.size = 8192, .texels_per_metre = 1e300}), std::invalid_argument);
    Scene crowded = scene;
    crowded.surfaces.resize(100, scene.surfaces[0]);
    EXPECT_THROW(lay_out_lightmap(crowded, {.size = 16}), std::invalid_argument);
    Scene flat = scene;
    flat.surfaces[1].loops.clear();
    EXPECT_THROW(lay_out_lightmap(flat, {}), std::invalid_argument);
}

/// Least and most light of all patches of a surface that come within `reach` texels of a place.
std::array<Rgb, 2> range_around(const Lit& lit, const LightmapAtlas& atlas, SurfaceId surface, const Vec2& texel,
                                double reach)
{
    std::array<Rgb, 2> range{Rgb(1e300), Rgb(-1e300)};
    for (const PatchId patch : lit.mesh.patches_of(surface)) {
        Vec2 low(1e300), high(-1e300);
        for (const VertexId v : lit.mesh.corners(patch)) {
            const Vec2 t = atlas.texel_at(surface, lit.mesh.plane_position(v));
            low = glm::min(low, t);
            high = glm::max(high, t);
        }
        if (low.x > texel.x + reach || low.y > texel.y + reach || high.x < texel.x - reach || high.y < texel.y - reach)
            continue;
        for (const VertexId v : lit.mesh.corners(patch)) {
            range[0] = glm::min(range[0], lit.vertex_B[v]);
            range[1] = glm::max(range[1], lit.vertex_B[v]);
        }
    }
    return range;
}

class LightmapOfScene : public ::testing::TestWithParam<std::string> {};

// Light that is another at every vertex: what is looked up is a mixture of the patches' within reach, whatever the
// polygon's shape, and never of another surface or of the empty atlas. A look-up reaches a texel's centre √2 away,
// which has its light from a patch no further from it than the place itself.
TEST_P(LightmapOfScene, LooksUpWhatIsWithinATexelOrTwo)
{
    SceneOptions options;
    options.unit = GetParam().starts_with("cornell") && GetParam().ends_with(".obj") ? 1e-3 : 1;
    Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/" + GetParam(), options).scene;
    PatchMesh mesh = triangulate(scene, {});
    Lit lit(std::move(scene), std::move(mesh));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    for (const VertexId v : lit.mesh.vertices()) {
        lit.vertex_B[v] = Rgb(any(random), any(random), any(random)) + double(lit.mesh.surface(v).value);
    }
    const LightmapAtlas atlas = lay_out_lightmap(lit.scene, {.size = 512});
    expect_charts_apart(atlas);
    const Image image = lightmap_image(lit.shown(), atlas, LightmapQuantity::radiosity);
    double smoothed = 0;
    for (int i = 0; i < 3000; ++i) {
        const PatchId patch(random() % lit.mesh.patch_count());
        const SurfaceId surface = lit.mesh.surface(patch);
        const auto c = lit.mesh.corners(patch);
        double u = any(random), v = any(random);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        if (i % 10 == 0) v = 0;  // on an edge
        const auto q = [&](std::size_t k) { return lit.mesh.plane_position(c[k]); };
        const Vec2 texel = atlas.texel_at(surface, q(0) + u * (q(1) - q(0)) + v * (q(2) - q(0)));
        EXPECT_TRUE(texel.x > 0 && texel.y > 0 && texel.x < atlas.width && texel.y < atlas.height);
        const Rgb B = looked_up(image, texel);
        const auto [low, high] = range_around(lit, atlas, surface, texel, 2 * std::sqrt(2.0));
        const double rounding = 1e-6 * (1 + surface.value);
        for (int band = 0; band < 3; ++band) {
            EXPECT_GE(B[band], low[band] - rounding);
            EXPECT_LE(B[band], high[band] + rounding);
        }
        const Rgb exact = lit.vertex_B[c[0]] + u * (lit.vertex_B[c[1]] - lit.vertex_B[c[0]]) +
                          v * (lit.vertex_B[c[2]] - lit.vertex_B[c[0]]);
        smoothed += std::abs(B.r - exact.r) / 3000;
    }
    std::printf("%s: %zu charts, %d x %d, mean difference %.4f of random light in [0, 1]\n", GetParam().c_str(),
                atlas.charts.size(), atlas.width, atlas.height, smoothed);
}

std::vector<std::string> scene_files()
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(PATCHLIGHT_DATA "/scenes")) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".obj" || extension == ".glb") names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

INSTANTIATE_TEST_SUITE_P(Data, LightmapOfScene, ::testing::ValuesIn(scene_files()));

}  // namespace
}  // namespace patchlight
