#include "apps/run/run_folder.h"

#include "apps/run/sha256.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace patchlight {

namespace {

std::string text_of(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

constexpr std::size_t deepest_json = 64;

/// A file of JSON; throws std::exception. Deeper nesting than any of ours would overflow the stack where it is written.
Json json_in(const std::filesystem::path& file)
{
    const std::string text = read_bytes(file);
    if (json_depth(text) > deepest_json) {
        throw std::runtime_error("is nested too deeply");
    }
    return Json::parse(text);
}

/// A timing.json as we write it, or nothing: only seconds are lost.
Json timing_in(const std::filesystem::path& file)
{
    try {
        Json timing = json_in(file);
        return timing.is_object() ? timing : Json();
    } catch (const std::exception&) {
        return Json();
    }
}

/// The seconds of the cycles before this one that timing.json holds.
Json seconds_before(int cycle, const Json& timing)
{
    Json kept = Json::array();
    if (!timing.is_object() || !timing.contains("cycles") || !timing["cycles"].is_array()) {
        return kept;
    }
    for (const Json& old : timing["cycles"]) {
        const auto number = old.is_object() ? old.find("cycle") : old.end();
        if (number != old.end() && number->is_number_integer() && number->get<std::int64_t>() < cycle) {
            kept.push_back(old);
        }
    }
    return kept;
}

/// Anything in the folder that isn't named, and isn't a temporary of ours?
bool holds_others(const std::filesystem::path& folder, const std::vector<std::string>& named)
{
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (std::find(named.begin(), named.end(), entry.path().filename().string()) == named.end()) {
            return true;
        }
    }
    return false;
}

/// Makes the folder when it isn't there.
const std::filesystem::path& made(const std::filesystem::path& folder)
{
    std::error_code error;
    const auto status = std::filesystem::status(folder, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
        throw FolderRefused(fmt::format("{} is a file; name a new folder", folder.string()));
    }
    FileWriter::make_folder(folder);
    return folder;
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path folder, RunIdentity identity, FileWriter& writer,
                     const std::vector<std::string>& also_ours)
    : folder_(std::move(folder)), writer_(writer), lock_(made(folder_))
{
    FileWriter::sweep(folder_);
    take(identity, also_ours);
    record_.identity = std::move(identity);
    if (state_ == FolderState::unfinished) {
        keep_whole_cycles();
    }
    if (state_ != FolderState::finished) {
        record_.status = RunStatus::running;
        record_.converged = false;
        write_record();
    }
}

void RunFolder::take(const RunIdentity& identity, const std::vector<std::string>& also_ours)
{
    if (!std::filesystem::exists(folder_ / "run.json")) {
        if (holds_others(folder_, also_ours)) {
            throw FolderRefused(fmt::format("{} is not empty and holds no run; name a new folder", folder_.string()));
        }
        return;
    }
    StoredRecord stored;
    try {
        stored = run_record_in(read_bytes(folder_ / "run.json"));
    } catch (const std::runtime_error& problem) {
        throw FolderRefused(
            fmt::format("{}: run.json can't be read ({}); name a new folder", folder_.string(), problem.what()));
    }
    if (!same_run(stored.record.identity, identity)) {
        const bool options = stored.record.identity.options != identity.options;
        throw FolderRefused(
            fmt::format("{} holds a run {}; name a new folder", folder_.string(),
                        options ? "with other options" : "of another scene, or of an earlier state of this one"));
    }
    const bool finished =
        stored.record.status == RunStatus::finished || stored.record.status == RunStatus::not_converged;
    if (!finished && stored.numeric != numeric_version()) {
        throw FolderRefused(
            fmt::format("{} holds an unfinished run of patchlight {} ({}), and this one, {} ({}), may compute other "
                        "numbers; name a new folder",
                        folder_.string(), stored.version, stored.commit, tool_version(), tool_commit()));
    }
    state_ = finished ? FolderState::finished : FolderState::unfinished;
    record_ = std::move(stored.record);
    timing_ = timing_in(folder_ / "timing.json");
}

/// A killed program may have left a cycle half written, and run.json a cycle behind: the records on the disk count.
void RunFolder::keep_whole_cycles()
{
    record_.cycles.clear();
    record_.files.clear();
    for (int cycle = 0;; ++cycle) {
        const std::filesystem::path folder = cycle_folder(cycle);
        FileWriter::sweep(folder);
        try {
            const CycleRecord record = cycle_record_in(json_in(folder / "record.json"));
            if (record.cycle != cycle || sha256_hex(read_bytes(folder / "solution.glb")) != record.solution_sha256) {
                return;
            }
            record_.cycles.push_back(record);
            for (const char* name : {"record.json", "solution.glb", "picture.png"}) {
                if (std::filesystem::exists(folder / name)) {
                    record_.files[patchlight::cycle_folder(cycle) + '/' + name] = sha256_hex(read_bytes(folder / name));
                }
            }
        } catch (const std::exception&) {
            return;
        }
    }
}

RunRecord RunFolder::record() const
{
    const std::lock_guard lock(mutex_);
    return record_;
}

std::string cycle_folder(int cycle)
{
    return fmt::format("cycles/{:02}", cycle);
}

/// Into this folder and no other that stands in its place by now.
void RunFolder::put(const std::string& name, std::string_view bytes)
{
    lock_.check(folder_);
    writer_.write(folder_ / name, bytes);
}

void RunFolder::write(const std::string& name, std::string_view bytes)
{
    put(name, bytes);
    const std::string digest = sha256_hex(bytes);
    const std::lock_guard lock(mutex_);
    record_.files[name] = digest;
}

void RunFolder::write_in_cycle(int cycle, const std::string& name, std::string_view bytes)
{
    lock_.check(folder_);
    FileWriter::make_folder(cycle_folder(cycle));
    write(patchlight::cycle_folder(cycle) + '/' + name, bytes);
}

std::string RunFolder::read_in_cycle(int cycle, const std::string& name) const
{
    const std::string file = patchlight::cycle_folder(cycle) + '/' + name;
    std::string bytes;
    try {
        bytes = read_bytes(folder_ / file);
    } catch (const std::runtime_error& gone) {
        throw OutputError(fmt::format("{}; this run wrote it", gone.what()));
    }
    const std::lock_guard lock(mutex_);
    const auto written = record_.files.find(file);
    if (written == record_.files.end() || written->second != sha256_hex(bytes)) {
        throw OutputError(fmt::format("{}: was changed while the run was going on", (folder_ / file).string()));
    }
    return bytes;
}

void RunFolder::finish_cycle(const CycleRecord& record, const Json& seconds)
{
    write_in_cycle(record.cycle, "record.json", text_of(json_of(record)));
    const std::lock_guard lock(mutex_);
    record_.cycles.push_back(record);
    write_record();
    Json kept = seconds_before(record.cycle, timing_);
    kept.push_back(seconds);
    timing_["cycles"] = kept;
    put("timing.json", text_of(timing_));
}

void RunFolder::set_warnings(std::vector<std::string> warnings)
{
    const std::lock_guard lock(mutex_);
    for (std::string& warning : warnings) {
        warning = as_utf8(warning);
    }
    record_.warnings = std::move(warnings);
}

void RunFolder::finish(RunStatus status, bool converged, const Json& machine)
{
    const std::lock_guard lock(mutex_);
    record_.status = status;
    record_.converged = converged;
    if (status == RunStatus::interrupted) {
        std::error_code error;
        const int unfinished = static_cast<int>(record_.cycles.size());
        std::filesystem::remove_all(cycle_folder(unfinished), error);
        std::erase_if(record_.files, [&](const auto& file) {
            return file.first.starts_with(patchlight::cycle_folder(unfinished) + '/');
        });
    }
    timing_.update(machine);
    put("timing.json", text_of(timing_));
    write_record();
    if (status == RunStatus::finished || status == RunStatus::not_converged) {
        state_ = FolderState::finished;
    }
}

void RunFolder::interrupt() noexcept
{
    const std::lock_guard lock(mutex_);
    if (state_ == FolderState::finished) {
        return;
    }
    interrupted_ = true;
    try {
        write_record();
    } catch (const std::exception&) {
        // On the way out: without the mark the run still counts as unfinished.
    }
}

/// With the mutex held, or before anybody else knows the folder.
void RunFolder::write_record()
{
    RunRecord shown = record_;
    if (interrupted_ && shown.status == RunStatus::running) {
        shown.status = RunStatus::interrupted;
    }
    put("run.json", text_of(json_of(shown)));
}

}  // namespace patchlight
