#include "apps/imaging/line_overlay.h"

#include "apps/imaging/exposure.h"
#include "apps/imaging/view_rays.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace patchlight {
namespace {

using testing::floor_and_lamp;
using testing::grid_mesh;

constexpr std::uint32_t n = 4;

/// The floor of floor_and_lamp() in 4 × 4 squares, seen from above: x to the right, y up, the whole floor in a picture
/// of 100 × 100 pixels and a rim of ten around it.
class LineOverlay : public ::testing::Test {
protected:
    LineOverlay() : caster_(scene_)
    {
        view_.from = {0.5, 0.5, 0.9};  // below the lamp
        view_.forward = {0, 0, -1};
        view_.up = {0, 1, 0};
        view_.vertical_fov = 2 * std::atan(0.6 / 0.9) * 180 / std::numbers::pi;
        hits_ = trace_view(caster_, view_, 120, 120, 1);
    }

    /// From grid vertex (i, j) to (k, l), which must be neighbours.
    static MeshLine line(std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l, LineKind kind)
    {
        const std::uint32_t a = j * (n + 1) + i, b = l * (n + 1) + k;
        return {kind, {a, b}, {a, b}, false};
    }

    PatchMesh mesh_with(std::vector<MeshLine> lines) const
    {
        PatchMeshArrays arrays = grid_mesh(scene_, n).arrays();
        arrays.lines = std::move(lines);
        return PatchMesh(scene_, std::move(arrays));
    }

    std::uint8_t at(const std::vector<std::uint8_t>& mask, double x, double y) const
    {
        const Vec2 pixel = ViewRays(view_, 120, 120).project({x, y, 0});
        return mask[static_cast<std::size_t>(pixel.y) * 120 + static_cast<std::size_t>(pixel.x)];
    }

    Scene scene_ = floor_and_lamp();
    RayCaster caster_;
    View view_;
    ViewHits hits_;
};

TEST_F(LineOverlay, ProjectingIsTheWayBackOfDirection)
{
    view_.forward = glm::normalize(Vec3(0.3, -0.2, -1));
    const ViewRays rays(view_, 120, 80);
    for (const Vec2& p : {Vec2(0, 0), Vec2(60, 40), Vec2(119, 3)}) {
        const Vec2 back = rays.project(rays.from() + 7.0 * rays.direction(p.x, p.y));
        EXPECT_NEAR(back.x, p.x, 1e-10);
        EXPECT_NEAR(back.y, p.y, 1e-10);
    }
}

TEST_F(LineOverlay, LinesOfAnyDirectionAreWholeAndNothingElseIsInked)
{
    const PatchMesh mesh =
        mesh_with({line(1, 1, 2, 1, LineKind::ev), line(2, 1, 2, 2, LineKind::ve), line(2, 2, 3, 3, LineKind::plane)});
    const auto mask = line_samples(mesh, hits_);
    for (double t = 0.02; t < 1; t += 0.02) {
        EXPECT_EQ(at(mask, 0.25 + 0.25 * t, 0.25), 1 + static_cast<int>(LineKind::ev)) << t;
        if (t > 0.06 && t < 0.94) {
            EXPECT_EQ(at(mask, 0.5, 0.25 + 0.25 * t), 1 + static_cast<int>(LineKind::ve)) << t;
            EXPECT_EQ(at(mask, 0.5 + 0.25 * t, 0.5 + 0.25 * t), 1 + static_cast<int>(LineKind::plane)) << t;
        }
    }
    // 25 + 25 + 35 pixels long, 1.8 wide, and round at the ends.
    const auto inked = mask.size() - static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 0));
    EXPECT_GT(inked, 100U);
    EXPECT_LT(inked, 220U);
}

TEST_F(LineOverlay, WhatGoesOnBeyondALineIsAnOrdinaryEdge)
{
    MeshLine beyond = line(1, 1, 2, 1, LineKind::contact);
    beyond.beyond = true;
    const auto mask = line_samples(mesh_with({beyond}), hits_);
    EXPECT_EQ(std::count(mask.begin(), mask.end(), 0), static_cast<std::ptrdiff_t>(mask.size()));
    Image blank(120, 120);
    draw_line_legend(mesh_with({beyond}), blank);
    EXPECT_EQ(blank.rgb, Image(120, 120).rgb) << "and has no entry in the legend";
}

TEST_F(LineOverlay, WhatStandsBeforeALineHidesIt)
{
    view_.from.z = 2;  // now the lamp's back is in between
    hits_ = trace_view(caster_, view_, 120, 120, 1);
    const auto mask = line_samples(mesh_with({line(2, 2, 3, 3, LineKind::ev)}), hits_);
    EXPECT_EQ(std::count(mask.begin(), mask.end(), 0), static_cast<std::ptrdiff_t>(mask.size()));
}

TEST_F(LineOverlay, LinesBehindTheCameraOrThroughItsPlaneAreNoTrouble)
{
    const PatchMesh mesh = mesh_with({line(1, 1, 2, 1, LineKind::ev), line(2, 2, 3, 3, LineKind::ev)});
    view_.from = {0.5, 0.6, 0.05};
    for (const Vec3& forward : {Vec3(0, 1, 0), Vec3(1, 1, -0.1), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
        view_.forward = glm::normalize(forward);
        view_.up = {0.1, 0, 1};
        const ViewHits hits = trace_view(caster_, view_, 60, 60, 1);
        EXPECT_EQ(line_samples(mesh, hits).size(), 3600U);
    }
}

TEST_F(LineOverlay, APictureWithBordersShowsTheKindsColour)
{
    const PatchMesh mesh = mesh_with({line(1, 1, 2, 1, LineKind::ev)});
    const PatchLocator locator(mesh);
    const Radiosity B(mesh.patch_count(), Rgb(1.0));
    const VertexRadiosity vertex_B(mesh.vertex_count(), Rgb(1.0));
    PictureOptions options{.width = 120, .height = 120, .samples = 1};
    options.patch_borders = true;
    options.white = white_at(1);
    const Image image = to_srgb(shade_view({scene_, mesh, locator, B, vertex_B}, hits_, options), 1);
    const Vec2 pixel = ViewRays(view_, 120, 120).project({0.37, 0.25, 0});
    const Rgb found = image.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)), wanted = line_color(LineKind::ev);
    for (int band = 0; band < 3; ++band) {
        EXPECT_NEAR(found[band], wanted[band], 1e-6);
    }
}

TEST_F(LineOverlay, TheLegendIsInTheLowerLeftCorner)
{
    Image blank(320, 240);
    draw_line_legend(mesh_with({line(1, 1, 2, 1, LineKind::ev)}), blank);
    int colored = 0;
    for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 320; ++x) {
            if (blank.at(x, y) != Rgb(0.0)) {
                ++colored;
                EXPECT_TRUE(x < 100 && y > 200) << x << ' ' << y;
            }
        }
    }
    EXPECT_GT(colored, 50);
}

}  // namespace
}  // namespace patchlight
