#pragma once

#include <filesystem>
#include <string>

namespace patchlight {

/// The most that no --memory allows, bytes: 80 % of the machine's memory or of what its control group may have, if that
/// is less, and 16 GiB at most.
double default_memory();

/// The least that a process's control groups of memory and those above them may have, bytes, of either version;
/// infinite where nothing is limited or can be read. `groups`: what /proc/self/cgroup says; `root`: /sys/fs/cgroup.
double group_memory(const std::string& groups, const std::filesystem::path& root);

}  // namespace patchlight
