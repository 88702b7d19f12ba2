#include "formfactor/row_sampler.h"

#include "meshing/positive_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace patchlight {

namespace {

constexpr int set_count = 32;
constexpr int least_shadow_rays = 16;
constexpr std::uint64_t shadow_stream = 0x5ad0ULL << 48;  // other random numbers than the directions'

}  // namespace

RowSampler::RowSampler(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const PatchLocator& locator,
                       std::span<const SurfaceId> sources, const FormFactorOptions& options)
    : scene_(scene), caster_(caster), mesh_(mesh), locator_(locator), options_(options),
      sets_(hemisphere_sets(options, set_count))
{
    if (sources.size() > most_sources) return;
    for (const SurfaceId s : sources) sources_.emplace_back(scene, s);
}

void RowSampler::patch_row(PatchId patch, RowScratch& scratch) const
{
    const SurfaceId surface = mesh_.surface(patch);
    const PlaneFrame& frame = scene_.surface(surface).frame;
    RandomNumbers random(options_.seed, patch.value);
    const HemisphereSet& set = sets_[random.below(set_count)];
    aim(set, frame, 2 * std::numbers::pi * random.uniform(), scratch.rays);

    const auto c = mesh_.corners(patch);
    const Vec3 corner = mesh_.position(c[2]), edge0 = mesh_.position(c[0]) - corner,
               edge1 = mesh_.position(c[1]) - corner;
    const Vec3 start = caster_.leave(corner, frame.n);
    const auto f = [](double x) { return static_cast<float>(x); };
    const float sx = f(start.x), sy = f(start.y), sz = f(start.z);
    const float ax = f(edge0.x), ay = f(edge0.y), az = f(edge0.z), bx = f(edge1.x), by = f(edge1.y), bz = f(edge1.z);
    for (std::size_t i = 0; i < set.size(); ++i) {
        const float s = set.b0[i], t = set.b1[i];
        scratch.rays.ox[i] = sx + s * ax + t * bx;
        scratch.rays.oy[i] = sy + s * ay + t * by;
        scratch.rays.oz[i] = sz + s * az + t * bz;
    }
    accumulate(set, scratch);

    scratch.receivers.clear();
    const std::size_t origins = std::min<std::size_t>(set.size(), 4);
    for (std::size_t k = 0; k < origins; ++k) {
        const std::size_t i = k * set.size() / origins;
        scratch.receivers.push_back({point_of(patch, set.b0[i], set.b1[i]), frame.n});
    }
    swap_small_sources(surface, patch.value, scratch);
    collect(scratch);
}

Vec3 RowSampler::point_of(PatchId patch, float b0, float b1) const
{
    const auto c = mesh_.corners(patch);
    const double s = static_cast<double>(b0), t = static_cast<double>(b1);
    return s * mesh_.position(c[0]) + t * mesh_.position(c[1]) + (1 - s - t) * mesh_.position(c[2]);
}

void RowSampler::point_row(const Vec3& position, SurfaceId surface, std::uint64_t direction_key,
                           std::uint64_t jitter_key, RowScratch& scratch) const
{
    const PlaneFrame& frame = scene_.surface(surface).frame;
    const PickedSet picked = pick_set(sets_.size(), options_.seed, direction_key);
    const HemisphereSet& set = sets_[picked.index];
    aim_from(caster_.leave(position, frame.n), set, frame, picked.turn, scratch.rays);
    accumulate(set, scratch);
    scratch.receivers.assign(1, {position, frame.n});
    swap_small_sources(surface, jitter_key, scratch);
    collect(scratch);
}

void RowSampler::accumulate(const HemisphereSet& set, RowScratch& scratch) const
{
    caster_.closest(scratch.rays, scratch.hits);
    scratch.traced += set.size();
    if (scratch.weight.size() < mesh_.patch_count()) scratch.weight.resize(mesh_.patch_count(), 0.0F);
    scratch.touched.clear();
    scratch.found.resize(set.size());
    locator_.locate(scratch.hits.surface, scratch.hits.x, scratch.hits.y, HitBatch::black_back, scratch.found);
    double escaped = 0, backs = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (!scratch.found[i].valid()) {
            (scratch.hits.surface[i] == HitBatch::escaped ? escaped : backs) += static_cast<double>(set.factor[i]);
            continue;
        }
        float& weight = scratch.weight[scratch.found[i].value];
        if (weight == 0) scratch.touched.push_back(scratch.found[i].value);
        weight += set.factor[i];
    }
    scratch.row.escaped = escaped;
    scratch.row.backs = backs;
    scratch.row.raw_sum = 0;
    for (const std::uint32_t patch : scratch.touched) scratch.row.raw_sum += static_cast<double>(scratch.weight[patch]);
}

void RowSampler::swap_small_sources(SurfaceId own, std::uint64_t key, RowScratch& scratch) const
{
    scratch.small.clear();
    double unoccluded = 0;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
        if (sources_[s].surface() == own) continue;
        double factor = 0;
        for (const ReceiverPoint& r : scratch.receivers) factor += sources_[s].unoccluded(r.position, r.normal);
        factor /= static_cast<double>(scratch.receivers.size());
        if (!(factor > 0) || factor >= options_.small_source) continue;
        scratch.small.emplace_back(s, factor);
        unoccluded += factor;
    }
    // The row with what met nothing or a back: swapping keeps all of it.
    const double row_sum = scratch.row.raw_sum + scratch.row.escaped + scratch.row.backs;
    // Judged on unoccluded factors: these don't depend on chance, so that neighbouring points decide alike.
    if (scratch.small.empty() || unoccluded >= 0.5 * row_sum) return;

    double hits = 0;
    scratch.is_swapped.resize(scene_.surfaces.size(), 0);
    for (const auto& [s, factor] : scratch.small) {
        scratch.is_swapped[sources_[s].surface().value] = 1;
        for (const PatchId p : mesh_.patches_of(sources_[s].surface())) {
            hits += static_cast<double>(scratch.weight[p.value]);
            scratch.weight[p.value] = 0;
        }
    }
    const std::size_t others = scratch.touched.size();
    RandomNumbers random(options_.seed, shadow_stream ^ key);
    double swapped = 0;
    for (const auto& [s, factor] : scratch.small) {
        const int rays = std::max(least_shadow_rays, static_cast<int>(options_.shadow_rays * factor / unoccluded));
        swapped += visible_factor(caster_, sources_[s], scratch.receivers, std::min(rays, options_.shadow_rays), random,
                                  scratch.shadow);
        scratch.traced += std::exchange(scratch.shadow.traced, 0);
        const SurfaceId surface = sources_[s].surface();
        const PlaneFrame& frame = scene_.surface(surface).frame;
        for (const VisibleSample& sample : scratch.shadow.visible) {
            const Vec2 q = frame.to_plane(sample.point);
            const PatchId p = locator_.locate(surface, static_cast<float>(q.x), static_cast<float>(q.y));
            scratch.touched.push_back(p.value);
            scratch.weight[p.value] += static_cast<float>(sample.weight);
        }
    }
    const double rest = row_sum - hits;
    const float keep = rest > 0 ? static_cast<float>(positive_part(row_sum - swapped) / rest) : 1.0F;
    for (std::size_t i = 0; i < others; ++i) {
        const std::uint32_t p = scratch.touched[i];
        if (scratch.is_swapped[mesh_.surface(PatchId(p)).value] == 0) scratch.weight[p] *= keep;
    }
    scratch.row.escaped *= static_cast<double>(keep);
    scratch.row.backs *= static_cast<double>(keep);
    for (const auto& [s, factor] : scratch.small) scratch.is_swapped[sources_[s].surface().value] = 0;
}

void RowSampler::collect(RowScratch& scratch) const
{
    scratch.row.patches.clear();
    scratch.row.factors.clear();
    for (const std::uint32_t p : scratch.touched) {
        // A patch may have been touched twice: by hits and as part of a swapped source.
        if (scratch.weight[p] == 0) continue;
        scratch.row.patches.emplace_back(p);
        scratch.row.factors.push_back(static_cast<double>(scratch.weight[p]));
        scratch.weight[p] = 0;
    }
}

}  // namespace patchlight
