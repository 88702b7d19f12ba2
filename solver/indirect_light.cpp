#include "solver/indirect_light.h"

#include "meshing/refinement.h"
#include "solver/importance.h"
#include "solver/light_carrier.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace patchlight {

namespace {

constexpr int fewest_rays = 32;  // half of them each time

/// Irradiance per patch by everything but the emitters where they are apart: what must have arrived for B − E to leave.
PatchField<Rgb> indirect_irradiance(const RoughSolution& rough, const EmittedLight& emitted,
                                    const GatherOptions& options, const WorkMonitor& monitor)
{
    const PatchMesh& mesh = rough.exchange.mesh;
    std::vector<SurfacePoint> middles;
    for (const PatchId p : mesh.patches()) middles.push_back({mesh.centroid(p), mesh.surface(p), mesh.centroid(p)});
    const bool exact = !rough.system.direct.empty();
    const std::vector<Rgb> direct =
        exact ? std::vector<Rgb>{} : emitted.at(rough.exchange, middles, options, monitor).irradiance;
    PatchField<Rgb> H(mesh.patch_count(), Rgb(0.0));
    for (const PatchId p : mesh.patches())
        for (int band = 0; band < 3; ++band) {
            const double rho = rough.system.rho[p][band];
            if (!(rho > 0)) continue;
            const double all = (rough.B[p][band] - rough.system.E[p][band]) / rho;
            H[p][band] = std::max(0.0, all - (exact ? rough.system.direct[p] : direct[p.value])[band]);
        }
    return H;
}

/// The mean over the patches around each vertex, by area.
VertexField<Rgb> around_vertices(const PatchMesh& mesh, const PatchField<Rgb>& values)
{
    VertexField<Rgb> sum(mesh.vertex_count(), Rgb(0.0));
    VertexField<double> area(mesh.vertex_count(), 0.0);
    for (const PatchId p : mesh.patches())
        for (const VertexId v : mesh.corners(p)) {
            sum[v] += mesh.area(p) * values[p];
            area[v] += mesh.area(p);
        }
    for (const VertexId v : mesh.vertices())
        if (area[v] > 0) sum[v] /= area[v];
    return sum;
}

/// The same with other directions.
HitRowOptions other(HitRowOptions options)
{
    options.seed ^= 0x9e3779b97f4a7c15ULL;
    return options;
}

/// Light gathered twice, each time with half the rays, by place: of the nodes of one mesh most are nodes of the next
/// one, too. Hits are kept.
class Gathered {
public:
    Gathered(const LightCarrier& carrier, const HitRowOptions& half)
        : carrier_(carrier), rows_{HitRows(carrier.exchange(), half), HitRows(carrier.exchange(), other(half))}
    {}

    /// By what leaves now; at points known already, by what left when they came.
    GatheredLight at(std::span<const SurfacePoint> points, const QuadraticRadiosity& leaving,
                     const WorkMonitor& monitor)
    {
        std::vector<std::uint32_t> fresh;
        const std::vector<std::uint32_t> indices = add(points, fresh, monitor);
        for (std::size_t k = 0; k < 2; ++k) {
            const std::vector<Rgb> found = rows_[k].irradiance(fresh, leaving, monitor);
            irradiance_[k].insert(irradiance_[k].end(), found.begin(), found.end());
        }
        GatheredLight result;
        for (const std::uint32_t i : indices) {
            result.irradiance.push_back(irradiance_[0][i]);
            result.again.push_back(irradiance_[1][i]);
        }
        return result;
    }

    /// By what leaves now at all of them.
    GatheredLight anew(std::span<const SurfacePoint> points, const QuadraticRadiosity& leaving,
                       const WorkMonitor& monitor)
    {
        std::vector<std::uint32_t> fresh;
        const std::vector<std::uint32_t> indices = add(points, fresh, monitor);
        for (auto& irradiance : irradiance_) irradiance.resize(known_.size());
        return {rows_[0].irradiance(indices, leaving, part_of(monitor, 0, 0.5)),
                rows_[1].irradiance(indices, leaving, part_of(monitor, 0.5, 1)), 0};
    }

    std::size_t rays() const { return rows_[0].rays() + rows_[1].rays(); }
    bool keeps_all() const { return rows_[0].keeps_all() && rows_[1].keeps_all(); }

private:
    struct Key {
        std::int64_t x, y, z;
        std::uint32_t surface;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& key) const
        {
            const auto bits = [](std::int64_t x) { return static_cast<std::uint64_t>(x); };
            return RandomNumbers(RandomNumbers(bits(key.x), bits(key.y)).bits(),
                                 bits(key.z) ^ (std::uint64_t{key.surface} << 40))
                .bits();
        }
    };

    // What halving an edge makes of its middle is the middle but for rounding.
    Key key_of(const SurfacePoint& point) const
    {
        const Vec3 q = point.position / (1e-9 * carrier_.exchange().scene.diameter);
        return {std::llround(q.x), std::llround(q.y), std::llround(q.z), point.surface.value};
    }

    std::vector<std::uint32_t> add(std::span<const SurfacePoint> points, std::vector<std::uint32_t>& fresh,
                                   const WorkMonitor& monitor)
    {
        std::vector<SurfacePoint> unknown;
        std::vector<std::uint32_t> indices;
        for (const SurfacePoint& point : points) {
            const auto next = static_cast<std::uint32_t>(known_.size());
            const auto [place, is_new] = known_.try_emplace(key_of(point), next);
            indices.push_back(place->second);
            if (!is_new) continue;
            unknown.push_back(point);
            fresh.push_back(next);
        }
        rows_[0].add(unknown, part_of(monitor, 0, 0.5));
        rows_[1].add(unknown, part_of(monitor, 0.5, 1));
        return indices;
    }

    const LightCarrier& carrier_;
    std::array<HitRows, 2> rows_;
    std::unordered_map<Key, std::uint32_t, Hash> known_;
    std::array<std::vector<Rgb>, 2> irradiance_;
};

/// Points all over what reflects, each for the same area.
struct Probes {
    std::vector<SurfacePoint> points;
    double area = 0;  ///< m², of each
};

/// One in each of `count` equal shares of the area.
Probes spread_probes(const Scene& scene, const PatchMesh& mesh, std::size_t count, std::uint64_t seed)
{
    double area = 0, until = 0;
    for (const PatchId p : mesh.patches())
        if (scene.material_of(mesh.surface(p)).reflects()) area += mesh.area(p);
    Probes probes{{}, area / static_cast<double>(count)};
    auto& points = probes.points;
    for (const PatchId p : mesh.patches()) {
        if (!scene.material_of(mesh.surface(p)).reflects()) continue;
        until += mesh.area(p);
        while (points.size() < count && (static_cast<double>(points.size()) + 0.5) * probes.area < until) {
            RandomNumbers random(seed, points.size());
            const double r = std::sqrt(random.uniform()), s = random.uniform();
            const auto c = mesh.corners(p);
            const Vec3 place =
                (1 - r) * mesh.position(c[0]) + r * (1 - s) * mesh.position(c[1]) + r * s * mesh.position(c[2]);
            points.push_back({place, mesh.surface(p), place});
        }
    }
    return probes;
}

/// √∫|ρ ΔH|² dA of the mean of two gatherings, each point standing for an area: half their difference is the error.
double noise_of(const Scene& scene, std::span<const SurfacePoint> points, std::span<const double> areas,
                const GatheredLight& light)
{
    double sum = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const Rgb half =
            0.5 * scene.material_of(points[i].surface).reflectance * (light.irradiance[i] - light.again[i]);
        sum += areas[i] * glm::dot(half, half);
    }
    return std::sqrt(sum);
}

/// How many rays leave so much noise, √∫|ρ ΔH|² dA. Nets, like stratified directions, lose it like n^-3/4 [Mitchell96].
int rays_for(double goal, const LightCarrier& carrier, const QuadraticRadiosity& leaving, const Probes& probes,
             const IndirectOptions& options, std::size_t& traced, const WorkMonitor& monitor)
{
    constexpr int pilot_rays = 128;
    Gathered gathered(carrier, {.rays = pilot_rays / 2, .directions = options.directions, .seed = options.gather.seed});
    const double noise =
        noise_of(carrier.exchange().scene, probes.points, std::vector<double>(probes.points.size(), probes.area),
                 gathered.at(probes.points, leaving, monitor));
    traced += gathered.rays();
    return static_cast<int>(std::clamp(pilot_rays * std::pow(noise / goal, 4.0 / 3), double{fewest_rays}, 65536.0));
}

/// A third of the area of the patches around each vertex that reflect.
std::vector<double> vertex_areas(const Scene& scene, const PatchMesh& mesh)
{
    std::vector<double> areas(mesh.vertex_count(), 0.0);
    for (const PatchId p : mesh.patches())
        if (scene.material_of(mesh.surface(p)).reflects())
            for (const VertexId v : mesh.corners(p)) areas[v.value] += mesh.area(p) / 3;
    return areas;
}

using SharedMesh = std::shared_ptr<const PatchMesh>;

/// A mesh to begin with: few patches, and the contact lines.
PatchMesh coarse_mesh(const Scene& scene, std::size_t elements)
{
    std::vector<SurfaceLine> contacts;
    for (const SurfaceLine& line : scene.contact_lines)
        if (scene.material_of(line.surface).reflects()) contacts.push_back(line);
    const double edge = scene.diameter / std::clamp(std::sqrt(static_cast<double>(elements)) / 12, 1.0, 6.0);
    return triangulate(scene, {.max_edge = edge, .min_angle = 0}, contacts);
}

/// Light on quadratic elements: values at nodes, vertices first.
IndirectLight light_on(SharedMesh mesh, const ElementPoints& nodes, std::span<const Rgb> values)
{
    VertexField<Rgb> corners(mesh->vertex_count());
    MidpointRadiosity middles(mesh->patch_count());
    for (const VertexId v : mesh->vertices()) corners[v] = values[v.value];
    for (const PatchId p : mesh->patches())
        for (std::size_t k = 0; k < 3; ++k) middles[p][k] = values[nodes.midpoint_of[p.value][k]];
    return IndirectLight(std::move(mesh), std::move(corners), std::move(middles));
}

std::vector<Rgb> mean_of_both(const GatheredLight& light)
{
    std::vector<Rgb> mean(light.irradiance.size());
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5 * (light.irradiance[i] + light.again[i]);
    return mean;
}

/// √∫|ρ ΔH|² dA by which the elements miss the light at points between their nodes. Both gatherings have their own
/// elements and their own error, whose product is free of what the rays miss, in the mean.
double interpolation_error(const Scene& scene, const SharedMesh& mesh, const ElementPoints& nodes,
                           const GatheredLight& at_nodes, const Probes& probes, const GatheredLight& at_probes)
{
    const IndirectLight one = light_on(mesh, nodes, at_nodes.irradiance);
    const IndirectLight other = light_on(mesh, nodes, at_nodes.again);
    double sum = 0;
    for (std::size_t i = 0; i < probes.points.size(); ++i) {
        const SurfacePoint& point = probes.points[i];
        const Rgb rho = scene.material_of(point.surface).reflectance;
        sum += probes.area * glm::dot(rho * (at_probes.irradiance[i] - one.at(scene, point)),
                                      rho * (at_probes.again[i] - other.at(scene, point)));
    }
    return std::sqrt(std::max(0.0, sum));
}

/// The whole light at each patch's middle, what marking weighs its error against.
Radiosity at_middles(const Scene& scene, const PatchMesh& mesh, const LightCarrier& carrier,
                     const QuadraticRadiosity& leaving)
{
    Radiosity B(mesh.patch_count());
    for (const PatchId p : mesh.patches())
        B[p] =
            scene.material_of(mesh.surface(p)).emission + carrier.reflected(mesh.surface(p), mesh.centroid(p), leaving);
    return B;
}

/// Halves edges until linear elements miss less than `enough`, or half the budget is used. `light` is what there is to
/// begin with.
IndirectLight refined_for(const RoughSolution& rough, const LightCarrier& carrier, Gathered& gathered,
                          IndirectLight light, double enough, const IndirectOptions& options,
                          const WorkMonitor& monitor)
{
    const Exchange& start = rough.exchange;
    const Scene& scene = start.scene;
    const MeshingOptions budget{.max_elements = options.max_elements / 2};
    auto shared = std::make_shared<const PatchMesh>(coarse_mesh(scene, options.max_elements));
    QuadraticRadiosity leaving = carrier.leaving(light);
    // Nodes cost alike; they end at the budget or, the error falling like 1/n, where it is small enough.
    const double most = 0.95 * static_cast<double>(budget.max_elements);
    double done = 0, needed = most;
    for (int cycle = 0;; ++cycle) {
        const PatchMesh& mesh = *shared;
        const auto n = static_cast<double>(mesh.patch_count());
        const double next = std::max(done, std::min(1.0, n / std::min(most, needed)));
        const PatchLocator locator(mesh);
        const Exchange exchange{scene, start.caster, mesh, locator, start.direct};
        GatheredLight found;
        const LightAtPoints at_nodes = [&](std::span<const SurfacePoint> points, const WorkMonitor& m) {
            return found = gathered.at(points, leaving, m);
        };
        const ErrorEstimate error =
            evaluate(exchange, at_nodes, Indicator::middles, 0, 0, part_of(monitor, done, next)).error;
        done = next;
        needed = n * error.total / enough;
        light = light_on(shared, element_points(exchange), mean_of_both(found));
        leaving = carrier.leaving(light);
        const ErrorEstimate counted =
            rough.weights ? weighted(error, weights_on(scene, mesh, start.locator, *rough.weights)) : error;
        const RefinementPlan plan = mark(scene, mesh, at_middles(scene, mesh, carrier, leaving), counted, options.mark);
        const bool full = 20 * mesh.patch_count() >= 19 * budget.max_elements;
        if (plan.empty() || full || error.total < enough || cycle == 60) return light;
        shared = std::make_shared<const PatchMesh>(refined(scene, mesh, plan, budget));
    }
}

/// Two sweeps over the kept hits, a bounce each, or one where not all are kept; and what is left of errors after them.
IndirectLight swept(const Exchange& start, const LightCarrier& carrier, Gathered& gathered, IndirectLight light,
                    const Probes& probes, const WorkMonitor& monitor)
{
    const Scene& scene = start.scene;
    const SharedMesh mesh = light.mesh();
    const PatchLocator locator(*mesh);
    const ElementPoints nodes = element_points({scene, start.caster, *mesh, locator, start.direct});
    QuadraticRadiosity leaving;
    GatheredLight found;
    // What isn't kept would be traced again each time.
    const int sweeps = gathered.keeps_all() ? 2 : 1;
    const double share = 1.0 / (sweeps + 1);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        leaving = carrier.leaving(light);
        found = gathered.anew(nodes.points, leaving, part_of(monitor, sweep * share, (sweep + 1) * share));
        light = light_on(mesh, nodes, mean_of_both(found));
    }
    light.noise = noise_of(scene, nodes.points, vertex_areas(scene, *mesh), found);
    light.mesh_error = interpolation_error(scene, mesh, nodes, found, probes,
                                           gathered.anew(probes.points, leaving, part_of(monitor, 1 - share, 1)));
    return light;
}

}  // namespace

IndirectLight::IndirectLight(std::shared_ptr<const PatchMesh> mesh, VertexField<Rgb> at_vertices,
                             MidpointRadiosity at_middles)
    : mesh_(std::move(mesh)), locator_(std::make_unique<const PatchLocator>(*mesh_)),
      at_vertices_(std::move(at_vertices)), at_middles_(std::move(at_middles))
{}

Rgb IndirectLight::at(const Scene& scene, const SurfacePoint& point) const
{
    return ElementLight{*mesh_, *locator_, at_vertices_, &at_middles_}.at(
        point.surface, scene.surface(point.surface).frame.to_plane(point.position));
}

double IndirectLight::error() const
{
    return std::sqrt(mesh_error * mesh_error + noise * noise);
}

IndirectLight solve_indirect(const RoughSolution& rough, const EmittedLight& emitted, const IndirectOptions& options,
                             const WorkMonitor& monitor)
{
    const Exchange& start = rough.exchange;
    const Scene& scene = start.scene;
    // Shares of the time, as measured on rooms.
    const WorkMonitor beginning = part_of(monitor, 0, 0.12), refining = part_of(monitor, 0.12, 0.88),
                      sweeping = part_of(monitor, 0.88, 1);
    IndirectLight light(std::make_shared<const PatchMesh>(scene, start.mesh.arrays()),
                        around_vertices(start.mesh, indirect_irradiance(rough, emitted, options.gather, beginning)));
    const LightCarrier carrier(start, emitted, light,
                               {options.target_error / 2, options.max_elements / 2, options.gather, options.mark},
                               beginning);
    // Without a target: about as good as the mesh will be in the end, with twice the carrier's elements.
    const double target = options.target_error > 0 ? options.target_error : 1.5 * carrier.error();
    const QuadraticRadiosity leaving = carrier.leaving(light);
    const double goal = 0.4 * target * carrier.norm(leaving);
    const Probes probes = spread_probes(scene, start.mesh, 512, options.gather.seed);
    std::size_t rays = 0;
    int vertex_rays = std::max(options.rays, fewest_rays);
    if (options.rays == 0 && goal > 0) vertex_rays = rays_for(goal, carrier, leaving, probes, options, rays, beginning);
    // Few rays miss what is small and bright, and don't know it.
    if (options.rays == 0 && options.target_error == 0) vertex_rays = std::max(vertex_rays, 512);

    Gathered gathered(carrier,
                      {.rays = vertex_rays / 2, .directions = options.directions, .seed = options.gather.seed});
    // What quadratic elements miss is a third of what linear ones do, or less.
    const double enough = (options.target_error > 0 ? 3 : 2) * goal;
    light = refined_for(rough, carrier, gathered, std::move(light), enough, options, refining);
    light = swept(start, carrier, gathered, std::move(light), probes, sweeping);
    light.rays = rays + gathered.rays();
    light.vertex_rays = vertex_rays;
    return light;
}

}  // namespace patchlight
