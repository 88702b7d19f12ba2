#include "formfactor/direct_light.h"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace patchlight {

namespace {

constexpr double least_cell = 1.0 / 128;  // of the scene's diameter

PlaneRectangle rectangle_around(const Scene& scene, const Surface& surface)
{
    PlaneRectangle result{surface.frame, Vec2(1e300), Vec2(-1e300)};
    for (const std::uint32_t v : surface.loops.front()) {
        const Vec2 q = surface.frame.to_plane(scene.vertices[v]);
        result.low = glm::min(result.low, q);
        result.high = glm::max(result.high, q);
    }
    return result;
}

}  // namespace

DirectLight::DirectLight(const Scene& scene, std::span<const SurfaceId> sources, const WorkMonitor& monitor)
    : sources_(sources.begin(), sources.end()), blockers_(scene)
{
    const std::vector<Facet> facets = facets_of(scene);
    for (std::size_t k = 0; k < sources_.size(); ++k)
        for (auto f = std::ranges::lower_bound(facets, sources_[k], {}, &Facet::surface);
             f != facets.end() && f->surface == sources_[k]; ++f)
            parts_.push_back({k, *f, glm::dot(f->normal, f->corners[0])});
    std::vector<std::size_t> reflecting;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        Receiver& receiver = receivers_.emplace_back();
        receiver.rectangle = rectangle_around(scene, scene.surfaces[s]);
        if (!scene.material_of(SurfaceId(s)).reflects()) continue;
        receiver.first_sight = reflecting.size() * parts_.size();
        reflecting.push_back(s);
    }
    sights_.resize(reflecting.size() * parts_.size());
    tbb::parallel_for(std::size_t{0}, sights_.size(), [&](std::size_t i) {
        if (monitor.stop.stop_requested()) return;
        prepare(receivers_[reflecting[i / parts_.size()]], parts_[i % parts_.size()], least_cell * scene.diameter,
                sights_[i]);
    });
    if (monitor.stop.stop_requested()) throw Interrupted();
}

void DirectLight::prepare(const Receiver& receiver, const Part& part, double least_side,
                          std::unique_ptr<const Sight>& sight)
{
    auto seen = std::make_unique<Sight>();
    seen->cells = BlockerCells(blockers_, receiver.rectangle, part.facet, least_side);
    if (seen->cells.hidden()) return;
    const PlaneFrame& frame = receiver.rectangle.frame;
    keep_front(part.facet.corners, frame.n, glm::dot(frame.n, frame.origin), blockers_.snap(), seen->front);
    sight = std::move(seen);
}

void DirectLight::factors(const Vec3& x, SurfaceId surface, std::span<double> factors, Scratch& scratch) const
{
    assert(factors.size() == sources_.size());
    const Receiver& receiver = receivers_[surface.value];
    std::ranges::fill(factors, 0.0);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const Part& part = parts_[p];
        if (receiver.first_sight != no_sights)
            factors[part.source] += factor(x, receiver, part, sights_[receiver.first_sight + p].get(), scratch);
        else
            factors[part.source] +=
                point_factor(blockers_, x, receiver.rectangle.frame.n, std::span(&part.facet, 1), scratch.point);
    }
}

double DirectLight::factor(const Vec3& x, const Receiver& receiver, const Part& part, const Sight* sight,
                           Scratch& scratch) const
{
    if (sight == nullptr || glm::dot(part.facet.normal, x) - part.offset <= blockers_.snap()) return 0;
    if (!sight->cells.find(x, receiver.rectangle, blockers_, scratch.views)) return 0;
    scratch.point.visible.last_edges.clear();  // another order of points must not change the last bit
    return visible_factor(x, receiver.rectangle.frame.n, sight->front, scratch.views, scratch.point.visible);
}

std::size_t DirectLight::cell_count() const
{
    std::size_t count = 0;
    for (const auto& sight : sights_)
        if (sight) count += sight->cells.cell_count();
    return count;
}

std::size_t DirectLight::bytes() const
{
    std::size_t sum = sights_.capacity() * sizeof(sights_[0]);
    for (const auto& sight : sights_)
        if (sight) sum += sizeof(Sight) + sight->cells.bytes();
    return sum;
}

}  // namespace patchlight
