#include "formfactor/audit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

constexpr std::size_t most_named = 8;
constexpr double above_one = 1 + 1e-12;

bool ascending(const FormFactorMatrix& matrix)
{
    for (std::size_t i = 0; i < matrix.size(); ++i)
        for (std::size_t k = matrix.row_start[i] + 1; k < matrix.row_start[i + 1]; ++k)
            if (matrix.columns[k - 1] >= matrix.columns[k]) return false;
    return true;
}

void require_fit(const FormFactorMatrix& matrix, const PatchField<double>& areas)
{
    if (areas.size() != matrix.size()) throw std::invalid_argument("audit: there are not as many areas as rows");
    if (std::ranges::any_of(matrix.columns, [&](std::uint32_t column) { return column >= matrix.size(); }))
        throw std::invalid_argument("audit: a column is past the end");
}

void look_at(const NamedFactor& entry, FormFactorAudit& result)
{
    if (!std::isfinite(entry.factor)) {
        ++result.non_finite_count;
        if (result.non_finite.size() < most_named) result.non_finite.push_back(entry);
        return;
    }
    if (entry.factor < 0 || entry.factor > above_one) {
        ++result.outside_count;
        if (result.outside.size() < most_named) result.outside.push_back(entry);
    }
    if (entry.row == entry.column && entry.factor != 0) ++result.own_count;
}

/// Σ_j F_ij of each row over what is finite.
PatchField<double> row_sums(const FormFactorMatrix& matrix)
{
    PatchField<double> sums(matrix.size());
    for (std::size_t i = 0; i < matrix.size(); ++i)
        for (std::size_t k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k)
            if (std::isfinite(matrix.factors[k])) sums[PatchId(i)] += matrix.factors[k];
    return sums;
}

double closure_of_row(const FormFactorMatrix& matrix, PatchId patch, double sum, bool closed)
{
    const double backs = matrix.backs.empty() ? 0 : matrix.backs[patch];
    if (closed) return std::abs(1 - sum - backs);
    if (matrix.escaped.empty()) return std::max(0.0, sum + backs - 1);
    return std::abs(1 - sum - backs - matrix.escaped[patch]);
}

ClosureDefect closure_of(const FormFactorMatrix& matrix, const PatchField<double>& sums, bool closed)
{
    ClosureDefect result;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const double defect = closure_of_row(matrix, PatchId(i), sums[PatchId(i)], closed);
        result.mean += defect;
        if (defect > result.worst || !result.worst_patch.valid()) {
            result.worst = defect;
            result.worst_patch = PatchId(i);
        }
    }
    if (matrix.size() > 0) result.mean /= static_cast<double>(matrix.size());
    return result;
}

/// Meets every pair i < j that has an entry either way. Rows ascend, so that a cursor a row, moving on as i grows,
/// finds all F_ji without a transposed copy of what may be gigabytes.
class PairWalk {
public:
    explicit PairWalk(const FormFactorMatrix& matrix)
        : matrix_(matrix), cursor_(matrix.row_start.begin(), matrix.row_start.end())
    {}

    /// Calls visit(i, j, F_ij, F_ji), 0 where there is no entry.
    template <class Visit>
    void go(const Visit& visit)
    {
        for (std::size_t i = 0; i < matrix_.size(); ++i) {
            for (std::size_t k = matrix_.row_start[i]; k < matrix_.row_start[i + 1]; ++k) {
                const std::size_t j = matrix_.columns[k];
                if (j == i) continue;
                const double* opposite = find(j, i);
                if (j > i)
                    visit(i, j, matrix_.factors[k], opposite ? *opposite : 0.0);
                else if (!opposite)
                    visit(j, i, 0.0, matrix_.factors[k]);
            }
        }
    }

private:
    const double* find(std::size_t row, std::size_t column)
    {
        std::size_t& k = cursor_[row];
        const std::size_t end = matrix_.row_start[row + 1];
        while (k < end && matrix_.columns[k] < column) ++k;
        return k < end && matrix_.columns[k] == column ? &matrix_.factors[k] : nullptr;
    }

    const FormFactorMatrix& matrix_;
    std::vector<std::size_t> cursor_;
};

ReciprocityDefect reciprocity_of(const FormFactorMatrix& matrix, const PatchField<double>& areas,
                                 const PatchField<double>& sums)
{
    ReciprocityDefect result;
    PairWalk(matrix).go([&](std::size_t i, std::size_t j, double forth, double back) {
        if (!std::isfinite(forth) || !std::isfinite(back)) return;
        const PatchId a(i), b(j);
        const double scale = std::max(areas[a] * sums[a], areas[b] * sums[b]);
        const double difference = std::abs(areas[a] * forth - areas[b] * back);
        const double defect = difference > 0 ? difference / scale : 0;
        ++result.pairs;
        result.mean += defect;
        if (defect > result.worst) {
            result.worst = defect;
            result.first = a;
            result.second = b;
        }
    });
    if (result.pairs > 0) result.mean /= static_cast<double>(result.pairs);
    return result;
}

FormFactorAudit audit_ascending(const FormFactorMatrix& matrix, const PatchField<double>& areas, bool closed)
{
    FormFactorAudit result;
    result.rows = matrix.size();
    result.entries = matrix.factors.size();
    for (std::size_t i = 0; i < matrix.size(); ++i)
        for (std::size_t k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k)
            look_at({PatchId(i), PatchId(matrix.columns[k]), matrix.factors[k]}, result);
    const PatchField<double> sums = row_sums(matrix);
    for (const double sum : sums.values())
        if (!(sum > 0)) ++result.zero_rows;
    result.closure = closure_of(matrix, sums, closed);
    result.reciprocity = reciprocity_of(matrix, areas, sums);
    return result;
}

}  // namespace

FormFactorAudit audit(const FormFactorMatrix& matrix, const PatchField<double>& areas, bool closed)
{
    require_fit(matrix, areas);
    if (ascending(matrix)) return audit_ascending(matrix, areas, closed);
    FormFactorMatrix sorted = matrix;
    sort_columns(sorted);
    return audit_ascending(sorted, areas, closed);
}

void sort_columns(FormFactorMatrix& matrix)
{
    tbb::parallel_for(std::size_t{0}, matrix.size(), [&](std::size_t i) {
        const std::size_t first = matrix.row_start[i], count = matrix.row_start[i + 1] - first;
        std::vector<std::pair<std::uint32_t, double>> row(count);
        for (std::size_t k = 0; k < count; ++k) row[k] = {matrix.columns[first + k], matrix.factors[first + k]};
        std::ranges::sort(row, {}, &std::pair<std::uint32_t, double>::first);
        for (std::size_t k = 0; k < count; ++k) std::tie(matrix.columns[first + k], matrix.factors[first + k]) = row[k];
    });
}

}  // namespace patchlight
