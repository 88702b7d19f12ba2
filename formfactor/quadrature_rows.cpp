#include "formfactor/quadrature_rows.h"

#include "formfactor/black_backs.h"
#include "formfactor/compressed_rows.h"
#include "formfactor/subdivided_exchange.h"
#include "meshing/positive_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace patchlight {

namespace {

constexpr double default_tolerance = 1e-3;
constexpr double look_for_backs = 1e-2;       // rows that miss more may see some
constexpr std::size_t most_nodes = 1U << 14;  // of a pair

/// Exchanges of patch i with those after it.
struct HalfRow {
    std::vector<std::uint32_t> columns;
    std::vector<double> exchanges;
};

struct PairScratch {
    std::optional<SubdividedExchange> exchange;
    std::size_t traced = 0;  ///< nodes
};

std::array<Vec3, 3> corners_of(const PatchMesh& mesh, PatchId patch)
{
    const auto c = mesh.corners(patch);
    return {mesh.position(c[0]), mesh.position(c[1]), mesh.position(c[2])};
}

/// A_i F_ij for all j > i.
class HalfRows {
public:
    HalfRows(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const FormFactorOptions& options)
        : scene_(scene), caster_(caster), mesh_(mesh), options_(options), blockers_(scene)
    {}

    HalfRow row(PatchId i, PairScratch& scratch) const
    {
        if (!scratch.exchange) scratch.exchange.emplace(blockers_, caster_);
        HalfRow result;
        // Patches are in order of their surfaces, and those of one surface see nothing of each other.
        for (std::uint32_t j = mesh_.patches_of(mesh_.surface(i)).last; j < mesh_.patch_count(); ++j) {
            const double exchange = pair(i, PatchId(j), scratch);
            if (!(exchange > 0)) continue;
            result.columns.push_back(j);
            result.exchanges.push_back(exchange);
        }
        return result;
    }

    const Blockers& blockers() const { return blockers_; }

private:
    double pair(PatchId i, PatchId j, PairScratch& scratch) const
    {
        SubdividedExchange& exchange = *scratch.exchange;
        const std::uint64_t key = (std::uint64_t{i.value} << 32) | j.value;
        const auto a = corners_of(mesh_, i), b = corners_of(mesh_, j);
        exchange.start(options_.seed, key);
        const double unoccluded =
            exchange.add(a, scene_.surface(mesh_.surface(i)).frame.n, b, scene_.surface(mesh_.surface(j)).frame.n);
        if (!(unoccluded > 0)) return 0;
        const double tolerance = options_.tolerance > 0 ? options_.tolerance : default_tolerance;
        OccludedOptions until;
        until.tolerance = tolerance * std::sqrt(unoccluded * std::min(mesh_.area(i), mesh_.area(j)));
        until.max_nodes = most_nodes;
        const ExchangeEstimate estimate = exchange.refine(until, false);
        scratch.traced += estimate.nodes;
        return estimate.value;
    }

    const Scene& scene_;
    const RayCaster& caster_;
    const PatchMesh& mesh_;
    FormFactorOptions options_;
    Blockers blockers_;
};

/// Whole rows from the halves: what i exchanges with j > i is j's as well.
FormFactorMatrix mirrored(const PatchMesh& mesh, const std::vector<HalfRow>& halves, bool closed, std::size_t nodes)
{
    const std::size_t n = halves.size();
    std::vector<HalfRow> lower(n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < halves[i].columns.size(); ++k) {
            HalfRow& row = lower[halves[i].columns[k]];
            row.columns.push_back(static_cast<std::uint32_t>(i));
            row.exchanges.push_back(halves[i].exchanges[k]);
        }
    CompressedRows rows(n);
    FormFactorRow row;
    for (std::size_t i = 0; i < n; ++i) {
        row = {};
        for (const HalfRow* half : {&std::as_const(lower[i]), &halves[i]})
            for (std::size_t k = 0; k < half->columns.size(); ++k) {
                row.patches.emplace_back(half->columns[k]);
                row.factors.push_back(half->exchanges[k] / mesh.area(PatchId(i)));
                row.raw_sum += row.factors.back();
            }
        if (!closed) row.escaped = positive_part(1 - row.raw_sum);
        rows.put(PatchId(i), row);
    }
    return rows.matrix(nodes);
}

}  // namespace

FormFactorMatrix quadrature_rows(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh,
                                 const FormFactorOptions& options, const WorkMonitor& monitor)
{
    const HalfRows pairs(scene, caster, mesh, options);
    std::vector<HalfRow> halves(mesh.patch_count());
    const std::size_t nodes =
        for_each_row<PairScratch>(halves.size(), monitor, [&](std::size_t i, PairScratch& scratch) {
            halves[i] = pairs.row(PatchId(i), scratch);
        });
    FormFactorMatrix F = mirrored(mesh, halves, scene.closed, nodes);
    if (scene.closed) add_backs(scene, caster, mesh, pairs.blockers(), look_for_backs, options.seed, F, monitor);
    return F;
}

}  // namespace patchlight
