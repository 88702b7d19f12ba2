#pragma once

#include "solver/solve.h"

namespace patchlight {

/// The equation of the light reflected, R = B − E: (I − ρF) R = ρ F E. What both Krylov solvers need of it; three bands
/// at once, each for itself. Keeps references.
class ReflectedSystem {
public:
    ReflectedSystem(const RadiositySystem& system, const LightOperator& F);

    /// E + ρ F B − B, which is 0 for the answer.
    Radiosity residual(const Radiosity& B) const;

    /// q = p − ρ F p.
    void apply(const Radiosity& p, Radiosity& q) const;

    /// Σ A|r| / (1 − ρmax) over Σ A B, of the worst band.
    double bound(const Radiosity& r, const Radiosity& B) const;

    /// B = E where nothing is reflected.
    void settle_black(Radiosity& B) const;

    /// Light below E by no more than a bound() accounts for (A_i (E − B)_i ≤ bound · Σ A B), which an iteration may
    /// leave, is raised to E: that brings it nearer to the answer. What is lower stays, to be found.
    void raise_to_emission(double bound, Radiosity& B) const;

    /// Adds the residual to a report: its end, its history, whether it is good enough; and tells the monitor.
    void record(double residual, SolveReport& report, const SolveOptions& options, const WorkMonitor& monitor) const;

private:
    /// Σ A B.
    Rgb total_power(const Radiosity& B) const;

    const RadiositySystem& system_;
    const LightOperator& F_;
    Rgb rho_max_{0.0};
};

/// Σ_i w_i a_i b_i.
Rgb dot(const PatchField<Rgb>& w, const Radiosity& a, const Radiosity& b);

/// a / b, 0 where b is 0: a band without light, or one that is solved to the last bit.
Rgb quotient(const Rgb& a, const Rgb& b);

/// y += s · x.
void add_scaled(const Rgb& s, const Radiosity& x, Radiosity& y);

}  // namespace patchlight
