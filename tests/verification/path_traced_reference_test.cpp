#include "tests/verification/path_traced_reference_light.h"
#include "tests/verification/rectangle_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace patchlight::reference {
namespace {

constexpr const char* cornell = PATCHLIGHT_DATA "/scenes/cornell-box.obj";

/// Exact point-to-light factors of the Cornell box, mm; ten digits are known.
struct KnownFactor {
    Vec3 p, n;
    double unoccluded, with_blocks;
};
const std::vector<KnownFactor> known{
    {{278, 0, 279.5}, {0, 1, 0}, 0.014206957932, 0.010484630958},
    {{70, 0, 250}, {0, 1, 0}, 0.010894447526, 0.010795472206},
    {{400, 0, 150}, {0, 1, 0}, 0.011694970340, 0.011694970340},
    {{500, 0, 420}, {0, 1, 0}, 0.0095010552, 0},
    {{185, 165, 170}, {0, 1, 0}, 0.022291341194, 0.022291341194},
    {{0, 200, 200}, {1, 0, 0}, 0.009822520488, 0.009822520488},
    {{278, 200, 559.2}, {0, 0, -1}, 0.010396475081, 0.010396475081},
    {{400, 50, 559.2}, {0, 0, -1}, 0.005108767452, 0},
};

std::vector<Loop> loops_of(const ReferenceScene& scene, const std::vector<std::string>& objects)
{
    std::vector<Loop> loops;
    for (const Polygon& polygon : scene.polygons())
        if (std::ranges::count(objects, polygon.object) > 0) loops.push_back(polygon.corners);
    return loops;
}

TEST(ClippedLight, MatchesTheKnownFactorsOfTheCornellBox)
{
    const ReferenceScene scene = read_reference_scene(cornell);
    const Loop light = loops_of(scene, {"light"}).at(0);
    const std::vector<Loop> blocks = loops_of(scene, {"short_block", "tall_block"});
    ASSERT_EQ(blocks.size(), 10U);
    for (const KnownFactor& k : known) {
        // The table has ten to twelve decimals.
        EXPECT_NEAR(lit_factor(k.p, k.n, light, {}), k.unoccluded, 1e-10);
        EXPECT_NEAR(lit_factor(k.p, k.n, light, blocks), k.with_blocks, 1e-10);
    }
}

TEST(ClippedLight, MatchesLambertOverTheUnitSquare)
{
    const Loop square{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    EXPECT_NEAR(lit_factor({0.5, 0.5, 0}, {0, 0, 1}, square, {}), 0.23945647046077353883, 1e-14);
    EXPECT_NEAR(lit_factor({0, 0, 0}, {0, 0, 1}, square, {}), 0.13853160599489299678, 1e-14);
    EXPECT_EQ(lit_factor({0.5, 0.5, 2}, {0, 0, -1}, square, {}), 0) << "the light's back is dark";
}

TEST(ClippedLight, HalfABlockerHidesHalfOfASymmetricLight)
{
    const Loop square{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    const double whole = lit_factor({0.5, 0.5, 0}, {0, 0, 1}, square, {});
    const Loop flat{{-1, -1, 0.5}, {0.5, -1, 0.5}, {0.5, 2, 0.5}, {-1, 2, 0.5}};
    // A plate that stands in the point's own vertical plane has no width; beside it, it hides what lies behind.
    const Loop standing{{0.5, -9, 0}, {0.5, 9, 0}, {0.5, 9, 0.8}, {0.5, -9, 0.8}};
    const Vec3 p{0.5, 0.5, 0};
    EXPECT_NEAR(lit_factor(p, {0, 0, 1}, square, {flat}), whole / 2, 1e-14);
    EXPECT_NEAR(lit_factor(p, {0, 0, 1}, square, {flat, flat}), whole / 2, 1e-14) << "a shadow counts once";
    EXPECT_NEAR(lit_factor(p, {0, 0, 1}, square, {standing}), whole, 1e-14);
    // From x = .4 the plate's top edge, .1 away and .8 high, hides the light beyond x = .4 + .1/.8 = .525.
    const Loop seen{{0, 0, 1}, {0, 1, 1}, {0.525, 1, 1}, {0.525, 0, 1}};
    const Vec3 beside{0.4, 0.5, 0};
    EXPECT_NEAR(lit_factor(beside, {0, 0, 1}, square, {standing}), lit_factor(beside, {0, 0, 1}, seen, {}), 1e-14);
}

/// Relative L2 error of the best piecewise constant on n × n squares of the unit square, by 256 × 256 samples.
double piecewise_constant_error(const Loop& light, const Loop& blocker, int n)
{
    const int samples = 256 / n;
    double error = 0, norm = 0;
    for (int cell = 0; cell < n * n; ++cell) {
        double sum = 0, squares = 0;
        for (int k = 0; k < samples * samples; ++k) {
            const double x = (cell % n + (k % samples + 0.5) / samples) / n;
            const double y = (cell / n + (k / samples + 0.5) / samples) / n;
            const double factor = lit_factor({x, y, 0}, {0, 0, 1}, light, {blocker});
            sum += factor;
            squares += factor * factor;
        }
        error += squares - sum * sum / (samples * samples);
        norm += squares;
    }
    return std::sqrt(error / norm);
}

TEST(ClippedLight, PiecewiseConstantErrorsAreTheKnownOnes)
{
    struct Case {
        const char* scene;
        int n;
        double error;
    };
    for (const Case& c :
         {Case{"narrow-penumbra", 8, 0.229}, Case{"narrow-penumbra", 16, 0.158}, Case{"wide-penumbra", 16, 0.0488}}) {
        const ReferenceScene scene = read_reference_scene(std::string(PATCHLIGHT_DATA "/scenes/") + c.scene + ".obj");
        const Loop light = loops_of(scene, {"light"}).at(0);
        const Loop blocker = loops_of(scene, {"blocker"}).at(0);
        // The table has three digits; 16 × 16 samples in a cell see all but one in 256 of its variance.
        EXPECT_NEAR(piecewise_constant_error(light, blocker, c.n), c.error, 0.01 * c.error) << c.scene << " " << c.n;
    }
}

TEST(PathTracedReference, DirectLightMatchesTheKnownFactors)
{
    const ReferenceScene scene = read_reference_scene(cornell);
    const PathOptions options{.replicates = 32, .light_strata = 16, .direction_strata = 1};
    const Rgb exitance = std::numbers::pi * Rgb{17, 12, 4};
    for (std::size_t k = 0; k < known.size(); ++k) {
        const Measured direct = measure_irradiance(scene, known[k].p, known[k].n, options, k).direct;
        for (int band = 0; band < 3; ++band) {
            // Four standard errors: one false alarm in 2,000 runs of all 24, and the seed is fixed. The slack of
            // 1e-10 is for the table's last digit, where the spread over a fully visible light is as small.
            EXPECT_NEAR(direct.mean[band], known[k].with_blocks * exitance[band],
                        4 * direct.standard_error[band] + 1e-10 * exitance[band]);
            EXPECT_LE(direct.standard_error[band], 1e-3 * known[k].unoccluded * exitance[band]);
        }
    }
}

TEST(PathTracedReference, DirectLightMatchesTheClippedLight)
{
    const PathOptions options{.replicates = 32, .light_strata = 12, .direction_strata = 1};
    for (const char* name : {"narrow-penumbra", "wide-penumbra", "wall-on-floor"}) {
        const ReferenceScene scene = read_reference_scene(std::string(PATCHLIGHT_DATA "/scenes/") + name + ".obj");
        const Loop light = loops_of(scene, {"light"}).at(0);
        const std::vector<Loop> blocker{loops_of(scene, {"blocker"}).at(0)};  // one of its two sides: it is thin
        const std::vector<SurfacePoint> points = sample_points(scene, 40, 7);
        std::size_t shaded = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Vec3& p = points[k].position;
            const double factor = lit_factor(p, {0, 0, 1}, light, blocker);
            shaded += factor < lit_factor(p, {0, 0, 1}, light, {}) ? 1 : 0;
            const Measured direct = measure_irradiance(scene, p, {0, 0, 1}, options, k).direct;
            const double E = 10 * std::numbers::pi;
            // Five standard errors of 32 replicates: a false alarm in about 300 such tests, and the seed is fixed.
            EXPECT_NEAR(direct.mean.g, factor * E, 5 * direct.standard_error.g + 1e-9 * E) << name << " " << p.x;
        }
        EXPECT_GE(shaded, 2U) << name;
    }
}

TEST(PathTracedReference, FurnaceIsUniform)
{
    const ReferenceScene scene = read_reference_scene(PATCHLIGHT_DATA "/scenes/furnace.obj");
    PathOptions options{.replicates = 16, .light_strata = 1, .direction_strata = 16};
    options.emitters = FindEmitters::by_chance;
    const double exact = std::numbers::pi / (1 - 0.7);  // what arrives is what leaves: H = B = E/(1 − ρ)
    for (const SurfacePoint& point : sample_points(scene, 12, 3)) {
        const Vec3& n = scene.polygons()[point.polygon].n;
        const Measured H = measure_irradiance(scene, point.position, n, options, 0).total;
        EXPECT_NEAR(H.mean.g, exact, 5 * H.standard_error.g);
        EXPECT_LT(H.standard_error.g, 0.02 * exact);
    }
}

/// A closed unit cube, ρ = .5, whose ceiling's middle ninth emits and reflects too.
ReferenceScene lit_cube()
{
    const auto add = [](std::vector<Polygon>& all, std::vector<Vec3> corners, const Rgb& radiance) {
        all.push_back(make_polygon(std::move(corners), Rgb{0.5}, radiance, "cube"));
    };
    std::vector<Polygon> all;
    const Rgb dark{0.0};
    add(all, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, dark);
    add(all, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, dark);
    add(all, {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}, dark);
    add(all, {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}, dark);
    add(all, {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}, dark);
    const std::vector<Vec3> room{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    const double a = 1.0 / 3, b = 2.0 / 3;
    const std::vector<Vec3> light{{a, a, 1}, {a, b, 1}, {b, b, 1}, {b, a, 1}};
    for (std::size_t k = 0; k < 4; ++k) add(all, {room[k], room[(k + 1) % 4], light[(k + 1) % 4], light[k]}, dark);
    add(all, light, Rgb{9 / std::numbers::pi});
    return ReferenceScene(std::move(all));
}

TEST(PathTracedReference, MeanRadiosityOfAClosedCubeIsTheClosedForm)
{
    // Closed, one ρ: the area mean of H is mean(E)/(1 − ρ) = (9·1/9/6)/.5 = 1/3, whatever emits where.
    const ReferenceScene scene = lit_cube();
    const PathOptions options{.replicates = 2, .light_strata = 4, .direction_strata = 6};
    const std::vector<SurfacePoint> points = sample_points(scene, 1500, 5);
    double mean = 0, squares = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec3& n = scene.polygons()[points[k].polygon].n;
        const double H = measure_irradiance(scene, points[k].position, n, options, k).total.mean.g;
        mean += H;
        squares += H * H;
    }
    const auto count = static_cast<double>(points.size());
    mean /= count;
    const double standard_error = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_NEAR(mean, 1.0 / 3, 4 * standard_error);
    EXPECT_LT(standard_error, 0.02 / 3);
}

TEST(PathTracedReference, BothWaysOfFindingEmittersAgree)
{
    const ReferenceScene scene = lit_cube();
    PathOptions options{.replicates = 32, .light_strata = 8, .direction_strata = 36};
    const Vec3 p{0.3, 0.6, 0}, n{0, 0, 1};
    const Measured drawn = measure_irradiance(scene, p, n, options, 0).total;
    options.emitters = FindEmitters::by_chance;
    const Measured by_chance = measure_irradiance(scene, p, n, options, 1).total;
    const double spread = std::hypot(drawn.standard_error.g, by_chance.standard_error.g);
    EXPECT_NEAR(drawn.mean.g, by_chance.mean.g, 4 * spread);
    EXPECT_LT(spread, 0.03 * drawn.mean.g);
}

}  // namespace
}  // namespace patchlight::reference
