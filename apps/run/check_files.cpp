#include "apps/run/check_files.h"

#include "apps/run/sha256.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

namespace patchlight {

namespace {

/// Files and the digests they are to have: the same twice only once, another for the same file beside it.
std::set<std::pair<std::string, std::string>> recorded(const RunRecord& record)
{
    std::set<std::pair<std::string, std::string>> files(record.files.begin(), record.files.end());
    for (const CycleRecord& cycle : record.cycles) {
        files.emplace(cycle_folder(cycle.cycle) + "/solution.glb", cycle.solution_sha256);
    }
    const bool ended = record.status == RunStatus::finished || record.status == RunStatus::not_converged;
    if (ended && !record.cycles.empty()) files.emplace("solution.glb", record.cycles.back().solution_sha256);
    return files;
}

/// What is wrong with a file; empty: nothing.
std::string cause(const std::filesystem::path& folder, const std::string& name, const std::string& sha256)
{
    const std::filesystem::path path(name);
    if (path.is_absolute() || std::ranges::find(path, "..") != path.end()) return "is outside the run's folder";
    std::error_code error;
    const auto status = std::filesystem::status(folder / path, error);
    if (!std::filesystem::exists(status)) return "is missing";
    if (!std::filesystem::is_regular_file(status)) return "is not a file";
    try {
        return sha256_hex(read_bytes(folder / path)) == sha256 ? "" : "is not what the run wrote: its SHA-256 differs";
    } catch (const std::exception& problem) {
        return std::string("can't be read: ") + problem.what();
    }
}

/// What two runs are to have alike beside their files.
Json lasting_record(const std::filesystem::path& folder)
{
    Json json = Json::parse(read_bytes(folder / "run.json"));
    json.erase("tool");
    json.erase("files");
    return json;
}

}  // namespace

std::vector<FileProblem> check_files(const OpenedRun& run)
{
    std::vector<FileProblem> problems;
    for (const auto& [name, sha256] : recorded(run.record)) {
        const std::string found = cause(run.folder, name, sha256);
        if (!found.empty() && (problems.empty() || problems.back().file != name)) problems.push_back({name, found});
    }
    return problems;
}

std::vector<FileProblem> differing_files(const OpenedRun& run, const OpenedRun& other)
{
    std::vector<FileProblem> differing;
    const auto &mine = run.record.files, &others = other.record.files;
    for (const auto& [name, sha256] : mine) {
        const auto found = others.find(name);
        if (found == others.end())
            differing.push_back({name, "is in the first alone"});
        else if (found->second != sha256)
            differing.push_back({name, "differs"});
    }
    for (const auto& [name, sha256] : others)
        if (!mine.contains(name)) differing.push_back({name, "is in the second alone"});
    if (lasting_record(run.folder) != lasting_record(other.folder)) differing.push_back({"run.json", "differs"});
    return differing;
}

}  // namespace patchlight
