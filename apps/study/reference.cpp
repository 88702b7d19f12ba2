#include "apps/study/reference.h"

#include "apps/run/run_record.h"
#include "apps/run/sha256.h"
#include "apps/run/stored_scene.h"
#include "apps/study/reference_file.h"
#include "apps/study/shown_points.h"
#include "apps/verification/found_light.h"
#include "formfactor/random_numbers.h"
#include "meshing/refinement.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {

namespace {

/// Some tenths of a second of work: what an interruption costs.
constexpr std::size_t points_of_block = 64;

/// A solution that shows nothing, to find surfaces with.
StoredSolution dark_solution(const Scene& scene)
{
    StoredSolution dark;
    dark.scene = scene;
    dark.mesh = triangulate(scene, {});
    dark.B = Radiosity(dark.mesh.patch_count(), Rgb(0.0));
    dark.vertex_B = VertexRadiosity(dark.mesh.vertex_count(), Rgb(0.0));
    return dark;
}

}  // namespace

std::string lit_digest(const Scene& scene)
{
    Scene lit = scene;
    lit.views.clear();
    return scene_digest(lit);
}

Json reference_key(const StudyReference& reference, const Scene& scene, std::uint64_t seed, const Json& source)
{
    const bool drawn = reference.kind != ReferenceKind::points;
    return {{"format", 1},
            {"kind", name_of(reference.kind)},
            {"scene", lit_digest(scene)},
            {"points", drawn ? Json(reference.points) : Json()},
            {"paths", reference.kind == ReferenceKind::path_traced ? Json(reference.paths) : Json()},
            {"seed", seed},
            {"source", source},
            {"numeric", numeric_version()}};
}

std::string content_id(const Json& key)
{
    return sha256_hex(key.dump()).substr(0, 16);
}

ReferenceSeeds reference_seeds(std::uint64_t study_seed)
{
    // Solves and `verify` take a seed's first purposes.
    constexpr std::uint64_t own = 0x7265666572656e63ULL;
    RandomNumbers random(study_seed, own);
    return {random.bits(), random.bits(), random.bits()};
}

std::vector<DrawnPoint> reference_points(const Scene& scene, const StudyReference& reference, std::uint64_t seed)
{
    return draw_points(reflecting_surface(scene), reference.points, reference_seeds(seed).points);
}

std::vector<ReferencePoint> traced_reference(const Scene& scene, const RayCaster& caster,
                                             const std::vector<DrawnPoint>& points, std::uint32_t paths,
                                             std::uint64_t seed, const PartialReference& partial)
{
    const PathTracer tracer(scene, caster, reference_seeds(seed).paths);
    const std::uint32_t of_stream = std::max(1U, (paths + path_streams - 1) / path_streams);
    std::vector<PathSums> sums(points.size());
    for (PathSums& of_point : sums) of_point.fill(Rgb(0.0));
    std::vector<ReferencePoint> found;
    std::size_t rays = 0;
    FileWriter::make_folder(partial.folder);
    FileWriter::sweep(partial.folder);
    for (std::size_t first = 0; first < points.size(); first += points_of_block) {
        const std::size_t count = std::min(points_of_block, points.size() - first);
        const std::filesystem::path file = partial.folder / fmt::format("{:05}.json", first / points_of_block);
        std::vector<ReferencePoint> block = read_block(file);
        if (block.size() != count) {
            rays += add_paths(tracer, points, {first, count, 0, of_stream}, {partial.stop, {}}, sums);
            block.clear();
            for (std::size_t i = first; i < first + count; ++i) {
                const FoundLight light = found_by(sums[i], of_stream);
                block.push_back({points[i], light.mean, light.variance});
            }
            write_block(file, block, partial.writer);
        }
        found.insert(found.end(), block.begin(), block.end());
        if (partial.tell) partial.tell(static_cast<double>(found.size()) / static_cast<double>(points.size()), rays);
    }
    return found;
}

std::vector<ReferencePoint> shown_reference(const StoredSolution& solution, const std::vector<DrawnPoint>& points)
{
    const std::vector<ShownPoint> shown = shown_at(solution, points);
    std::vector<ReferencePoint> found(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) found[i] = {points[i], shown[i].reflected, Rgb(0.0)};
    return found;
}

std::vector<ReferencePoint> furnace_reference(const Scene& scene, const std::vector<DrawnPoint>& points,
                                              const std::string& where)
{
    const auto refuse = [&](const std::string& cause) {
        throw StudyError(fmt::format("{}: the furnace's closed form is for a closed room that emits and reflects "
                                     "alike all over; {} {}",
                                     where, scene.name, cause));
    };
    if (!scene.closed) refuse("isn't closed");
    const Material& first = scene.material_of(SurfaceId(std::size_t{0}));
    for (const Surface& surface : scene.surfaces) {
        const Material& material = scene.materials[surface.material.value];
        if (material.emission != first.emission || material.reflectance != first.reflectance) {
            refuse(fmt::format("has materials {} and {}", first.name, material.name));
        }
    }
    const Rgb reflected = first.emission * first.reflectance / (Rgb(1.0) - first.reflectance);
    std::vector<ReferencePoint> found;
    for (const DrawnPoint& point : points) found.push_back({point, reflected, Rgb(0.0)});
    return found;
}

std::vector<ReferencePoint> given_reference(const Scene& scene, const std::vector<ProbePoint>& points,
                                            const std::string& name)
{
    const StoredSolution dark = dark_solution(scene);
    const auto answers = SurfaceProbe(dark).at(points);
    std::vector<ReferencePoint> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [x, y, z] = points[i].as_written;
        if (!points[i].B) {
            throw PointsError(fmt::format("{}: {},{},{} has no radiosity in columns Br,Bg,Bb", name, x, y, z));
        }
        if (!answers[i]) {
            throw PointsError(fmt::format("{}: {},{},{} is on no surface of {}", name, x, y, z, scene.name));
        }
        const SurfaceId surface = answers[i]->surface;
        found.push_back({{surface, points[i].position * scene.unit - scene.center},
                         *points[i].B - scene.material_of(surface).emission,
                         Rgb(0.0)});
    }
    return found;
}

}  // namespace patchlight
