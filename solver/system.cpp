#include "solver/system.h"

#include "formfactor/form_factor_matrix.h"

#include <array>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

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

std::optional<DirectLight> emitters_light(const Scene& scene, const WorkMonitor& monitor)
{
    constexpr double most_work = 3e10;  // pairs of a surface and an emitter, times surfaces that may hide it
    const std::vector<SurfaceId> sources = emitters(scene);
    if (sources.size() > RowSampler::most_sources) return {};
    const auto surfaces = static_cast<double>(scene.surfaces.size());
    if (surfaces * surfaces * static_cast<double>(sources.size()) > most_work) return {};
    return std::optional<DirectLight>(std::in_place, scene, sources, monitor);
}

Rgb direct_irradiance(const Scene& scene, const DirectLight& direct, const Vec3& place, SurfaceId surface,
                      DirectLight::Scratch& scratch)
{
    std::array<double, 16> few;
    std::vector<double> many;
    std::span<double> factors(few.data(), std::min(few.size(), direct.source_count()));
    if (direct.source_count() > few.size()) {
        many.resize(direct.source_count());
        factors = many;
    }
    direct.factors(place, surface, factors, scratch);
    Rgb H(0.0);
    for (std::size_t k = 0; k < factors.size(); ++k) H += factors[k] * scene.material_of(direct.source(k)).emission;
    return H;
}

namespace {

/// The mean over each patch, by a rule of degree 2.
PatchField<Rgb> mean_direct(const Exchange& exchange)
{
    const PatchMesh& mesh = exchange.mesh;
    PatchField<Rgb> H(mesh.patch_count(), Rgb(0.0));
    tbb::enumerable_thread_specific<DirectLight::Scratch> scratches;
    tbb::parallel_for(std::size_t{0}, mesh.patch_count(), [&](std::size_t i) {
        const PatchId p(i);
        const SurfaceId surface = mesh.surface(p);
        if (!exchange.scene.material_of(surface).reflects()) return;
        const auto c = mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 place =
                (4.0 * mesh.position(c[k]) + mesh.position(c[(k + 1) % 3]) + mesh.position(c[(k + 2) % 3])) / 6.0;
            H[p] += direct_irradiance(exchange.scene, *exchange.direct, place, surface, scratches.local()) / 3.0;
        }
    });
    return H;
}

}  // namespace

RadiositySystem unassembled(const Exchange& exchange)
{
    const Scene& scene = exchange.scene;
    const PatchMesh& mesh = exchange.mesh;
    RadiositySystem system;
    if (exchange.direct) system.direct = mean_direct(exchange);
    system.area = mesh.areas();
    system.E = emittance(scene, mesh);
    system.rho = PatchField<Rgb>(mesh.patch_count());
    for (const PatchId p : mesh.patches()) system.rho[p] = scene.material_of(mesh.surface(p)).reflectance;
    return system;
}

RadiositySystem assemble(const Exchange& exchange, const FormFactorOptions& options, const WorkMonitor& monitor,
                         FormFactorMatrix* kept)
{
    RadiositySystem system = unassembled(exchange);
    if (kept && kept->size() == exchange.mesh.patch_count()) {
        system.F = *kept;
        return system;
    }
    system.F = form_factor_matrix(exchange.scene, exchange.caster, exchange.mesh, exchange.locator, options, monitor,
                                  exchange.direct ? std::vector<SurfaceId>{} : emitters(exchange.scene));
    if (kept) *kept = system.F;
    return system;
}

EnergyBalance energy_balance(const RadiositySystem& system, const Radiosity& B)
{
    EnergyBalance energy;
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        Rgb H = system.direct.empty() ? Rgb(0.0) : system.direct[p];
        for (std::size_t k = system.F.row_start[i]; k < system.F.row_start[i + 1]; ++k) {
            const PatchId j(system.F.columns[k]);
            H += system.F.factors[k] * (system.direct.empty() ? B[j] : B[j] - system.E[j]);
        }
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
