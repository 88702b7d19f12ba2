#pragma once

#include "apps/run/file_writer.h"
#include "apps/run/folder_lock.h"
#include "apps/run/run_record.h"
#include "apps/run/stored_solution.h"

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace patchlight {

/// An output folder that isn't ours to write into (exit 2); what() says why and what to do.
class FolderRefused : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Where the files of a cycle are in the folder of its run.
std::string cycle_folder(int cycle);

enum class FolderState { fresh, unfinished, finished };

/// The folder of one run: knows what is in it, writes it, and keeps other programs out while it is open.
class RunFolder {
public:
    /// Looks at `folder` and makes it when it isn't there. Entries named in `also_ours` don't make it foreign.
    /// Throws FolderRefused when it holds anything but a run, a run of another scene or with other options, an
    /// unfinished run of a program with another numeric version, or when another program is writing it; OutputError
    /// when it can't be made or written.
    RunFolder(std::filesystem::path folder, RunIdentity identity, FileWriter& writer,
              const std::vector<std::string>& also_ours = {});
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;

    FolderState state() const { return state_; }
    const std::filesystem::path& path() const { return folder_; }
    /// run.json as it stands: of an unfinished run only the cycles that are whole on the disk.
    RunRecord record() const;
    Json timing() const { return timing_; }

    /// Where a cycle's files are.
    std::filesystem::path cycle_folder(int cycle) const { return folder_ / patchlight::cycle_folder(cycle); }

    /// Writes a file of the run, whose digest run.json will name. Throws OutputError, also when the folder has gone.
    void write(const std::string& name, std::string_view bytes);
    void write_in_cycle(int cycle, const std::string& name, std::string_view bytes);

    /// What was written there. Throws OutputError when it isn't there any more, or is something else.
    std::string read_in_cycle(int cycle, const std::string& name) const;

    /// The last step of a cycle: its record, run.json and timing.json. Until then the cycle isn't there.
    void finish_cycle(const CycleRecord& record, const Json& seconds);

    void set_warnings(std::vector<std::string> warnings);

    /// Writes run.json and timing.json with the run's end.
    void finish(RunStatus status, bool converged, const Json& machine);

    /// Marks run.json as interrupted; whatever is written afterwards keeps the mark. May be called from any thread.
    void interrupt() noexcept;

private:
    void take(const RunIdentity& identity, const std::vector<std::string>& also_ours);
    void keep_whole_cycles();
    void put(const std::string& name, std::string_view bytes);
    void write_record();

    std::filesystem::path folder_;
    FileWriter& writer_;
    mutable std::mutex mutex_;
    FolderLock lock_;
    RunRecord record_;
    Json timing_;
    FolderState state_ = FolderState::fresh;
    bool interrupted_ = false;
};

/// Deletes a finished or unfinished run's own files from its folder, and nothing else.
void clear_run(const std::filesystem::path& folder);

/// A stored run, to look at.
struct OpenedRun {
    std::filesystem::path folder;
    RunRecord record;
};

/// Throws FolderRefused when it isn't the folder of a run; SceneError ("run") when its run.json is broken.
OpenedRun open_run(const std::filesystem::path& folder);

/// Which cycle of a run: a number, or the first, or the last.
struct WhichCycle {
    enum class Kind { number, first, last } kind = Kind::last;
    int number = 0;
};

/// The solution of a cycle. Throws FolderRefused when there is no such cycle; SceneError when its file is broken.
StoredSolution solution_of(const OpenedRun& run, const WhichCycle& which);

/// The record of a cycle. Throws as solution_of.
const CycleRecord& record_of(const OpenedRun& run, const WhichCycle& which);

}  // namespace patchlight
