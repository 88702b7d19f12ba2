#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

// Defined where it is compiled: FUZZ_TARGET(name) for each target.
#define FUZZ_TARGET(name) extern "C" int fuzz_##name(const std::uint8_t* data, std::size_t size);
FUZZ_TARGETS
#undef FUZZ_TARGET

namespace {

struct Target {
    const char* name;
    int (*run)(const std::uint8_t*, std::size_t);
};

#define FUZZ_TARGET(name) {#name, fuzz_##name},
constexpr Target targets[] = {FUZZ_TARGETS};
#undef FUZZ_TARGET

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// Whether the target takes the file, in `allowed` seconds at most.
bool holds(const Target& target, const std::filesystem::path& file, double allowed)
{
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    // A crash says no more than this line does.
    std::printf("%s: %s\n", target.name, file.filename().c_str());
    std::fflush(stdout);
    const auto start = std::chrono::steady_clock::now();
    try {
        target.run(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    } catch (const std::exception& error) {
        std::printf("  FAILED: %s\n", error.what());
        return false;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (seconds.count() > allowed) std::printf("  FAILED: took %.1f s\n", seconds.count());
    return seconds.count() <= allowed;
}

}  // namespace

/// Gives each target, or one, the files of CORPUS/TARGET: what fuzzing found once is not found again. Each has SECONDS.
int main(int argc, char** argv)
{
    if (argc < 2 || argc > 4) {
        std::fprintf(stderr, "usage: fuzz_replay CORPUS [TARGET [SECONDS = 5]]\n");
        return 2;
    }
    const double allowed = argc == 4 ? std::atof(argv[3]) : 5;
    int failures = 0;
    for (const Target& target : targets) {
        if (argc > 2 && std::string(argv[2]) != target.name) continue;
        const auto files = files_in(std::filesystem::path(argv[1]) / target.name);
        if (files.empty()) {
            std::printf("%s: FAILED: no files\n", target.name);
            ++failures;
        }
        for (const auto& file : files) failures += holds(target, file, allowed) ? 0 : 1;
    }
    return failures == 0 ? 0 : 1;
}
