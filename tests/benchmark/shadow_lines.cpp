// Lines found on scenes: how many, in what time, with what memory, and how that grows.
//   shadow_lines SCENE...      one line of the table a scene; all emitters are sources

#include "formfactor/shadow_lines.h"
#include "meshing/read_scene.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

namespace patchlight {
namespace {

/// All threads'.
double cpu_seconds()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void measure(const char* file)
{
    const Scene scene = read_scene(file).scene;
    std::vector<SurfaceId> sources;
    std::size_t edges = 0;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        if (scene.material_of(SurfaceId(s)).emits()) sources.push_back(SurfaceId(s));
        for (const auto& loop : scene.surfaces[s].loops) edges += loop.size();
    }
    ShadowLineCounts counts;
    const double cpu_before = cpu_seconds();
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<SurfaceLine> lines = shadow_lines(scene, sources, {}, &counts);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double cpu = cpu_seconds() - cpu_before;
    std::array<std::size_t, line_kinds.size()> by_kind{};
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    for (const SurfaceLine& l : lines) ++by_kind[static_cast<std::size_t>(l.kind)];
    std::printf("%-24s %8zu %8zu %7zu %10zu %10zu %8zu", std::filesystem::path(file).filename().c_str(),
                scene.surfaces.size(), edges, sources.size(), counts.pencils, counts.receivers, lines.size());
    for (const LineKind kind : {LineKind::ev, LineKind::ve, LineKind::eee, LineKind::plane})
        std::printf(" %7zu", by_kind[static_cast<std::size_t>(kind)]);
    std::printf(" %8.2f %8.2f %8ld %9.3f %9.3f\n", seconds, cpu, usage.ru_maxrss / 1024,
                1e6 * cpu / static_cast<double>(std::max<std::size_t>(1, counts.pencils)),
                1e6 * cpu / static_cast<double>(std::max<std::size_t>(1, counts.receivers)));
}

}  // namespace
}  // namespace patchlight

int main(int argc, char** argv)
{
    std::printf("%-24s %8s %8s %7s %10s %10s %8s %7s %7s %7s %7s %8s %8s %8s %9s %9s\n", "scene", "surfaces", "edges",
                "sources", "pencils", "receivers", "lines", "EV", "VE", "EEE", "plane", "seconds", "cpu", "MiB",
                "us/pencil", "us/recv");
    for (int k = 1; k < argc; ++k) patchlight::measure(argv[k]);
    return 0;
}
