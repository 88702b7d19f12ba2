#include "solver/reflected_system.h"

namespace patchlight {

namespace {

/// A/ρ: with this weight ⟨a, b⟩ of the reflected light is the plain one of x = √(A/ρ) R, in which the system is
/// symmetric. Where nothing is reflected R is 0, whatever the weight.
PatchField<Rgb> symmetric_weight(const RadiositySystem& system)
{
    PatchField<Rgb> w(system.area.size());
    for (std::size_t i = 0; i < w.size(); ++i)
        w[PatchId(i)] = quotient(Rgb(system.area[PatchId(i)]), system.rho[PatchId(i)]);
    return w;
}

}  // namespace

SolveReport solve_conjugate_gradient(const RadiositySystem& system, const LightOperator& F, Radiosity& B,
                                     const SolveOptions& options, const WorkMonitor& monitor)
{
    SolveReport report;
    report.solver = Solver::conjugate_gradient;
    const ReflectedSystem reflected(system, F);
    const PatchField<Rgb> w = symmetric_weight(system);
    reflected.settle_black(B);
    Radiosity r = reflected.residual(B), p = r, q(B.size());
    Rgb rr = dot(w, r, r);
    reflected.record(reflected.bound(r, B), report, options, monitor);
    while (!report.converged && report.iterations < static_cast<std::size_t>(options.max_sweeps)) {
        if (monitor.stop.stop_requested()) throw Interrupted();
        reflected.apply(p, q);
        const Rgb alpha = quotient(rr, dot(w, p, q));
        add_scaled(alpha, p, B);
        add_scaled(-alpha, q, r);
        const Rgb before = rr;
        rr = dot(w, r, r);
        const Rgb beta = quotient(rr, before);
        for (std::size_t i = 0; i < p.size(); ++i) p[PatchId(i)] = r[PatchId(i)] + beta * p[PatchId(i)];
        ++report.iterations;
        reflected.record(reflected.bound(r, B), report, options, monitor);
    }
    reflected.raise_to_emission(report.residual, B);
    return report;
}

}  // namespace patchlight
