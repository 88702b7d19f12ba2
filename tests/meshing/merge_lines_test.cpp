#include "meshing/merge_lines.h"

#include "written_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace patchlight {
namespace {

constexpr double snap = 1e-8;

/// The unit square; its frame's coordinates are those of the plane.
Scene square()
{
    SceneOptions dark;
    dark.require_emitter = false;
    Scene scene = testing::load({testing::rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, dark).scene;
    scene.surfaces[0].frame.origin = -scene.center;
    return scene;
}

SurfaceLine line(LineKind kind, const Vec2& start, const Vec2& end)
{
    return {SurfaceId(std::size_t{0}), kind, start, end};
}

void expect_same(const SurfaceLine& found, const SurfaceLine& expected)
{
    EXPECT_EQ(found.kind, expected.kind);
    EXPECT_LT(glm::distance(found.start, expected.start), 4 * snap);
    EXPECT_LT(glm::distance(found.end, expected.end), 4 * snap);
}

TEST(MergeLines, OverlappingOnesAreOneAndTheStrongerKeepsItsPart)
{
    std::vector<SurfaceLine> lines{line(LineKind::ve, {.1, .2}, {.5, .2}), line(LineKind::ve, {.9, .2}, {.4, .2}),
                                   line(LineKind::ev, {.3, .2}, {.6, .2 + 1e-9}),
                                   line(LineKind::ev, {.6, .2}, {.7, .2})};
    const Scene scene = square();
    for (int k = 0; k < 4; ++k) {
        const auto merged = merged_lines(scene, lines, snap);
        ASSERT_EQ(merged.size(), 3U);
        expect_same(merged[0], line(LineKind::ve, {.1, .2}, {.3, .2}));
        expect_same(merged[1], line(LineKind::ev, {.3, .2}, {.7, .2}));
        expect_same(merged[2], line(LineKind::ve, {.7, .2}, {.9, .2}));
        std::ranges::rotate(lines, lines.begin() + 1);
    }
}

TEST(MergeLines, AShortLineAtACrossingDoesNotJoinWhatCrosses)
{
    const auto merged = merged_lines(square(),
                                     {line(LineKind::ev, {.1, .5}, {.9, .5}), line(LineKind::ev, {.1, .45}, {.9, .55}),
                                      line(LineKind::ve, {.5 - 1e-7, .5}, {.5 + 1e-7, .5 + 1e-8})},
                                     snap);
    ASSERT_EQ(merged.size(), 2U);
    expect_same(merged[0], line(LineKind::ev, {.1, .45}, {.9, .55}));
    expect_same(merged[1], line(LineKind::ev, {.1, .5}, {.9, .5}));
}

TEST(MergeLines, DirectionsOnBothSidesOfTheAxisAreOne)
{
    // Nearly along x from above and from below: angles 0 and π.
    const auto merged = merged_lines(
        square(), {line(LineKind::ev, {.1, .5}, {.5, .5 + 1e-9}), line(LineKind::ev, {.4, .5}, {.9, .5 - 1e-9})}, snap);
    ASSERT_EQ(merged.size(), 1U);
    expect_same(merged[0], line(LineKind::ev, {.1, .5}, {.9, .5}));
}

TEST(MergeLines, BorderLinesAndCrumbsGo)
{
    EXPECT_TRUE(merged_lines(square(),
                             {line(LineKind::ev, {.1, 0}, {.5, 1e-9}), line(LineKind::ev, {1, 1}, {1, 0}),
                              line(LineKind::plane, {.5, .5}, {.5, .5 + 1e-7}), line(LineKind::ve, {.5, .5}, {.5, .5})},
                             snap)
                    .empty());
}

}  // namespace
}  // namespace patchlight
