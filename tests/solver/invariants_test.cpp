// Each law broken in turn, in a system small enough to see through.
#include "solver/invariants.h"
#include "tests/formfactor/boxes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace patchlight {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A patch each for the two triangles of two parallel plates that see nothing but each other, F = 1 between opposite
/// ones; the first is lit. B solves it: B_0 = 4 + .5 B_1, B_1 = .5 B_0; nothing reaches the others.
struct Sound {
    RadiositySystem system;
    Radiosity B;

    Sound()
    {
        system.area = PatchField<double>(4, 2.0);
        system.E = PatchField<Rgb>(std::vector<Rgb>{Rgb(4.0), Rgb(0.0), Rgb(0.0), Rgb(0.0)});
        system.rho = PatchField<Rgb>(4, Rgb(0.5));
        system.F.row_start = {0, 1, 2, 3, 4};
        system.F.columns = {1, 0, 3, 2};
        system.F.factors = {1, 1, 1, 1};
        system.F.raw_sum = system.F.escaped = system.F.backs = PatchField<double>(4, 0.0);
        B = Radiosity(std::vector<Rgb>{Rgb(16.0 / 3), Rgb(8.0 / 3), Rgb(0.0), Rgb(0.0)});
    }

    std::vector<BrokenInvariant> broken(bool closed = true, double reciprocity = 1e-6) const
    {
        InvariantTolerances t;
        t.reciprocity = reciprocity;
        return broken_invariants(system, B, closed, t);
    }
};

const PatchId first(std::size_t{0}), second(std::size_t{1}), third(std::size_t{2}), fourth(std::size_t{3});

void expect_one(const std::vector<BrokenInvariant>& broken, const std::string& law, PatchId patch, PatchId other = {})
{
    ASSERT_EQ(broken.size(), 1U) << law;
    EXPECT_EQ(broken[0].law, law);
    EXPECT_EQ(broken[0].patch, patch) << law;
    EXPECT_EQ(broken[0].other, other) << law;
}

TEST(Invariants, HoldWhereNothingIsWrong)
{
    EXPECT_TRUE(Sound().broken().empty());
    RadiositySystem links = Sound().system;
    links.F = {};
    EXPECT_TRUE(broken_invariants(links, Sound().B, true, {}).empty()) << "no rows";
    // Found by fuzzing: links with a method that promises reciprocity.
    EXPECT_TRUE(broken_invariants(links, Sound().B, true, {.reciprocity = 1e-6}).empty()) << "no rows to be reciprocal";
}

TEST(Invariants, WhatIsNoNumberIsFoundWhereverItStands)
{
    Sound in_B;
    in_B.B[third].g = nan;
    expect_one(in_B.broken(), "B is not finite", third);
    Sound in_E;
    in_E.system.E[second].b = nan;
    expect_one(in_E.broken(), "E is negative or not finite", second);
    Sound in_F;
    in_F.system.F.factors[2] = nan;
    expect_one(in_F.broken(), "a factor is not finite", third, fourth);
    Sound in_backs;
    in_backs.system.F.backs[fourth] = nan;
    EXPECT_EQ(in_backs.broken().front().law, "the factors of a row, backs and what escapes don't sum to 1");
    Sound in_area;
    in_area.system.area[fourth] = 0;
    expect_one(in_area.broken(), "an area is not above 0", fourth);
}

TEST(Invariants, FactorsStayBetweenNoneAndAll)
{
    Sound above;
    above.system.F.factors[1] = 1.31;
    expect_one(above.broken(), "a factor is outside [0, 1]", second, first);
    Sound below;
    below.system.F.factors[3] = -1e-3;
    expect_one(below.broken(), "a factor is outside [0, 1]", fourth, third);
}

TEST(Invariants, RowsSumToOneWithBacksAndWhatEscapes)
{
    Sound short_row;
    short_row.system.F.factors[2] = 0.99;
    const auto broken = short_row.broken();
    ASSERT_FALSE(broken.empty());
    EXPECT_EQ(broken[0].patch, third);
    EXPECT_DOUBLE_EQ(broken[0].value, 0.99);
    // What is missing met a back: nothing is wrong.
    short_row.system.F.backs[third] = 0.01;
    EXPECT_TRUE(short_row.broken(true, 0.1).empty());
}

TEST(Invariants, ReciprocityCountsWhereItIsPromised)
{
    Sound one_way;
    one_way.system.F.factors[2] = 0.8;
    one_way.system.F.backs[third] = 0.2;
    expect_one(one_way.broken(), "A_i F_ij is not A_j F_ji", third, fourth);
    EXPECT_TRUE(one_way.broken(true, std::numeric_limits<double>::infinity()).empty());
}

TEST(Invariants, LightDoesNotEscapeFromAClosedScene)
{
    Sound leak;
    leak.system.F.factors[0] = leak.system.F.factors[1] = 0.9;
    leak.system.F.escaped[first] = leak.system.F.escaped[second] = 0.1;
    EXPECT_TRUE(leak.broken(false).empty()) << "an open one";
    expect_one(leak.broken(true), "light escapes from a closed scene, as a share of all", first);
    Sound dark;
    dark.system.F.factors[2] = dark.system.F.factors[3] = 0.9;
    dark.system.F.escaped[third] = dark.system.F.escaped[fourth] = 0.1;
    EXPECT_TRUE(dark.broken(true).empty()) << "patches that look out, but no light does";
}

TEST(Invariants, RadiosityIsAtLeastEmittanceAndThatNotNegative)
{
    Sound below;
    below.B[first].r = 3.9;
    expect_one(below.broken(), "B is below E", first);
    Sound negative;
    negative.B[third].r = -1e-9;
    expect_one(negative.broken(), "B is below E", third);
    Sound emission;
    emission.system.E[fourth].r = -1;
    expect_one(emission.broken(), "E is negative or not finite", fourth);
}

TEST(Invariants, LightIsNotMadeInTheExchange)
{
    // The small patch lights the large one with the large one's factor: rows sum to 1, and yet light is made.
    Sound made;
    made.system.area[second] = 20;
    const auto broken = made.broken(true, std::numeric_limits<double>::infinity());
    expect_one(broken, "light is made or lost in the exchange", {});
    // Sent 2·16/3 + 20·8/3 = 64, arrived 2·8/3 + 20·16/3 = 112.
    EXPECT_NEAR(broken[0].value, 112.0 / 64 - 1, 1e-12);
}

/// The tolerances follow what a method promises.
TEST(Invariants, MethodsAreHeldToTheirPromises)
{
    AdaptiveOptions options;
    EXPECT_TRUE(std::isinf(invariant_tolerances(options).reciprocity)) << "sampled";
    options.final.solver = Solver::conjugate_gradient;
    EXPECT_LT(invariant_tolerances(options).reciprocity, 1e-3) << "made reciprocal";
    options.final.solver = Solver::gauss_seidel;
    options.form_factors.method = FormFactorMethod::exact;
    EXPECT_LT(invariant_tolerances(options).reciprocity, 1e-3);
    EXPECT_LE(invariant_tolerances(options).energy, 0.1);
    EXPECT_LE(invariant_tolerances(options).factor, 1e-6);
    options.form_factors.method = FormFactorMethod::hemicube;
    EXPECT_LT(invariant_tolerances(options).factor, 1e-4) << "of 256 pixels across";
}

class ReconstructedCube : public ::testing::Test {
protected:
    Scene scene_ = testing::cube_inside({0, 1, 0, 0, 0, 0}, {{.name = "wall"}, {.name = "lamp", .emission = Rgb(2.0)}});
    PatchMesh mesh_ = triangulate(scene_, {.max_edge = 1});
    Radiosity B_ = Radiosity(mesh_.patch_count(), Rgb(3.0));
    Reconstruction nodes_{VertexRadiosity(mesh_.vertex_count(), Rgb(3.0)), {}, 0};
};

TEST_F(ReconstructedCube, NodesAreFiniteAndNotNegative)
{
    EXPECT_TRUE(broken_invariants(scene_, mesh_, B_, nodes_).empty());
    nodes_.B[VertexId(std::size_t{5})].b = -1;
    EXPECT_EQ(broken_invariants(scene_, mesh_, B_, nodes_).at(0).law, "B at a node is negative or not finite");
    nodes_.B[VertexId(std::size_t{5})].b = nan;
    EXPECT_EQ(broken_invariants(scene_, mesh_, B_, nodes_).size(), 1U);
    nodes_.B[VertexId(std::size_t{5})].b = 3;
    nodes_.middle_B = MidpointRadiosity(mesh_.patch_count(), {Rgb(1.0), Rgb(1.0), Rgb(nan)});
    EXPECT_EQ(broken_invariants(scene_, mesh_, B_, nodes_).size(), 1U);
}

TEST_F(ReconstructedCube, WhatIsBrokenIsNamedWithItsSurface)
{
    EXPECT_NO_THROW(require_none({}, scene_, mesh_));
    B_[PatchId(std::size_t{mesh_.patches_of(SurfaceId(std::size_t{1})).first})] = Rgb(1.0);
    try {
        require_none(broken_invariants(scene_, mesh_, B_, nodes_), scene_, mesh_);
        FAIL() << "B is below E, and nobody says so";
    } catch (const InvariantError& error) {
        EXPECT_THAT(error.what(),
                    AllOf(HasSubstr("B is below E"), HasSubstr("of surface 1 (object cube, material lamp)"),
                          HasSubstr("is not kept")));
    }
}

}  // namespace
}  // namespace patchlight
