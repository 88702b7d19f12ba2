#include "apps/run/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <unistd.h>

namespace patchlight {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double most = 16.0 * 1024 * 1024 * 1024;

/// "max", or nothing, is no limit.
double limit_in(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    double bytes = 0;
    return stream >> bytes && bytes > 0 ? bytes : unlimited;
}

/// A container may see its group as the root: what isn't there is skipped.
double least_above(const std::filesystem::path& root, const std::filesystem::path& group, const char* file)
{
    double least = limit_in(root / file);
    std::filesystem::path folder = root;
    for (const std::filesystem::path& name : group.relative_path()) {
        folder /= name;
        least = std::min(least, limit_in(folder / file));
    }
    return least;
}

}  // namespace

double group_memory(const std::string& groups, const std::filesystem::path& root)
{
    double least = unlimited;
    std::istringstream lines(groups);
    for (std::string line; std::getline(lines, line);) {
        // number:controllers:path
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
        const std::filesystem::path group = line.substr(second + 1);
        if (controllers == ",,")
            least = std::min(
                {least, least_above(root, group, "memory.max"), least_above(root / "unified", group, "memory.max")});
        else if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, least_above(root / "memory", group, "memory.limit_in_bytes"));
    }
    return least;
}

double default_memory()
{
    const double machine =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
    std::ifstream file("/proc/self/cgroup");
    std::ostringstream groups;
    groups << file.rdbuf();
    return std::min(most, 0.8 * std::min(machine, group_memory(groups.str(), "/sys/fs/cgroup")));
}

}  // namespace patchlight
