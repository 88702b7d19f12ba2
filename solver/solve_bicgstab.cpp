#include "solver/reflected_system.h"

#include <cmath>

namespace patchlight {

namespace {

/// The recurrence's vectors. A band whose residual has become orthogonal to its shadow starts anew.
struct Recurrence {
    PatchField<Rgb> w;  // A
    Radiosity r, shadow, p, v, t;
    Rgb rho{0.0};

    Recurrence(const RadiositySystem& system, Radiosity start)
        : w(system.area.size()), r(std::move(start)), shadow(r), p(r), v(r.size()), t(r.size())
    {
        for (std::size_t i = 0; i < w.size(); ++i) w[PatchId(i)] = Rgb(system.area[PatchId(i)]);
        rho = dot(w, r, r);
    }

    void step(const ReflectedSystem& reflected, Radiosity& B)
    {
        reflected.apply(p, v);
        const Rgb alpha = quotient(rho, dot(w, shadow, v));
        add_scaled(alpha, p, B);
        add_scaled(-alpha, v, r);
        reflected.apply(r, t);
        const Rgb omega = quotient(dot(w, t, r), dot(w, t, t));
        add_scaled(omega, r, B);
        add_scaled(-omega, t, r);
        turn(alpha, omega);
    }

private:
    void turn(const Rgb& alpha, const Rgb& omega)
    {
        constexpr double orthogonal = 1e-12;
        const Rgb before = rho, rr = dot(w, r, r), ss = dot(w, shadow, shadow);
        rho = dot(w, shadow, r);
        for (int band = 0; band < 3; ++band) {
            const bool anew =
                std::abs(rho[band]) <= orthogonal * std::sqrt(rr[band] * ss[band]) || before[band] * omega[band] == 0;
            const double beta = anew ? 0 : rho[band] / before[band] * (alpha[band] / omega[band]);
            for (std::size_t i = 0; i < p.size(); ++i) {
                const PatchId k(i);
                if (anew) shadow[k][band] = r[k][band];
                p[k][band] = r[k][band] + beta * (p[k][band] - omega[band] * v[k][band]);
            }
            if (anew) rho[band] = rr[band];
        }
    }
};

}  // namespace

SolveReport solve_bicgstab(const RadiositySystem& system, const LightOperator& F, Radiosity& B,
                           const SolveOptions& options, const WorkMonitor& monitor)
{
    SolveReport report;
    report.solver = Solver::bicgstab;
    const ReflectedSystem reflected(system, F);
    reflected.settle_black(B);
    Recurrence recurrence(system, reflected.residual(B));
    reflected.record(reflected.bound(recurrence.r, B), report, options, monitor);
    while (!report.converged && report.iterations < static_cast<std::size_t>(options.max_sweeps)) {
        if (monitor.stop.stop_requested()) throw Interrupted();
        recurrence.step(reflected, B);
        ++report.iterations;
        double bound = reflected.bound(recurrence.r, B);
        if (bound <= options.tolerance) {
            // The recurrence's residual drifts from the true one: only that counts.
            Radiosity r = reflected.residual(B);
            bound = reflected.bound(r, B);
            if (bound > options.tolerance) recurrence = Recurrence(system, std::move(r));
        }
        reflected.record(bound, report, options, monitor);
    }
    reflected.raise_to_emission(report.residual, B);
    return report;
}

}  // namespace patchlight
