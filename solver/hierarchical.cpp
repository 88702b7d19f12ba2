#include "solver/hierarchical.h"

#include "solver/lost_light.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

constexpr double coarsest = 16;       // times the tolerance: of the first links
constexpr double linear_share = 0.1;  // of the tolerance: for the linear solve
constexpr int few_sweeps = 8;         // before the last links: coarse ones may even amplify
constexpr int idle_passes = 3;
constexpr std::size_t least_check = 65536;  // rays
constexpr int rechecks = 3;
constexpr int passes = 12;  // of sharing out one tolerance anew over the links that it led to

double square(double x)
{
    return x * x;
}

double squared(const Rgb& x)
{
    return glm::dot(x, x);
}

double sum(const Rgb& x)
{
    return x.r + x.g + x.b;
}

std::vector<float> node_reflectance(const PatchHierarchy& tree, const RadiositySystem& system)
{
    std::vector<double> square(tree.nodes.size());
    std::vector<float> rho(tree.nodes.size());
    for (std::size_t i = 0; i < square.size(); ++i) {
        const PatchHierarchy::Node& node = tree.nodes[i];
        if (node.is_leaf()) {
            square[i] = squared(system.rho[tree.order[node.first]]) / 3;
        } else {
            const auto l = static_cast<std::size_t>(node.left), r = static_cast<std::size_t>(node.right);
            square[i] = (tree.nodes[l].area * square[l] + tree.nodes[r].area * square[r]) / node.area;
        }
        rho[i] = static_cast<float>(std::sqrt(square[i]));
    }
    return rho;
}

/// X = S + ρ F X: the light that links carry, and what it starts from.
class LinkedLight {
public:
    LinkedLight(const Exchange& exchange, const RadiositySystem& system, const Radiosity& start,
                const HierarchicalOptions& options, const WorkMonitor& monitor)
        : exchange_(exchange), system_(system), options_(options), monitor_(monitor),
          tree_(patch_hierarchy(exchange.scene, exchange.mesh, lit_surfaces(exchange, options.seed))),
          nodes_(exchange.scene, exchange.caster, exchange.mesh, tree_, options.seed), links_(tree_, nodes_),
          direct_(!system.direct.empty()), S_(start.size()), X_(start), H_(start.size(), Rgb(0.0))
    {
        for (std::size_t i = 0; i < start.size(); ++i) {
            const PatchId p(i);
            S_[p] = direct_ ? system.rho[p] * system.direct[p] : system.E[p];
            if (direct_) X_[p] -= system.E[p];
            X_[p] = glm::max(X_[p], S_[p]);
            rho_max_ = glm::max(rho_max_, system.rho[p]);
        }
        light_.rho = node_reflectance(tree_, system);
    }

    HierarchicalSolution solve()
    {
        HierarchicalSolution solution;
        solution.nodes = tree_.nodes.size();
        solution.report.solver = Solver::hierarchical;
        solution.report.converged = true;
        if (norm() > 0 || guessed_norm() > 0)
            for (double times = coarsest; times >= 1; times /= 2) link_and_sweep(times, solution);
        solution.report.rays = solution.rays;
        solution.bytes = links_.bytes() + tree_.nodes.size() * sizeof(PatchHierarchy::Node);
        solution.energy = energy_balance();
        return solution;
    }

    void store(Radiosity& B) const
    {
        for (std::size_t i = 0; i < B.size(); ++i) {
            const PatchId p(i);
            B[p] = direct_ ? system_.E[p] + X_[p] : X_[p];
        }
    }

private:
    /// Σ A |reflected light|².
    double norm() const
    {
        double total = 0;
        for (std::size_t i = 0; i < X_.size(); ++i) {
            const PatchId p(i);
            total += system_.area[p] * squared(direct_ ? X_[p] : X_[p] - S_[p]);
        }
        return total;
    }

    /// What it may be about where nothing is known but the emitters: their light, spread evenly, reflected once.
    double guessed_norm() const
    {
        double area = 0, reflecting = 0;
        Rgb power(0.0);
        for (std::size_t i = 0; i < X_.size(); ++i) {
            const PatchId p(i);
            area += system_.area[p];
            power += system_.area[p] * X_[p];
            reflecting += system_.area[p] * squared(system_.rho[p]) / 3;
        }
        return area > 0 ? reflecting * squared(power / area) : 0;
    }

    /// One round of multigridding, for so many times the tolerance.
    void link_and_sweep(double times, HierarchicalSolution& solution)
    {
        const bool last = times == 1;
        for (int again = 0; again <= (last ? rechecks : 0); ++again) {
            link(times, solution);
            links_.sort_links();
            sweep(linear_share * times * options_.tolerance, last ? options_.max_sweeps : few_sweeps, solution.report);
            if (!last) return;
            links_.gather(X_, H_);
            solution.check = check_links(exchange_, system_.rho, X_, H_, std::max(least_check, solution.rays / 8),
                                         options_.seed + static_cast<std::uint64_t>(again), {monitor_.stop, {}});
            solution.imbalance = imbalance();
            const bool sure = solution.check.at_least() > options_.tolerance;
            if (!sure && solution.imbalance <= options_.tolerance) break;
            // More may be wrong than the links know: by as much their errors count for more.
            trust_ *= options_.tolerance / std::max(sure ? solution.check.error : 0.0, solution.imbalance);
        }
        SolveReport& report = solution.report;
        const double error = std::max({solution.link_error, solution.check.at_least(), solution.imbalance});
        report.converged = report.converged && error <= options_.tolerance;
        report.residual = std::max(report.residual, error);
    }

    /// Refines until the links' estimated error is below the tolerance for the light that there is now.
    void link(double times, HierarchicalSolution& solution)
    {
        const double tolerance = times * trust_ * options_.tolerance;
        links_.pull(X_, light_);
        double reflected = norm();
        if (!(reflected > 0)) reflected = guessed_norm();
        const double first = square(tolerance) * reflected / static_cast<double>(4 * X_.size());
        if (most_ == 0 || first < most_) most_ = first;
        WorkMonitor linking{monitor_.stop, {}};
        if (monitor_.tell)
            linking.tell = [&](const WorkState& state) {
                monitor_.tell({.fraction = 0.5 / times, .rays = solution.rays + state.rays});
            };
        for (int pass = 0, idle = 0; pass < passes; ++pass) {
            const LinkingReport report = links_.refine(light_, most_, linking);
            solution.rays += report.rays;
            solution.report.links = report.links;
            const double before = solution.link_error;
            solution.link_error = std::sqrt(links_.squared_error(light_) / reflected);
            idle = pass > 0 && solution.link_error > 0.99 * before ? idle + 1 : 0;
            // Between patches nothing may be left to do.
            if (solution.link_error <= tolerance || idle == idle_passes) break;
            if (links_.links().size() > options_.max_links) break;
            // The error falls about with the cube root.
            most_ *= std::clamp(std::pow(tolerance / solution.link_error, 3), 0.02, 0.7);
        }
    }

    /// Jacobi on the links, to the bound that solve_gathering has, in L1.
    void sweep(double tolerance, int most, SolveReport& report)
    {
        for (int k = 0; k < most; ++k) {
            if (monitor_.stop.stop_requested()) throw Interrupted();
            links_.gather(X_, H_);
            Rgb change(0.0), total(0.0);
            for (std::size_t i = 0; i < X_.size(); ++i) {
                const PatchId p(i);
                const Rgb now = S_[p] + system_.rho[p] * H_[p];
                change += system_.area[p] * glm::abs(now - X_[p]);
                total += system_.area[p] * now;
                X_[p] = now;
            }
            ++report.iterations;
            report.residual = 0;
            for (int band = 0; band < 3; ++band)
                if (total[band] > 0)
                    report.residual =
                        std::max(report.residual, change[band] * rho_max_[band] / (1 - rho_max_[band]) / total[band]);
            report.history.push_back(report.residual);
            report.converged = report.residual <= tolerance;
            if (report.converged) return;
        }
    }

    /// HierarchicalSolution::imbalance, less twice the standard error of what is lost; H_ is what links bring of X_.
    double imbalance() const
    {
        constexpr std::size_t rays = 65536;
        double sent = 0, arrived = 0, started = 0;
        for (std::size_t i = 0; i < X_.size(); ++i) {
            const PatchId p(i);
            sent += system_.area[p] * sum(X_[p]);
            arrived += system_.area[p] * sum(H_[p]);
            started += system_.area[p] * sum(S_[p]);
        }
        if (!(started > 0)) return 0;
        const LostLight found = lost_light(exchange_, X_, rays, options_.seed);
        const double lost = found.escaped + found.backs, share = lost / sent;
        const double noise = sent * std::sqrt((share * (1 - share) + 1.0 / rays) / rays);
        return std::max(0.0, std::abs(sent - arrived - lost) - 2 * noise) / started;
    }

    /// From H of the last sweep: its X is what the patches sent out then, but for the linear solve's tolerance.
    EnergyBalance energy_balance() const
    {
        EnergyBalance energy;
        for (std::size_t i = 0; i < X_.size(); ++i) {
            const PatchId p(i);
            const Rgb H = direct_ ? system_.direct[p] + H_[p] : H_[p];
            energy.emitted += system_.area[p] * sum(system_.E[p]);
            energy.absorbed += system_.area[p] * sum((1.0 - system_.rho[p]) * H);
        }
        return energy;
    }

    const Exchange& exchange_;
    const RadiositySystem& system_;
    const HierarchicalOptions& options_;
    const WorkMonitor& monitor_;
    PatchHierarchy tree_;
    NodeExchange nodes_;
    LinkOperator links_;
    NodeLight light_;
    bool direct_;
    Radiosity S_, X_, H_;
    Rgb rho_max_{0.0};
    double most_ = 0;   ///< error of one link, W²/m²
    double trust_ = 1;  ///< in links' own errors: measured ones are 1/trust_ of these
};

}  // namespace

HierarchicalSolution solve_hierarchical(const Exchange& exchange, const RadiositySystem& system, Radiosity& B,
                                        const HierarchicalOptions& options, const WorkMonitor& monitor)
{
    LinkedLight light(exchange, system, B, options, monitor);
    HierarchicalSolution solution = light.solve();
    light.store(B);
    const LostLight lost = lost_light(exchange, B, 65536, options.seed);
    EnergyBalance& energy = solution.energy;
    energy.absorbed += lost.backs;
    energy.escaped = lost.escaped;
    if (energy.emitted > 0)
        energy.relative_residual = (energy.emitted - energy.absorbed - energy.escaped) / energy.emitted;
    return solution;
}

}  // namespace patchlight
