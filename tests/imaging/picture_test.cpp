#include "apps/imaging/exposure.h"
#include "apps/imaging/picture.h"
#include "apps/imaging/view_rays.h"
#include "meshing/read_scene.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

Rgb linear_light(const Vec3& p)
{
    return {1 + 2 * p.x + 3 * p.y, 4 - p.x, 2 + p.y};
}

/// The floor lit by a linear function, which the linear reconstruction holds exactly, seen from the side.
class PictureTest : public ::testing::Test {
protected:
    PictureTest() : mesh_(grid_mesh(scene_, 5)), locator_(mesh_), caster_(scene_), B_(mesh_.patch_count())
    {
        for (VertexId v : mesh_.vertices()) {
            vertex_B_[v] = linear_light(mesh_.position(v));
        }
        for (PatchId p : mesh_.patches()) {
            B_[p] = Rgb(p.value + 1.0);
        }
        view_.from = {0.5, -0.6, 0.8};
        view_.forward = glm::normalize(Vec3(0.5, 0.5, 0) - view_.from);
        view_.up = {0, 0, 1};
        view_.vertical_fov = 50;
    }

    ShownSolution shown() const { return {scene_, mesh_, locator_, B_, vertex_B_}; }

    /// Where the centre ray of a pixel meets the floor, by the plane's equation alone; nothing beside the floor.
    std::optional<Vec3> floor_point(int x, int y, int width, int height) const
    {
        const double half = std::tan(view_.vertical_fov * std::numbers::pi / 360);
        const Vec3 right = glm::normalize(glm::cross(view_.forward, view_.up));
        const Vec3 above = glm::cross(right, view_.forward);
        const Vec3 d = view_.forward + half * (2 * (x + 0.5) - width) / height * right +
                       half * (height - 2 * (y + 0.5)) / height * above;
        const Vec3 p = view_.from - view_.from.z / d.z * d;
        const bool on = d.z < 0 && p.x > 0 && p.x < 1 && p.y > 0 && p.y < 1;
        return on ? std::optional(p) : std::nullopt;
    }

    Scene scene_ = floor_and_lamp();
    PatchMesh mesh_;
    PatchLocator locator_;
    RayCaster caster_;
    Radiosity B_;
    VertexRadiosity vertex_B_ = VertexRadiosity(mesh_.vertex_count());
    View view_;
};

TEST_F(PictureTest, APixelTimesPiIsTheRadiosityOfThePointItShows)
{
    const Image image = render_picture(shown(), caster_, view_, {.width = 90, .height = 60, .samples = 1});
    int seen = 0;
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 90; ++x) {
            if (const auto p = floor_point(x, y, 90, 60)) {
                ++seen;
                for (int band = 0; band < 3; ++band) {
                    // Stored in single precision, nothing else is rounded.
                    EXPECT_NEAR(std::numbers::pi * image.at(x, y)[band] / linear_light(*p)[band], 1, 3e-7);
                }
            }
        }
    }
    EXPECT_GT(seen, 900);
}

TEST_F(PictureTest, QuadraticElementsAreShadedByTheirPolynomial)
{
    const auto light = [](const Vec3& p) { return Rgb(1 + p.x * p.x, 2 - p.x * p.y, 1 + p.y * p.y); };
    MidpointRadiosity middle_B(mesh_.patch_count());
    for (VertexId v : mesh_.vertices()) {
        vertex_B_[v] = light(mesh_.position(v));
    }
    for (PatchId p : mesh_.patches()) {
        const auto c = mesh_.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            middle_B[p][k] = light(0.5 * (mesh_.position(c[k]) + mesh_.position(c[(k + 1) % 3])));
        }
    }
    ShownSolution solution = shown();
    solution.middle_B = &middle_B;
    const Image image = render_picture(solution, caster_, view_, {.width = 90, .height = 60, .samples = 1});
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 90; ++x) {
            if (const auto p = floor_point(x, y, 90, 60)) {
                for (int band = 0; band < 3; ++band) {
                    // Looked up in single precision: at an edge the neighbour's polynomial may answer.
                    EXPECT_NEAR(std::numbers::pi * image.at(x, y)[band] / light(*p)[band], 1, 1e-6);
                }
            }
        }
    }
}

TEST_F(PictureTest, BacksAndTheBackgroundAreBlack)
{
    view_.from = {0.5, 0.5, 3};  // above the lamp, whose back it sees, around it the floor
    view_.forward = {0, 0, -1};
    view_.up = {0, 1, 0};
    const Image image = render_picture(shown(), caster_, view_, {.width = 64, .height = 64});
    EXPECT_EQ(image.at(32, 32), Rgb(0.0));
    EXPECT_EQ(image.at(0, 0), Rgb(0.0));
    EXPECT_GT(image.at(32, 20).r, 0.1) << "the floor beside the lamp";
}

TEST_F(PictureTest, FlatShadingShowsThePatchValues)
{
    const Image image =
        render_picture(shown(), caster_, view_, {.width = 45, .height = 30, .samples = 1, .shade = Shade::flat});
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 45; ++x) {
            if (const auto p = floor_point(x, y, 45, 30)) {
                const PatchId patch = locator_.locate(SurfaceId(0), static_cast<float>(p->x), static_cast<float>(p->y));
                EXPECT_FLOAT_EQ(image.pixel(x, y)[1], static_cast<float>((patch.value + 1) / std::numbers::pi));
            }
        }
    }
}

TEST_F(PictureTest, PatchBordersAreDrawnAndNothingElse)
{
    PictureOptions options{.width = 240, .height = 160, .samples = 2};
    const ViewHits hits = trace_view(caster_, view_, 240, 160, 2);
    const Image plain = shade_view(shown(), hits, options);
    options.patch_borders = true;
    const Image lined = shade_view(shown(), hits, options);
    int drawn = 0, inside = 0;
    for (int y = 0; y < 160; ++y) {
        for (int x = 0; x < 240; ++x) {
            const auto p = floor_point(x, y, 240, 160);
            drawn += p && plain.at(x, y) != lined.at(x, y);
            // The middle of a triangle of the 5 × 5 grid, further from its edges than two pixels reach.
            if (p && y > 80) {
                const double u = p->x * 5 - std::floor(p->x * 5), v = p->y * 5 - std::floor(p->y * 5);
                if (std::min({u, v, 1 - u, 1 - v, std::abs(u - v) / 1.5}) > 0.15) {
                    ++inside;
                    EXPECT_EQ(plain.at(x, y), lined.at(x, y)) << x << ' ' << y;
                }
            }
        }
    }
    EXPECT_GT(inside, 300);
    EXPECT_GT(drawn, 800);
}

TEST_F(PictureTest, TheLampIsCutAtWhiteBeforeAveraging)
{
    view_.from = {0.5, 0.5, 0.2};
    view_.forward = {0, 0, 1};
    view_.up = {0, 1, 0};
    PictureOptions options{.width = 32, .height = 32};
    options.white = 0.25;
    const Image image = render_picture(shown(), caster_, view_, options);
    EXPECT_FLOAT_EQ(static_cast<float>(image.at(16, 16).r), 0.25F);
}

TEST_F(PictureTest, ASizeOutsideTheRangeIsRefused)
{
    EXPECT_THROW(trace_view(caster_, view_, 0, 10, 1), std::invalid_argument);
    EXPECT_THROW(trace_view(caster_, view_, 10, largest_picture_side + 1, 1), std::invalid_argument);
    EXPECT_THROW(trace_view(caster_, view_, 10, 10, 9), std::invalid_argument);
}

TEST_F(PictureTest, TwiceTheLightIsOneStopLess)
{
    const ViewHits hits = trace_view(caster_, view_, 40, 40, 1);
    Image image = shade_view(shown(), hits, {});
    const double before = auto_exposure(scene_, hits, image);
    for (float& value : image.rgb) {
        value *= 2;
    }
    EXPECT_NEAR(auto_exposure(scene_, hits, image), before - 1, 1e-12);
    std::fill(image.rgb.begin(), image.rgb.end(), 0.0F);
    EXPECT_EQ(auto_exposure(scene_, hits, image), 0) << "a dark picture needs none";
}

TEST(ViewRays, AnUpAlongTheDirectionOfViewStillMakesAPicture)
{
    View view;
    view.forward = {0, 1, 0};
    view.up = {0, 2, 0};
    const Vec3 d = ViewRays(view, 10, 10).direction(0.5, 0.5);
    EXPECT_NEAR(glm::length(d), 1, 1e-12);
    EXPECT_GT(d.y, 0.8);
}

TEST(DefaultView, StandsInsideAClosedRoomAndSeesOnlyFronts)
{
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/furnace.obj").scene;
    ASSERT_TRUE(scene.closed);
    const RayCaster caster(scene);
    const ViewHits hits = trace_view(caster, default_view(scene, caster), 64, 64, 1);
    for (std::uint32_t surface : hits.surface) {
        EXPECT_LT(surface, HitBatch::black_back);
    }
}

}  // namespace
}  // namespace patchlight
