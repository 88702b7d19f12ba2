#include "solver/system.h"

#include "formfactor/form_factor_matrix.h"

namespace patchlight {

namespace {

double sum(const Rgb& x)
{
    return x.r + x.g + x.b;
}

}  // namespace

std::vector<SurfaceId> emitters(const Scene& scene)
{
    std::vector<SurfaceId> result;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        if (scene.material_of(SurfaceId(s)).emits()) result.emplace_back(s);
    return result;
}

Radiosity emittance(const Scene& scene, const PatchMesh& mesh)
{
    Radiosity E(mesh.patch_count());
    for (const PatchId p : mesh.patches()) E[p] = scene.material_of(mesh.surface(p)).emission;
    return E;
}

RadiositySystem unassembled(const Scene& scene, const PatchMesh& mesh)
{
    RadiositySystem system;
    system.area = mesh.areas();
    system.E = emittance(scene, mesh);
    system.rho = PatchField<Rgb>(mesh.patch_count());
    for (const PatchId p : mesh.patches()) system.rho[p] = scene.material_of(mesh.surface(p)).reflectance;
    return system;
}

RadiositySystem assemble(const Exchange& exchange, const FormFactorOptions& options, const WorkMonitor& monitor)
{
    RadiositySystem system = unassembled(exchange.scene, exchange.mesh);
    system.F = form_factor_matrix(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, options, monitor,
                                  emitters(exchange.scene));
    return system;
}

EnergyBalance energy_balance(const RadiositySystem& system, const Radiosity& B)
{
    EnergyBalance energy;
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        Rgb H(0.0);
        for (std::size_t k = system.F.row_start[i]; k < system.F.row_start[i + 1]; ++k)
            H += system.F.factors[k] * B[PatchId(system.F.columns[k])];
        const double A = system.area[p];
        energy.emitted += A * sum(system.E[p]);
        energy.absorbed += A * sum((1.0 - system.rho[p]) * H) + A * sum(B[p]) * system.F.backs[p];
        energy.escaped += A * sum(B[p]) * system.F.escaped[p];
    }
    if (energy.emitted > 0)
        energy.relative_residual = (energy.emitted - energy.absorbed - energy.escaped) / energy.emitted;
    return energy;
}

}  // namespace patchlight
