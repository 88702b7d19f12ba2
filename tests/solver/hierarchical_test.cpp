// Links between groups of patches against closed forms and the dense system of exact factors.
#include "solver/hierarchical.h"

#include "formfactor/form_factor_matrix.h"
#include "meshing/read_scene.h"
#include "tests/formfactor/boxes.h"
#include "tests/formfactor/random_scenes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace patchlight {
namespace {

using testing::cube_inside;

/// A scene with its mesh and what else light is exchanged over.
struct Room {
    Room(Scene s, std::size_t elements, bool exact_direct)
        : scene(std::move(s)), caster(scene), mesh(triangulate(scene, {.max_elements = elements})), locator(mesh),
          direct(exact_direct ? emitters_light(scene) : std::nullopt)
    {}

    Exchange exchange() const { return {scene, caster, mesh, locator, direct ? &*direct : nullptr}; }

    Scene scene;
    RayCaster caster;
    PatchMesh mesh;
    PatchLocator locator;
    std::optional<DirectLight> direct;
};

Scene read(const std::string& name, double unit = 1)
{
    SceneOptions options;
    options.unit = unit;
    return read_scene(std::string(PATCHLIGHT_DATA) + "/scenes/" + name, options).scene;
}

struct Linked {
    Radiosity B;
    HierarchicalSolution solution;
};

Linked linked(const Room& room, double tolerance, const WorkMonitor& monitor = {})
{
    Linked result;
    result.B = emittance(room.scene, room.mesh);
    result.solution = solve_hierarchical(room.exchange(), unassembled(room.exchange()), result.B,
                                         {.tolerance = tolerance}, monitor);
    return result;
}

/// The same system by exact factors of all pairs.
Radiosity dense(const Room& room)
{
    RadiositySystem system = unassembled(room.exchange());
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    system.F = form_factor_matrix(room.scene, room.caster, room.mesh, room.locator, options, {});
    Radiosity B = emittance(room.scene, room.mesh);
    const Radiosity E = system.E;
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) {
            system.E[p] = system.rho[p] * system.direct[p];
            B[p] -= E[p];
        }
    solve_gathering(system, B, {.tolerance = 1e-9});
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) B[p] += E[p];
    return B;
}

/// Relative L2 error of the reflected part.
double error(const Room& room, const Radiosity& B, const Radiosity& reference)
{
    double wrong = 0, all = 0;
    for (const PatchId p : room.mesh.patches()) {
        const Rgb E = room.scene.material_of(room.mesh.surface(p)).emission;
        const Rgb d = B[p] - reference[p], R = reference[p] - E;
        wrong += room.mesh.area(p) * glm::dot(d, d);
        all += room.mesh.area(p) * glm::dot(R, R);
    }
    return std::sqrt(wrong / all);
}

void expect_convergence(const char* name, const Room& room)
{
    const Radiosity reference = dense(room);
    const auto n = static_cast<double>(room.mesh.patch_count());
    std::printf("%s, %zu patches\n  tolerance  estimated  error   links    links/n2  rays\n", name,
                room.mesh.patch_count());
    double last = 1;
    for (const double tolerance : {0.16, 0.08, 0.04, 0.02, 0.01, 0.005, 0.0025}) {
        const Linked found = linked(room, tolerance);
        last = error(room, found.B, reference);
        double bias = 0, whole = 0;
        for (const PatchId p : room.mesh.patches()) {
            const Rgb E = room.scene.material_of(room.mesh.surface(p)).emission;
            const Rgb d = found.B[p] - reference[p], R = reference[p] - E;
            bias += room.mesh.area(p) * (d.r + d.g + d.b);
            whole += room.mesh.area(p) * (R.r + R.g + R.b);
        }
        std::printf("bias %+.5f", bias / whole);
        std::printf("  %.4f %.4f %.5f %zu %.4f %zu sweeps %zu E %.4f\n", tolerance, found.solution.link_error, last,
                    found.solution.report.links, static_cast<double>(found.solution.report.links) / n / n, found.solution.rays,
                    found.solution.report.iterations, found.solution.energy.relative_residual);
        std::fflush(stdout);
    }
    EXPECT_LT(last, 5e-3);
}

TEST(Explore, Cornell)
{
    expect_convergence("Cornell, direct", Room(read("cornell-box.obj", 1e-3), 1500, true));
    expect_convergence("Cornell, sampled", Room(read("cornell-box.obj", 1e-3), 1500, false));
}

TEST(Explore, Small)
{
    const Room room(read("cornell-box.obj", 1e-3), 300, false);
    const Radiosity reference = dense(room);
    for (const double tolerance : {1e-3, 3e-4, 1e-4, 1e-5}) {
        const Linked found = linked(room, tolerance);
        std::printf("%g %zu links %zu rays error %.5f\n", tolerance, found.solution.report.links, found.solution.rays,
                    error(room, found.B, reference));
    }
}

TEST(Explore, Pairs)
{
    const Room room(read("cornell-box.obj", 1e-3), 300, false);
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    const FormFactorMatrix F = form_factor_matrix(room.scene, room.caster, room.mesh, room.locator, options, {});
    const PatchHierarchy tree = patch_hierarchy(room.scene, room.mesh);
    const NodeExchange exchange(room.scene, room.caster, room.mesh, tree, 1);
    NodeExchange::Scratch scratch;
    std::vector<std::vector<double>> M(F.size(), std::vector<double>(F.size(), 0.0));
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k)
            M[i][F.columns[k]] = F.factors[k] * room.mesh.area(PatchId(i));
    struct Off { double d, found, exact; std::uint32_t i, j, rays; };
    std::vector<Off> offs;
    double total = 0, all = 0;
    for (std::uint32_t p = 0; p < tree.nodes.size(); ++p)
        for (std::uint32_t q = p + 1; q < tree.nodes.size(); ++q) {
            const auto &a = tree.nodes[p], &b = tree.nodes[q];
            if (!a.is_leaf() || !b.is_leaf()) continue;
            const PatchId i = tree.order[a.first], j = tree.order[b.first];
            MeanKernel k;
            if (exchange.may_face(p, q)) k = exchange.between_patches(p, q, 0, scratch);
            const double found = k.mean * a.area * b.area, exact = M[i.value][j.value];
            offs.push_back({found - exact, found, exact, i.value, j.value, k.rays});
            total += found - exact;
            all += exact;
        }
    std::printf("%g of %g\n", total, all);
    std::ranges::sort(offs, std::greater<>{}, [](const Off& o) { return std::abs(o.d); });
    for (int k = 0; k < 12; ++k) {
        const Off& o = offs[k];
        const Vec3 x = room.mesh.centroid(PatchId(o.i)), y = room.mesh.centroid(PatchId(o.j));
        std::printf("%g found %g exact %g rays %u, %zu (%g %g %g) %zu (%g %g %g)\n", o.d, o.found, o.exact, o.rays,
                    std::size_t{room.mesh.surface(PatchId(o.i)).value}, x.x, x.y, x.z,
                    std::size_t{room.mesh.surface(PatchId(o.j)).value}, y.x, y.y, y.z);
    }
}

TEST(Explore, Energy)
{
    for (const bool direct : {true, false}) {
    const Room room(read("furniture-room.obj"), 2500, direct);
    RadiositySystem system = assemble(room.exchange(), {});
    Radiosity B = emittance(room.scene, room.mesh);
    const Radiosity E = system.E;
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) {
            system.E[p] = system.rho[p] * system.direct[p];
            B[p] -= E[p];
        }
    solve_gathering(system, B, {.tolerance = 1e-9});
    if (room.direct)
        for (const PatchId p : room.mesh.patches()) B[p] += E[p];
    system.E = E;
    const EnergyBalance e = energy_balance(system, B);
    std::printf("dense: %g %g %g %g\n", e.emitted, e.absorbed, e.escaped, e.relative_residual);
    const Linked l = linked(room, 0.02);
    const EnergyBalance f = l.solution.energy;
    std::printf("linked: %g %g %g %g\n", f.emitted, f.absorbed, f.escaped, f.relative_residual);
    }
}

TEST(Explore, Furniture)
{
    expect_convergence("furniture, direct", Room(read("furniture-room.obj"), 2500, true));
}

}  // namespace
}  // namespace patchlight
