#include "solver/invariants.h"

#include "formfactor/audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

double sum(const Rgb& x)
{
    return x.r + x.g + x.b;
}

bool finite(const Rgb& x)
{
    return std::isfinite(x.r) && std::isfinite(x.g) && std::isfinite(x.b);
}

double least(const Rgb& x)
{
    return std::min({x.r, x.g, x.b});
}

/// Counts how often a law is broken, and where worst.
class Law {
public:
    explicit Law(std::string name) : broken_{std::move(name), 0, 0, {}, {}} {}

    /// `excess` > 0, or not a number: broken by that much; `value` is what to tell.
    void hold(double excess, double value, PatchId patch, PatchId other = {})
    {
        if (excess <= 0) return;
        ++broken_.count;
        if (broken_.count > 1 && !(excess > worst_)) return;
        worst_ = excess;
        broken_.value = value;
        broken_.patch = patch;
        broken_.other = other;
    }

    void report_to(std::vector<BrokenInvariant>& all) const
    {
        if (broken_.count > 0) all.push_back(broken_);
    }

private:
    BrokenInvariant broken_;
    double worst_ = 0;
};

constexpr double infinite = std::numeric_limits<double>::infinity();
// Rounding of sums that are compared with what they were made from; the files' patch values are single precision.
constexpr double rounding = 1e-6;

void check_light(const PatchField<Rgb>& E, const Radiosity& B, std::vector<BrokenInvariant>& broken)
{
    Law not_finite("B is not finite"), negative("E is negative or not finite"), below("B is below E");
    for (std::size_t i = 0; i < B.size(); ++i) {
        const PatchId p(i);
        if (!finite(E[p]) || least(E[p]) < 0) {
            negative.hold(infinite, least(E[p]), p);
        } else if (!finite(B[p])) {
            not_finite.hold(infinite, sum(B[p]), p);
        } else {
            const Rgb under = E[p] * (1 - rounding) - B[p];
            below.hold(std::max({under.r, under.g, under.b}), least(B[p] - E[p]), p);
        }
    }
    for (const Law* law : {&negative, &not_finite, &below}) law->report_to(broken);
}

void check_factors(const FormFactorMatrix& F, double above_one, std::vector<BrokenInvariant>& broken)
{
    Law not_finite("a factor is not finite"), outside("a factor is outside [0, 1]");
    for (std::size_t i = 0; i < F.size(); ++i)
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) {
            const double f = F.factors[k];
            if (std::isfinite(f))
                outside.hold(std::max(-f, f - 1 - above_one), f, PatchId(i), PatchId(F.columns[k]));
            else
                not_finite.hold(infinite, f, PatchId(i), PatchId(F.columns[k]));
        }
    not_finite.report_to(broken);
    outside.report_to(broken);
}

void check_rows(const RadiositySystem& system, bool closed, const InvariantTolerances& tolerances,
                std::vector<BrokenInvariant>& broken)
{
    const FormFactorMatrix& F = system.F;
    Law sums("the factors of a row, backs and what escapes don't sum to 1");
    for (std::size_t i = 0; i < F.size(); ++i) {
        const PatchId p(i);
        double all = F.backs[p] + F.escaped[p];
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k) all += F.factors[k];
        // Broken by what is not a number, too.
        sums.hold(std::abs(all - 1) <= tolerances.row_sum ? 0 : std::abs(all - 1), all, p);
    }
    sums.report_to(broken);
    if (std::isinf(tolerances.reciprocity) || F.size() == 0) return;
    const ReciprocityDefect defect = audit(F, system.area, closed).reciprocity;
    if (defect.worst > tolerances.reciprocity)
        broken.push_back({"A_i F_ij is not A_j F_ji", 1, defect.worst, defect.first, defect.second});
}

void check_energy(const RadiositySystem& system, const Radiosity& B, const InvariantTolerances& tolerances,
                  std::vector<BrokenInvariant>& broken)
{
    constexpr double t = 21;
    const FormFactorMatrix& F = system.F;
    const auto exchanged = [&](PatchId p) { return system.direct.empty() ? B[p] : B[p] - system.E[p]; };
    double sent = 0, arrived = 0, squares = 0, largest = 0, brightest = 0;
    for (std::size_t i = 0; i < F.size(); ++i) {
        const PatchId p(i);
        const double X = sum(exchanged(p));
        squares += system.area[p] * X * X;
        largest = std::max(largest, system.area[p]);
        brightest = std::max(brightest, X);
        Rgb H(0.0);
        for (std::size_t k = F.row_start[i]; k < F.row_start[i + 1]; ++k)
            H += F.factors[k] * exchanged(PatchId(F.columns[k]));
        sent += system.area[p] * X;
        arrived += system.area[p] * (sum(H) + X * (F.backs[p] + F.escaped[p]));
    }
    double allowed = tolerances.energy * sent;
    if (tolerances.rays > 0) {
        const double ray = largest / tolerances.rays;
        allowed += std::sqrt(2 * t * 2 * ray * squares) + t / 3 * ray * brightest;
    }
    if (!(std::abs(sent - arrived) <= allowed))
        broken.push_back({"light is made or lost in the exchange", 1, (arrived - sent) / sent, {}, {}});
}

/// Of the light, not of each row: closed is what the emitters shine into, and dark patches may look out.
void check_escape(const RadiositySystem& system, const Radiosity& B, double tolerance,
                  std::vector<BrokenInvariant>& broken)
{
    double sent = 0, escaped = 0, most = 0;
    BrokenInvariant leak{"light escapes from a closed scene, as a share of all", 0, 0, {}, {}};
    for (std::size_t i = 0; i < system.F.size(); ++i) {
        const PatchId p(i);
        const double power = system.area[p] * sum(B[p]), lost = power * system.F.escaped[p];
        sent += power;
        escaped += lost;
        if (lost > 0) ++leak.count;
        if (lost > most) {
            most = lost;
            leak.patch = p;
        }
    }
    leak.value = escaped / sent;
    if (escaped > tolerance * sent) broken.push_back(leak);
}

std::string place_of(PatchId patch, const Scene& scene, const PatchMesh& mesh)
{
    const SurfaceId surface = mesh.surface(patch);
    const Surface& s = scene.surface(surface);
    return fmt::format("patch {} of surface {} (object {}, material {})", patch.value, surface.value,
                       s.object.value < scene.objects.size() ? scene.objects[s.object.value] : "",
                       scene.materials[s.material.value].name);
}

}  // namespace

InvariantTolerances invariant_tolerances(const AdaptiveOptions& options)
{
    InvariantTolerances t;
    const FormFactorMethod method = options.form_factors.method;
    if (method == FormFactorMethod::hemisphere) {
        t.rays = options.form_factors.rays;
        // Its steps don't even out: on few rays it is far off, always to the same side.
        if (options.form_factors.directions == HemisphereDirections::lecture_grid) t.row_sum = t.energy = 0.3;
    } else if (method == FormFactorMethod::hemicube) {
        // The rule that weighs pixels by their middles is off by 0.54/resolution². All of a row is seen from one point:
        // what that is off by for a patch's neighbours is for the mesh to say.
        t.factor = 1.0 / (static_cast<double>(options.form_factors.resolution) * options.form_factors.resolution);
        t.row_sum += t.factor;
        t.energy = 0.5;
    }
    if (method == FormFactorMethod::exact || method == FormFactorMethod::quadrature) {
        // They know of each pair alone; what a row lacks is their error, which is asked for, and pairs share one A F.
        t.row_sum = std::max(method == FormFactorMethod::exact ? 0.1 : 0.2, 10 * options.form_factors.tolerance);
        t.reciprocity = 1e-6;
        t.energy = t.row_sum;
    } else if (options.final.solver == Solver::conjugate_gradient) {
        // Scaling can't always bring every row to its sum; the row may be of one factor.
        t.row_sum = t.energy = t.factor = 0.3;
        t.reciprocity = 1e-6;
    }
    return t;
}

std::vector<BrokenInvariant> broken_invariants(const RadiositySystem& system, const Radiosity& B, bool closed,
                                               const InvariantTolerances& tolerances)
{
    std::vector<BrokenInvariant> broken;
    Law area("an area is not above 0");
    for (std::size_t i = 0; i < system.area.size(); ++i) {
        const double A = system.area[PatchId(i)];
        area.hold(A > 0 && std::isfinite(A) ? 0 : infinite, A, PatchId(i));
    }
    area.report_to(broken);
    check_light(system.E, B, broken);
    check_factors(system.F, tolerances.factor, broken);
    // What follows would only say the same again.
    if (!broken.empty()) return broken;
    check_rows(system, closed, tolerances, broken);
    if (closed) check_escape(system, B, tolerances.closure, broken);
    if (system.F.size() > 0) check_energy(system, B, tolerances, broken);
    return broken;
}

std::vector<BrokenInvariant> broken_invariants(const Scene& scene, const PatchMesh& mesh, const Radiosity& B,
                                               const Reconstruction& nodes)
{
    std::vector<BrokenInvariant> broken;
    check_light(emittance(scene, mesh), B, broken);
    Law bad("B at a node is negative or not finite");
    const auto hold = [&](const Rgb& value, PatchId p) {
        bad.hold(finite(value) ? -least(value) : infinite, least(value), p);
    };
    for (const PatchId p : mesh.patches()) {
        for (const VertexId v : mesh.corners(p)) hold(nodes.B[v], p);
        if (!nodes.middle_B.empty())
            for (const Rgb& value : nodes.middle_B[p]) hold(value, p);
    }
    bad.report_to(broken);
    return broken;
}

void require_none(const std::vector<BrokenInvariant>& broken, const Scene& scene, const PatchMesh& mesh)
{
    if (broken.empty()) return;
    std::string text;
    for (const BrokenInvariant& b : broken) {
        text += text.empty() ? b.law : "; " + b.law;
        if (b.count > 1) text += fmt::format(" ({} times)", b.count);
        text += fmt::format(": {:.6g}", b.value);
        if (b.patch.valid()) text += " at " + place_of(b.patch, scene, mesh);
        if (b.other.valid()) text += " and " + place_of(b.other, scene, mesh);
    }
    throw InvariantError(text + "; such an answer is wrong and is not kept: try another --form-factors, or more "
                                "elements, and report the scene");
}

}  // namespace patchlight
