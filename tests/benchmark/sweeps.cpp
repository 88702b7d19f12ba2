// How near sweeps over the rows come to the machine's read bandwidth: bytes of columns and factors a second (12 B an
// entry, once for all three bands) beside a plain sum over memory, in turn in one run, the best of several. On cores
// that are shared, `nice -n -15` gives it both of them. Usage: sweeps [patches of the full matrix] [patches of the
// sparse one] [entries a row there] [rounds]
#include "formfactor/random_numbers.h"
#include "solver/solve.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <numeric>
#include <string>
#include <tbb/parallel_for.h>
#include <thread>
#include <vector>

namespace patchlight {
namespace {

double seconds_of(const std::function<void()>& work)
{
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Reads all of it once on all threads, in eight sums a thread, as fast as it will go.
double sum_of(const std::vector<double>& memory)
{
    constexpr std::size_t chunk = 1 << 16;
    std::vector<double> sums((memory.size() + chunk - 1) / chunk);
    tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t c) {
        double lanes[8] = {};
        const std::size_t end = std::min(memory.size(), (c + 1) * chunk);
        for (std::size_t i = c * chunk; i + 8 <= end; i += 8)
            for (std::size_t k = 0; k < 8; ++k) lanes[k] += memory[i + k];
        sums[c] = std::accumulate(lanes, lanes + 8, 0.0);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// n rows of `entries` factors at ascending columns: all, or random ones.
RadiositySystem system_of(std::size_t n, std::size_t entries)
{
    RadiositySystem system;
    system.area = PatchField<double>(n, 1.0);
    system.rho = PatchField<Rgb>(n, Rgb(.5, .6, .7));
    system.E = PatchField<Rgb>(n, Rgb(1, 2, 3));
    FormFactorMatrix& F = system.F;
    F.row_start.resize(n + 1);
    for (std::size_t i = 0; i <= n; ++i) F.row_start[i] = i * entries;
    F.columns.resize(n * entries);
    F.factors.assign(n * entries, 1.0 / static_cast<double>(entries));
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
        RandomNumbers random(1, i);
        for (std::size_t k = 0; k < entries; ++k)
            F.columns[i * entries + k] =
                entries == n ? static_cast<std::uint32_t>(k) : random.below(static_cast<std::uint32_t>(n));
    });
    return system;
}

void sweeps_over(const char* name, std::size_t n, std::size_t entries, int rounds)
{
    const RadiositySystem system = system_of(n, entries);
    const double bytes = 12.0 * static_cast<double>(n * entries);
    // As many bytes: as long a time, and the same share of it in the caches.
    const std::vector<double> memory(n * entries / 2 * 3, 1.0);
    Radiosity B = system.E, H(n);
    struct Timed {
        const char* name;
        std::function<void()> work;
        double bytes, best = 1e300;
    };
    const auto sweep = [&](Solver solver) {
        return [&, solver] {
            B = system.E;
            solve(system, B, {.solver = solver, .tolerance = 1e-15, .max_sweeps = 1});
        };
    };
    const LightOperator F = rows_of(system.F);
    std::vector<Timed> all{{"plain sum", [&] { std::printf(sum_of(memory) < 0 ? "!" : ""); }, bytes},
                           {"product (conjugate gradients, BiCGStab)", [&] { F(B, H); }, bytes},
                           {"Jacobi sweep", sweep(Solver::jacobi), bytes},
                           {"Gauss-Seidel sweep", sweep(Solver::gauss_seidel), bytes}};
    for (int round = 0; round < rounds; ++round)
        for (Timed& one : all) one.best = std::min(one.best, seconds_of(one.work));
    std::printf("%s: %zu rows of %zu factors, %.2f GB, %u threads\n", name, n, entries, bytes / 1e9,
                std::thread::hardware_concurrency());
    const double plain = all.front().bytes / all.front().best;
    for (const Timed& one : all)
        std::printf("  %-40s %6.1f GB/s %6.1f ms %5.0f %%\n", one.name, one.bytes / one.best / 1e9, 1e3 * one.best,
                    100 * one.bytes / one.best / plain);
}

}  // namespace
}  // namespace patchlight

int main(int argc, char** argv)
{
    const auto argument = [&](int k, std::size_t usual) {
        return argc > k ? static_cast<std::size_t>(std::stoul(argv[k])) : usual;
    };
    const int rounds = static_cast<int>(argument(4, 30));
    const std::size_t full = argument(1, 5000);
    patchlight::sweeps_over("full matrix", full, full, rounds);
    patchlight::sweeps_over("sampled rows", argument(2, 10000), argument(3, 512), rounds);
}
