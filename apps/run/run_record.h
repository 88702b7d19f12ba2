#pragma once

#include "apps/run/run_options.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace patchlight {

/// One cycle as run.json and cycles/NN/record.json hold it: nothing in it depends on clock or machine.
struct CycleRecord {
    int cycle = 0;
    Stage stage = Stage::rough;
    std::size_t elements = 0;
    std::size_t vertices = 0;
    std::size_t rays = 0;
    double estimated_error = 0;  ///< relative
    double error_total = 0;      ///< W/m²·m
    double unshot = 0;
    Solver solver = Solver::gauss_seidel;
    std::size_t solver_iterations = 0;
    double solver_residual = 0;
    std::size_t links = 0;  ///< of the hierarchical solver
    bool solver_converged = false;
    std::vector<double> solver_history;                ///< residuals on the way, as SolveReport has them
    std::size_t splits = 0;                            ///< edges that the plan halves next, and lines that it inserts
    std::array<LineCount, line_kinds.size()> lines{};  ///< by kind
    EnergyBalance energy;
    double exposure = 0;          ///< stops, of the cycle's picture
    std::string solution_sha256;  ///< of the cycle's solution.glb
};

CycleRecord record_of(const AdaptiveStep& step);
Json json_of(const CycleRecord& record);
/// Throws SceneError ("run") when something is missing or of another type.
CycleRecord cycle_record_in(const Json& json);

/// What tells one run from another: the scene as it was read, and all options.
struct RunIdentity {
    std::string scene_file;      ///< name without folders
    std::string scene_sha256;    ///< of the file
    std::string content_sha256;  ///< of the scene that was read from it and from the files it names
    std::size_t surfaces = 0;
    double area = 0;  ///< m²
    bool closed = false;
    Json options;
    std::uint64_t seed = 1;
};

enum class RunStatus { running, interrupted, not_converged, finished };

std::string name_of(RunStatus status);

/// Everything in run.json.
struct RunRecord {
    RunIdentity identity;
    std::vector<std::string> warnings;
    std::vector<CycleRecord> cycles;
    /// SHA-256 of each file by its path in the folder, but not of run.json, of timing.json, which differs from machine
    /// to machine, and of stored factors, which hold their own.
    std::map<std::string, std::string> files;
    RunStatus status = RunStatus::running;
    bool converged = false;
};

/// The version and commit that built this program.
std::string tool_version();
std::string tool_commit();

/// Tells programs apart that may compute other numbers: 16 hexadecimal digits of the SHA-256 of the sources of meshing,
/// formfactor, solver and apps/run. Another commit that leaves these alone has the same. Compiler, flags and libraries
/// are not in it.
std::string numeric_version();

Json json_of(const RunRecord& record);

/// A run.json read back: the record, and who wrote it. Throws SceneError ("run").
struct StoredRecord {
    RunRecord record;
    std::string version, commit;
    std::string numeric;  ///< empty: of a program that wrote none
};
StoredRecord run_record_in(const std::string& text);

/// Whether two runs are of the same scene with the same options.
bool same_run(const RunIdentity& a, const RunIdentity& b);

}  // namespace patchlight
