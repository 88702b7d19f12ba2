#include "solver/light_operator.h"

#include "formfactor/random_numbers.h"

#include <algorithm>
#include <cmath>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace patchlight {

namespace {

using Lanes = double __attribute__((vector_size(32)));

/// Σ factors[k] · light[columns[k]] over `count` entries into sum[0 … 2].
__attribute__((target_clones("avx2", "default"))) void add_entries(const std::uint32_t* columns, const double* factors,
                                                                   std::size_t count, const double* light, double* sum)
{
    constexpr std::size_t ahead = 512;
    const auto* const lanes = reinterpret_cast<const Lanes*>(light);
    // Four sums: in one, every addition would wait for the one before. Rows follow each other in memory, and are
    // fetched four kilobytes ahead: 1.5 times as fast as left to the processor.
    Lanes a{}, b{}, c{}, d{};
    std::size_t k = 0;
    for (; k + 16 <= count; k += 16) {
        __builtin_prefetch(factors + k + ahead, 0, 2);
        __builtin_prefetch(factors + k + ahead + 8, 0, 2);
        __builtin_prefetch(columns + k + ahead, 0, 2);
        for (std::size_t step = k; step < k + 16; step += 4) {
            a += factors[step] * lanes[columns[step]];
            b += factors[step + 1] * lanes[columns[step + 1]];
            c += factors[step + 2] * lanes[columns[step + 2]];
            d += factors[step + 3] * lanes[columns[step + 3]];
        }
    }
    for (; k < count; ++k) a += factors[k] * lanes[columns[k]];
    const Lanes all = (a + b) + (c + d);
    for (int band = 0; band < 3; ++band) sum[band] = all[band];
}

}  // namespace

LightLanes::LightLanes(const Radiosity& B) : lanes_(std::max<std::size_t>(1, B.size()))
{
    for (std::size_t i = 0; i < B.size(); ++i) set(PatchId(i), B[PatchId(i)]);
}

Rgb gathered(const FormFactorMatrix& F, const LightLanes& B, std::size_t row)
{
    const std::size_t begin = F.row_start[row];
    Rgb sum(0.0);
    add_entries(F.columns.data() + begin, F.factors.data() + begin, F.row_start[row + 1] - begin, B.data(), &sum.r);
    return sum;
}

LightOperator rows_of(const FormFactorMatrix& F)
{
    return [&F](const Radiosity& B, Radiosity& H) {
        constexpr std::size_t grain = 16;
        const LightLanes light(B);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, F.size(), grain), [&](const auto& rows) {
            for (std::size_t i = rows.begin(); i < rows.end(); ++i) H[PatchId(i)] = gathered(F, light, i);
        });
    };
}

double asymmetry(const LightOperator& F, const PatchField<double>& areas)
{
    Radiosity v(areas.size()), Fv(areas.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        RandomNumbers random(0, i);
        v[PatchId(i)] = Rgb(random.uniform(), random.uniform(), 0);
    }
    F(v, Fv);
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        const PatchId p(i);
        const double one = areas[p] * v[p].r * Fv[p].g, other = areas[p] * v[p].g * Fv[p].r;
        difference += one - other;
        sum += one + other;
    }
    return sum > 0 ? std::abs(difference) / sum : 0;
}

}  // namespace patchlight
