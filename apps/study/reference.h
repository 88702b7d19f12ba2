#pragma once

#include "apps/run/file_writer.h"
#include "apps/run/probing.h"
#include "apps/run/run_options.h"
#include "apps/run/stored_solution.h"
#include "apps/study/study.h"
#include "apps/study/study_folder.h"
#include "apps/verification/surface_sampler.h"
#include "formfactor/ray_caster.h"

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace patchlight {

/// A point of a surface and the light there that solutions are held to.
struct ReferencePoint {
    DrawnPoint at;
    Rgb reflected{0.0};  ///< B − E, W/m²
    Rgb variance{0.0};   ///< of `reflected`, (W/m²)²; 0 where it isn't sampled
};

/// The digest of all that light depends on: views left out.
std::string lit_digest(const Scene& scene);

/// What a reference depends on, all in all: references of the same key are the same. `source` names what it is taken
/// from: the solution's run, the file's SHA-256; null for what is computed from the scene alone.
Json reference_key(const StudyReference& reference, const Scene& scene, std::uint64_t seed, const Json& source);

/// The first 16 hexadecimal digits of a key's SHA-256: what folders are called.
std::string content_id(const Json& key);

/// Seeds of a study's reference, none of which a solve with the study's seed uses.
struct ReferenceSeeds {
    std::uint64_t points = 0, paths = 0, intervals = 0;
};
ReferenceSeeds reference_seeds(std::uint64_t study_seed);

/// The points where a reference is known that isn't given by points: area-uniform over all reflecting surface.
std::vector<DrawnPoint> reference_points(const Scene& scene, const StudyReference& reference, std::uint64_t seed);

/// Where a path-traced reference puts what it has.
struct PartialReference {
    std::filesystem::path folder;  ///< of the points that are done, in blocks
    FileWriter& writer;
    std::stop_token stop;
    std::function<void(double fraction, std::size_t rays)> tell;
};

/// Path traces `reference.paths` paths (rounded up to a multiple of 8) from each of the points: blocks of points, each
/// stored when it is done and not traced again; the same values whatever the interruptions and threads. Throws
/// Interrupted, OutputError.
std::vector<ReferencePoint> traced_reference(const Scene& scene, const RayCaster& caster,
                                             const std::vector<DrawnPoint>& points, std::uint32_t paths,
                                             std::uint64_t seed, const PartialReference& partial);

/// What a solution shows at the points.
std::vector<ReferencePoint> shown_reference(const StoredSolution& solution, const std::vector<DrawnPoint>& points);

/// B − E = E ρ/(1 − ρ) everywhere. Throws StudyError when the scene isn't closed, or surfaces differ in emission or
/// reflectance.
std::vector<ReferencePoint> furnace_reference(const Scene& scene, const std::vector<DrawnPoint>& points,
                                              const std::string& where);

/// Points of a file with their radiosity. Throws PointsError for a point without radiosity or on no surface.
std::vector<ReferencePoint> given_reference(const Scene& scene, const std::vector<ProbePoint>& points,
                                            const std::string& name);

/// The last file of a reference: with it, it is done. Throws OutputError.
void write_reference(const std::filesystem::path& folder, const Json& key, const std::vector<ReferencePoint>& points,
                     FileWriter& writer);

/// Its points; nothing where it isn't done. Throws SceneError ("reference") for a broken file.
std::optional<std::vector<ReferencePoint>> read_reference(const std::filesystem::path& folder);

}  // namespace patchlight
