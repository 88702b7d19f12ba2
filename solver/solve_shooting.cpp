#include "solver/solve.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace patchlight {

namespace {

double sum(const Rgb& x)
{
    return x.r + x.g + x.b;
}

/// The state of a progressive solve beside B itself.
struct Unshot {
    const RadiositySystem& system;
    Radiosity light;  // ΔB, not yet shot; negative: shot before it came
    Rgb rho_max{0.0}, mean_rho{0.0};
    double area = 0;

    explicit Unshot(const RadiositySystem& s) : system(s), light(s.E)
    {
        for (std::size_t i = 0; i < light.size(); ++i) {
            rho_max = glm::max(rho_max, s.rho[PatchId(i)]);
            mean_rho += s.area[PatchId(i)] * s.rho[PatchId(i)];
            area += s.area[PatchId(i)];
        }
        if (area > 0) mean_rho /= area;
    }

    /// Σ A|ΔB|.
    Rgb power() const
    {
        Rgb total(0.0);
        for (std::size_t i = 0; i < light.size(); ++i) total += system.area[PatchId(i)] * glm::abs(light[PatchId(i)]);
        return total;
    }

    /// What the patch shoots when `ambient` light is taken for certain.
    Rgb shot_of(PatchId i, const Rgb& ambient) const { return light[i] + system.rho[i] * ambient; }

    PatchId brightest(ShootingOrder order, const Rgb& ambient) const
    {
        PatchId best(0);
        double most = -1;
        for (std::size_t i = 0; i < light.size(); ++i) {
            const double weight = order == ShootingOrder::unshot_power ? system.area[PatchId(i)] : 1.0;
            if (const double now = weight * sum(glm::abs(shot_of(PatchId(i), ambient))); now > most) {
                most = now;
                best = PatchId(i);
            }
        }
        return best;
    }

    /// What all further shots can still add, relative to what there is, in the worst band.
    double bound(const Radiosity& B) const
    {
        const Rgb left = power();
        Rgb total(0.0);
        for (std::size_t i = 0; i < B.size(); ++i) total += system.area[PatchId(i)] * B[PatchId(i)];
        double worst = 0;
        for (int band = 0; band < 3; ++band)
            if (total[band] > 0)
                worst = std::max(worst, rho_max[band] * left[band] / (1 - rho_max[band]) / total[band]);
        return worst;
    }

    /// [CohenChenWallaceGreenberg88]: the unshot light spread evenly, with all its reflections.
    Rgb ambient() const
    {
        Rgb left(0.0);
        for (std::size_t i = 0; i < light.size(); ++i) left += system.area[PatchId(i)] * light[PatchId(i)];
        return area > 0 ? left / area / (1.0 - mean_rho) : Rgb(0.0);
    }
};

}  // namespace

SolveReport solve_shooting(const RadiositySystem& system, const ColumnSource& column_of, Radiosity& B,
                           const SolveOptions& options, const WorkMonitor& monitor,
                           const std::function<void(const SolveReport&, const Radiosity&)>& on_shot)
{
    SolveReport report;
    report.solver = Solver::progressive;
    B = system.E;
    Unshot unshot(system);
    const double emitted = sum(unshot.power());
    std::vector<double> column(B.size());
    const std::size_t most = static_cast<std::size_t>(options.max_sweeps) * B.size();
    for (;;) {
        if (monitor.stop.stop_requested()) throw Interrupted();
        report.residual = unshot.bound(B);
        report.unshot = emitted > 0 ? sum(unshot.power()) / emitted : 0;
        report.converged = report.residual <= options.tolerance;
        if (std::has_single_bit(report.iterations) || report.converged) report.history.push_back(report.residual);
        if (report.converged || report.iterations >= most) break;

        const Rgb ambient = options.overshoot ? unshot.ambient() : Rgb(0.0);
        const PatchId shooter = unshot.brightest(options.order, ambient);
        report.rays += column_of(shooter, column);
        const Rgb shot = unshot.shot_of(shooter, ambient);
        unshot.light[shooter] -= shot;
        for (std::size_t j = 0; j < B.size(); ++j) {
            const Rgb arrived = system.rho[PatchId(j)] * column[j] * shot;
            B[PatchId(j)] += arrived;
            unshot.light[PatchId(j)] += arrived;
        }
        ++report.iterations;
        if (on_shot) on_shot(report, B);
        if (monitor.tell)
            monitor.tell({.fraction = std::clamp(std::log(report.residual) / std::log(options.tolerance), 0.0, 1.0),
                          .rays = report.rays,
                          .unshot = report.unshot});
    }
    if (options.ambient) {
        const Rgb ambient = unshot.ambient();
        for (std::size_t j = 0; j < B.size(); ++j) B[PatchId(j)] += system.rho[PatchId(j)] * ambient;
    }
    return report;
}

}  // namespace patchlight
