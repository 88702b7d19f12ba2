#include "apps/run/stored_factors.h"
#include "meshing/scene_error.h"
#include "tests/imaging/floor_and_lamp.h"

#include <gtest/gtest.h>

#include <limits>

namespace patchlight {
namespace {

constexpr std::size_t patches = 3;

FormFactorMatrix matrix(double last)
{
    FormFactorMatrix F;
    F.row_start = {0, 2, 2, 3};
    F.columns = {2, 0, 1};
    F.factors = {0.25, 0.5, last};
    F.raw_sum = PatchField<double>(patches, 0.75);
    F.escaped = PatchField<double>(patches, 0.1);
    F.backs = PatchField<double>(patches, 0.0);
    F.rays = 96;
    return F;
}

KeptRows rows()
{
    return {matrix(0.5), {}, matrix(1.0 / 3)};  // 1/3 needs double precision
}

const Json key = {{"mesh", "m"}, {"gather", {{"rays", 32}}}};

TEST(StoredFactors, ComeBackEqualToTheBit)
{
    const StoredFactors back = decode_factors(encode_factors(rows(), key), key, patches);
    ASSERT_TRUE(back.rows);
    EXPECT_EQ(back.rows->rays(), 192U);
    EXPECT_EQ(back.rows->estimate.size(), 0U);
    EXPECT_EQ(back.rows->nodes.factors, matrix(1.0 / 3).factors);
    EXPECT_EQ(back.rows->patches.factors, matrix(0.5).factors);
    EXPECT_EQ(back.rows->patches.columns, matrix(0.5).columns);
    EXPECT_EQ(back.rows->patches.row_start, matrix(0.5).row_start);
    EXPECT_EQ(back.rows->patches.escaped[PatchId(2)], 0.1);
}

TEST(StoredFactors, OfAnotherKeyAreNotReadAndTheDifferenceIsNamed)
{
    const std::string bytes = encode_factors(rows(), key);
    Json other = key;
    other["gather"]["rays"] = 33;
    const StoredFactors found = decode_factors(bytes, other, patches);
    EXPECT_FALSE(found.rows);
    EXPECT_EQ(found.differs, "gather");
    other = key;
    other["more"] = 1;
    EXPECT_EQ(decode_factors(bytes, other, patches).differs, "more");
}

TEST(StoredFactors, CutShortOrChangedAnywhereTheyAreRefused)
{
    const std::string bytes = encode_factors(rows(), key);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_THROW(decode_factors(bytes.substr(0, length), key, patches), SceneError) << length;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string flipped = bytes;
        flipped[i] = static_cast<char>(flipped[i] ^ 4);
        EXPECT_THROW(decode_factors(flipped, key, patches), SceneError) << i;
    }
    EXPECT_THROW(decode_factors(bytes + "x", key, patches), SceneError);
}

// Whoever writes a right digest below wrong rows.
TEST(StoredFactors, RowsThatLeaveTheMeshOrAreNoFactorsAreRefused)
{
    EXPECT_THROW(decode_factors(encode_factors(rows(), key), key, patches - 1), SceneError);
    for (const double bad : {-0.5, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(decode_factors(encode_factors({matrix(bad), {}, {}}, key), key, patches), SceneError) << bad;
    KeptRows backwards = rows();
    backwards.patches.row_start = {0, 2, 1, 3};
    EXPECT_THROW(decode_factors(encode_factors(backwards, key), key, patches), SceneError);
}

TEST(StoredFactors, KeyTellsWhatMattersAndNothingElse)
{
    const Scene scene = testing::floor_and_lamp();
    const PatchMeshArrays mesh = testing::grid_mesh(scene, 2).arrays();
    const AdaptiveOptions options;
    const Json whole = factors_key(scene, mesh, options, "avx");
    Scene brighter = scene;
    for (Material& m : brighter.materials) {
        m.name += "2";
        if (m.reflects()) m.reflectance *= 0.5;
        if (m.emits()) m.emission *= 2.0;
    }
    AdaptiveOptions solver = options;
    solver.final.solver = Solver::jacobi;
    EXPECT_EQ(factors_key(brighter, mesh, solver, "avx"), whole);

    Scene dark = scene, moved = scene;
    for (Material& m : dark.materials) m.reflectance = Rgb(0);
    moved.vertices[0].x += 1e-12;
    AdaptiveOptions rays = options;
    rays.form_factors.rays = 513;
    EXPECT_NE(factors_key(dark, mesh, options, "avx"), whole);
    EXPECT_NE(factors_key(moved, mesh, options, "avx"), whole);
    EXPECT_NE(factors_key(scene, mesh, rays, "avx"), whole);
    EXPECT_NE(factors_key(scene, mesh, options, "sse"), whole);
    EXPECT_NE(factors_key(scene, testing::grid_mesh(scene, 3).arrays(), options, "avx"), whole);
}

}  // namespace
}  // namespace patchlight
