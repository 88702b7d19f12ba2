#include "solver/discontinuities.h"

#include "formfactor/direct_light.h"
#include "formfactor/shadow_lines.h"
#include "solver/secondary_sources.h"
#include "solver/system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace patchlight {

namespace {

/// From point to point across a line, of the scene's diameter: narrower penumbrae aren't told from edges.
constexpr double step = 1e-5;

/// Value, slope and second derivative at the line, seen from one side.
struct OneSided {
    Rgb value, slope, second;
};

/// The parabola through the values at h, 2h and 3h from the line, at the line.
OneSided extrapolate(const std::array<Rgb, 3>& f, double h)
{
    return {3.0 * f[0] - 3.0 * f[1] + f[2], (-2.5 * f[0] + 4.0 * f[1] - 1.5 * f[2]) / h,
            (f[0] - 2.0 * f[1] + f[2]) / (h * h)};
}

class JumpMeter {
public:
    JumpMeter(const Scene& scene, const DirectLight& direct, std::span<const Rgb> exitance)
        : scene_(scene), direct_(direct), exitance_(exitance)
    {}

    Discontinuity measure(const SurfaceLine& line, DirectLight::Scratch& scratch) const
    {
        Discontinuity found{line};
        const Vec2 way = line.end - line.start;
        const double h = std::min(step * scene_.diameter, 0.05 * glm::length(way));
        const Vec2 across = h * glm::normalize(Vec2(-way.y, way.x));
        for (const double t : {0.5, 0.25, 0.75}) {
            if (found.value > 0 || found.slope > 0) break;
            const Vec2 q = line.start + t * way;
            const OneSided left = side(line.surface, q, across, h, scratch);
            const OneSided right = side(line.surface, q, -across, h, scratch);
            // What rounding makes of equal sides counts for nothing.
            const double size = glm::length(left.value) + glm::length(right.value);
            const auto jump = [&](const Rgb& a, const Rgb& b, double rounding) {
                const double d = glm::length(a - b);
                return d > rounding * size ? d : 0.0;
            };
            found.value = std::max(found.value, jump(left.value, right.value, 1e-9));
            found.slope = std::max(found.slope, jump(left.slope, -right.slope, 1e-11 / h));
            found.second = std::max(found.second, jump(left.second, right.second, 1e-11 / (h * h)));
        }
        return found;
    }

private:
    OneSided side(SurfaceId surface, const Vec2& q, const Vec2& away, double h, DirectLight::Scratch& scratch) const
    {
        std::array<Rgb, 3> f;
        for (std::size_t k = 0; k < 3; ++k) f[k] = light(surface, q + static_cast<double>(k + 1) * away, scratch);
        return extrapolate(f, h);
    }

    Rgb light(SurfaceId surface, const Vec2& q, DirectLight::Scratch& scratch) const
    {
        std::vector<double> factors(direct_.source_count());
        direct_.factors(scene_.surface(surface).frame.lift(q), surface, factors, scratch);
        Rgb H(0.0);
        for (std::size_t k = 0; k < factors.size(); ++k) H += factors[k] * exitance_[k];
        return scene_.material_of(surface).reflectance * H;
    }

    const Scene& scene_;
    const DirectLight& direct_;
    std::span<const Rgb> exitance_;
};

/// Whether a line's middle is on an edge, of the mesh or the border: there it can't be told from it.
bool is_on(const SurfaceLine& line, const Vec2& a, const Vec2& b, double diameter)
{
    const Vec2 middle = 0.5 * (line.start + line.end);
    const double t = std::clamp(glm::dot(middle - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(middle, a + t * (b - a)) < 2e-5 * diameter;
}

bool is_in_mesh(const Scene& scene, const PatchMesh& mesh, const SurfaceLine& line)
{
    return std::ranges::any_of(mesh.lines_of(line.surface), [&](const MeshLine& edge) {
        return is_on(line, mesh.plane_position(VertexId(edge.left[0])), mesh.plane_position(VertexId(edge.left[1])),
                     scene.diameter);
    });
}

bool is_on_border(const Scene& scene, const SurfaceLine& line)
{
    const Surface& surface = scene.surface(line.surface);
    return std::ranges::any_of(surface.loops, [&](const auto& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (is_on(line, surface.frame.to_plane(scene.vertices[loop[i]]),
                      surface.frame.to_plane(scene.vertices[loop[(i + 1) % loop.size()]]), scene.diameter))
                return true;
        return false;
    });
}

std::vector<Discontinuity> measure_all(const Scene& scene, const DirectLight& direct, std::span<const Rgb> exitance,
                                       std::span<const SurfaceLine> lines, const WorkMonitor& monitor)
{
    const JumpMeter meter(scene, direct, exitance);
    std::vector<Discontinuity> found(lines.size());
    tbb::enumerable_thread_specific<DirectLight::Scratch> scratches;
    tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t i) {
        if (!monitor.stop.stop_requested()) found[i] = meter.measure(lines[i], scratches.local());
    });
    if (monitor.stop.stop_requested()) throw Interrupted();
    return found;
}

}  // namespace

std::vector<Discontinuity> discontinuities(const Scene& scene, const DirectLight* direct, const LineOptions& options,
                                           const WorkMonitor& monitor)
{
    std::vector<SurfaceLine> contacts;
    for (const SurfaceLine& line : scene.contact_lines)
        if (scene.material_of(line.surface).reflects()) contacts.push_back(line);
    if (!direct) {
        std::vector<Discontinuity> found;
        for (const SurfaceLine& line : contacts) found.push_back({line});
        return found;
    }
    std::vector<Rgb> exitance;
    for (const SurfaceId s : emitters(scene)) exitance.push_back(scene.material_of(s).emission);
    std::vector<Discontinuity> found = measure_all(scene, *direct, exitance, contacts, monitor);
    const auto add_shadows = [&](std::span<const SurfaceId> sources, const DirectLight& light) {
        const std::vector<SurfaceLine> cast = shadow_lines(scene, sources, {.blockers = false}, nullptr, monitor);
        const auto shadows = measure_jumps(scene, light, exitance, cast, monitor);
        found.insert(found.end(), shadows.begin(), shadows.end());
    };
    add_shadows(emitters(scene), *direct);
    std::vector<SurfaceId> secondary;
    exitance.clear();
    for (const SecondarySource& source :
         secondary_sources(scene, *direct, options.secondary_share, options.most_secondary)) {
        secondary.push_back(source.surface);
        exitance.push_back(source.exitance);
    }
    if (!secondary.empty()) add_shadows(secondary, DirectLight(scene, secondary, monitor));
    return found;
}

std::vector<Discontinuity> measure_jumps(const Scene& scene, const DirectLight& direct, std::span<const Rgb> exitance,
                                         std::span<const SurfaceLine> lines, const WorkMonitor& monitor)
{
    std::vector<Discontinuity> found = measure_all(scene, direct, exitance, lines, monitor);
    std::erase_if(found, [&](const Discontinuity& d) {
        return (d.value == 0 && d.slope == 0 && d.second == 0) || is_on_border(scene, d.line);
    });
    return found;
}

double elements_saved(const Discontinuity& line, double element_error)
{
    const double length = glm::distance(line.line.start, line.line.end);
    const auto size = [&](double jump, double constant, int k) {
        return jump > 0 ? std::pow(constant * element_error / (jump * jump), 0.5 / (k + 1)) : 1e300;
    };
    const double h = std::min({size(line.value, 12, 0), size(line.slope, 48, 1), size(line.second, 600, 2)});
    return 2 * length / h;
}

std::vector<SurfaceLine> worthwhile_lines(const Scene& scene, const PatchMesh& mesh, const ErrorEstimate& error,
                                          std::span<const Discontinuity> lines, std::size_t max_elements,
                                          double target_error, const LineOptions& options)
{
    const double n = static_cast<double>(mesh.patch_count());
    const double N = max_elements > 0 ? std::max(n, static_cast<double>(max_elements)) : n;
    const double norm = error.relative > 0 ? error.total / error.relative : 0;
    const double final_error = std::max(error.total * n / N, target_error * norm);
    const double element_error = final_error * final_error / N;
    std::vector<std::pair<double, const SurfaceLine*>> paying;
    for (const Discontinuity& line : lines) {
        const double saved = element_error > 0 ? elements_saved(line, element_error) : 0;
        const bool first = line.line.kind == LineKind::contact;
        if ((first || saved >= options.least_saving) && !is_in_mesh(scene, mesh, line.line))
            paying.emplace_back(first ? 1e300 : saved, &line.line);
    }
    std::ranges::stable_sort(paying, [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<SurfaceLine> result;
    for (const auto& [saved, line] : paying) result.push_back(*line);
    return result;
}

std::array<LineCount, line_kinds.size()> count_lines(const Scene& scene, const PatchMesh& mesh,
                                                     std::span<const Discontinuity> lines)
{
    std::array<LineCount, line_kinds.size()> counts{};
    for (const Discontinuity& line : lines) {
        LineCount& count = counts[static_cast<std::size_t>(line.line.kind)];
        ++count.found;
        if (is_in_mesh(scene, mesh, line.line)) ++count.inserted;
    }
    return counts;
}

}  // namespace patchlight
