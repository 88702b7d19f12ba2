#pragma once

#include "formfactor/polygon_factor.h"
#include "meshing/read_scene.h"
#include "meshing/refinement.h"
#include "solver/solve.h"

#include <Eigen/Dense>
#include <array>
#include <tbb/parallel_for.h>
#include <vector>

/// Linear systems, and their answers by elimination.
namespace patchlight::testing {

using Square = std::array<Vec3, 4>;

/// The inside of the unit cube, k × k squares a face; the second face is the ceiling.
inline std::vector<Square> cube_squares(int k)
{
    struct Face {
        Vec3 corner, u, v;
    };
    const std::array<Face, 6> faces{Face{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Face{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                                    Face{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, Face{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                    Face{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, Face{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
    std::vector<Square> squares;
    for (const Face& f : faces)
        for (int i = 0; i < k; ++i)
            for (int j = 0; j < k; ++j) {
                const auto at = [&](int a, int b) {
                    return f.corner + static_cast<double>(a) / k * f.u + static_cast<double>(b) / k * f.v;
                };
                squares.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    return squares;
}

/// Rows from A_i F_ij as a whole square array; zeros are left out.
inline FormFactorMatrix rows_from(const std::vector<double>& exchange, const PatchField<double>& area)
{
    const std::size_t n = area.size();
    FormFactorMatrix F;
    F.row_start.push_back(0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            if (exchange[i * n + j] == 0) continue;
            F.columns.push_back(static_cast<std::uint32_t>(j));
            F.factors.push_back(exchange[i * n + j] / area[PatchId(i)]);
        }
        F.row_start.push_back(F.columns.size());
    }
    F.raw_sum = F.escaped = F.backs = PatchField<double>(n, 0.0);
    return F;
}

/// The cube of reference-values.md §6: closed-form factors, 12 × 12 squares a face, ρ everywhere, and the 4 × 4 squares
/// at the ceiling's centre emit.
inline RadiositySystem cube_system(double rho)
{
    constexpr int k = 12;
    // Dear enough to be computed once.
    static const FormFactorMatrix F = [] {
        const std::vector<Square> squares = cube_squares(k);
        const std::size_t n = squares.size();
        std::vector<double> exchange(n * n, 0.0);
        tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
            for (std::size_t j = 0; j < i; ++j)
                if (i / (k * k) != j / (k * k))
                    exchange[i * n + j] = exchange[j * n + i] = polygon_exchange(squares[i], squares[j]);
        });
        return rows_from(exchange, PatchField<double>(n, 1.0 / (k * k)));
    }();
    RadiositySystem system;
    system.F = F;
    system.area = PatchField<double>(F.size(), 1.0 / (k * k));
    system.rho = PatchField<Rgb>(F.size(), Rgb(rho));
    system.E = PatchField<Rgb>(F.size(), Rgb(0.0));
    for (std::size_t i = 4; i < 8; ++i)
        for (std::size_t j = 4; j < 8; ++j) system.E[PatchId((k + i) * k + j)] = Rgb(10, 5, 2);
    return system;
}

/// The Cornell box on a uniform mesh, its rows by any method.
inline RadiositySystem cornell_system(const FormFactorOptions& options, std::size_t elements)
{
    SceneOptions in_millimetres;
    in_millimetres.unit = 1e-3;
    const Scene scene = read_scene(PATCHLIGHT_DATA "/scenes/cornell-box.obj", in_millimetres).scene;
    const PatchMesh mesh = triangulate(scene, {.max_elements = elements});
    const RayCaster caster(scene);
    const PatchLocator locator(mesh);
    return assemble({scene, caster, mesh, locator}, options);
}

/// (I − ρF)⁻¹ E by elimination, band by band.
inline Radiosity eliminated(const RadiositySystem& system)
{
    const std::size_t n = system.area.size();
    const auto size = static_cast<Eigen::Index>(n);
    Radiosity B(n);
    for (int band = 0; band < 3; ++band) {
        Eigen::MatrixXd M = Eigen::MatrixXd::Identity(size, size);
        Eigen::VectorXd E(size);
        for (std::size_t i = 0; i < n; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            E[row] = system.E[PatchId(i)][band];
            for (std::size_t k = system.F.row_start[i]; k < system.F.row_start[i + 1]; ++k)
                M(row, system.F.columns[k]) -= system.rho[PatchId(i)][band] * system.F.factors[k];
        }
        const Eigen::VectorXd x = M.partialPivLu().solve(E);
        for (std::size_t i = 0; i < n; ++i) B[PatchId(i)][band] = x[static_cast<Eigen::Index>(i)];
    }
    return B;
}

/// √(ΣA|B − B̃|²/ΣA|B|²) over the patches that don't emit (`off_light`), or over all; the bands together.
inline double relative_error(const RadiositySystem& system, const Radiosity& exact, const Radiosity& B,
                             bool off_light = true)
{
    double num = 0, den = 0;
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        if (off_light && system.E[p] != Rgb(0.0)) continue;
        num += system.area[p] * glm::dot(B[p] - exact[p], B[p] - exact[p]);
        den += system.area[p] * glm::dot(exact[p], exact[p]);
    }
    return den > 0 ? std::sqrt(num / den) : std::sqrt(num);
}

}  // namespace patchlight::testing
