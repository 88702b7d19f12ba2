#include "solver/reflected_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patchlight {

ReflectedSystem::ReflectedSystem(const RadiositySystem& system, const LightOperator& F) : system_(system), F_(F)
{
    for (const Rgb& rho : system.rho.values()) rho_max_ = glm::max(rho_max_, rho);
}

Radiosity ReflectedSystem::residual(const Radiosity& B) const
{
    Radiosity r(B.size());
    F_(B, r);
    for (std::size_t i = 0; i < r.size(); ++i) {
        const PatchId p(i);
        r[p] = system_.E[p] + system_.rho[p] * r[p] - B[p];
    }
    return r;
}

void ReflectedSystem::apply(const Radiosity& p, Radiosity& q) const
{
    F_(p, q);
    for (std::size_t i = 0; i < q.size(); ++i) q[PatchId(i)] = p[PatchId(i)] - system_.rho[PatchId(i)] * q[PatchId(i)];
}

double ReflectedSystem::bound(const Radiosity& r, const Radiosity& B) const
{
    const Rgb total = total_power(B);
    Rgb left(0.0);
    for (std::size_t i = 0; i < r.size(); ++i) left += system_.area[PatchId(i)] * glm::abs(r[PatchId(i)]);
    double worst = 0;
    for (int band = 0; band < 3; ++band) {
        if (left[band] == 0) continue;
        // Started from darkness, there is nothing yet to compare with.
        worst = std::max(worst, total[band] > 0 ? left[band] / (1 - rho_max_[band]) / total[band]
                                                : std::numeric_limits<double>::infinity());
    }
    return worst;
}

void ReflectedSystem::settle_black(Radiosity& B) const
{
    for (std::size_t i = 0; i < B.size(); ++i)
        for (int band = 0; band < 3; ++band)
            if (system_.rho[PatchId(i)][band] == 0) B[PatchId(i)][band] = system_.E[PatchId(i)][band];
}

void ReflectedSystem::raise_to_emission(double bound, Radiosity& B) const
{
    const Rgb most = bound * total_power(B);
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        for (int band = 0; band < 3; ++band) {
            const double missing = system_.E[p][band] - B[p][band];
            if (missing > 0 && system_.area[p] * missing <= most[band]) B[p][band] = system_.E[p][band];
        }
    }
}

Rgb ReflectedSystem::total_power(const Radiosity& B) const
{
    Rgb total(0.0);
    for (std::size_t i = 0; i < B.size(); ++i) total += system_.area[PatchId(i)] * B[PatchId(i)];
    return total;
}

void ReflectedSystem::record(double residual, SolveReport& report, const SolveOptions& options,
                             const WorkMonitor& monitor) const
{
    report.residual = residual;
    report.converged = residual <= options.tolerance;
    if (report.iterations > 0) report.history.push_back(residual);
    if (monitor.tell)
        monitor.tell(
            {.fraction = std::clamp(std::log(residual) / std::log(options.tolerance), 0.0, 1.0), .residual = residual});
}

Rgb dot(const PatchField<Rgb>& w, const Radiosity& a, const Radiosity& b)
{
    Rgb sum(0.0);
    for (std::size_t i = 0; i < a.size(); ++i) sum += w[PatchId(i)] * a[PatchId(i)] * b[PatchId(i)];
    return sum;
}

Rgb quotient(const Rgb& a, const Rgb& b)
{
    Rgb result(0.0);
    for (int band = 0; band < 3; ++band)
        if (b[band] != 0) result[band] = a[band] / b[band];
    return result;
}

void add_scaled(const Rgb& s, const Radiosity& x, Radiosity& y)
{
    for (std::size_t i = 0; i < y.size(); ++i) y[PatchId(i)] += s * x[PatchId(i)];
}

}  // namespace patchlight
