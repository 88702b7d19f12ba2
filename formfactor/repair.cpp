#include "formfactor/audit.h"

#include "meshing/positive_part.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace patchlight {

FormFactorMatrix transposed(const FormFactorMatrix& matrix)
{
    FormFactorMatrix result;
    result.row_start.assign(matrix.row_start.size(), 0);
    for (const std::uint32_t column : matrix.columns) ++result.row_start[column + 1];
    for (std::size_t i = 1; i < result.row_start.size(); ++i) result.row_start[i] += result.row_start[i - 1];
    result.columns.resize(matrix.columns.size());
    result.factors.resize(matrix.factors.size());
    std::vector<std::size_t> next(result.row_start.begin(), result.row_start.end());
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        for (std::size_t k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k) {
            const std::size_t to = next[matrix.columns[k]]++;
            result.columns[to] = static_cast<std::uint32_t>(i);
            result.factors[to] = matrix.factors[k];
        }
    }
    return result;
}

namespace {

constexpr double row_tolerance = 1e-12;
constexpr std::size_t most_iterations = 1000;
/// Where rows can't all have their sums, some scales grow and others shrink without end, by what the former grow: the
/// product, which is all that counts, stays a number.
constexpr double largest_scale = 1e150;
/// A row with less to share sees nothing but backs.
constexpr double least_share = 1e-9;

void require_positive(const FormFactorMatrix& matrix)
{
    if (!std::ranges::all_of(matrix.factors, [](double f) { return f >= 0 && std::isfinite(f); }))
        throw std::invalid_argument("repair: a factor is negative or not finite");
}

/// A_i F_ij, rows ascending.
FormFactorMatrix exchanges(const FormFactorMatrix& matrix, const PatchField<double>& areas)
{
    FormFactorMatrix result;
    result.row_start = matrix.row_start;
    result.columns = matrix.columns;
    result.factors = matrix.factors;
    sort_columns(result);
    for (std::size_t i = 0; i < result.size(); ++i)
        for (std::size_t k = result.row_start[i]; k < result.row_start[i + 1]; ++k)
            result.factors[k] *= areas[PatchId(i)];
    return result;
}

/// (G + Gᵀ)/2 with the union of both patterns. Addition commutes, so that both halves are the same bits.
FormFactorMatrix mean_with_transposed(const FormFactorMatrix& G, std::size_t& added)
{
    const FormFactorMatrix T = transposed(G);
    FormFactorMatrix result;
    result.row_start.push_back(0);
    const auto push = [&](std::uint32_t column, double value) {
        result.columns.push_back(column);
        result.factors.push_back(0.5 * value);
    };
    for (std::size_t i = 0; i < G.size(); ++i) {
        std::size_t a = G.row_start[i], b = T.row_start[i];
        const std::size_t a_end = G.row_start[i + 1], b_end = T.row_start[i + 1];
        while (a < a_end || b < b_end) {
            if (b == b_end || (a < a_end && G.columns[a] < T.columns[b])) {
                push(G.columns[a], G.factors[a]);
                ++a;
            } else if (a == a_end || T.columns[b] < G.columns[a]) {
                push(T.columns[b], T.factors[b]);
                if (T.factors[b] > 0) ++added;
                ++b;
            } else {
                push(G.columns[a], G.factors[a] + T.factors[b]);
                if (G.factors[a] == 0 && T.factors[b] > 0) ++added;
                ++a, ++b;
            }
        }
        result.row_start.push_back(result.columns.size());
    }
    return result;
}

/// What the rows are to be scaled to.
struct Balance {
    std::vector<double> escaped;  ///< A_i escaped_i: scaled with the row, but nobody's column
    std::vector<double> targets;  ///< A_i (1 − backs_i)
};

/// Σ_j d_i G_ij d_j of a row, and what escapes.
double scaled_sum(const FormFactorMatrix& G, const Balance& balance, const std::vector<double>& d, std::size_t row)
{
    double sum = balance.escaped[row];
    for (std::size_t k = G.row_start[row]; k < G.row_start[row + 1]; ++k) sum += G.factors[k] * d[G.columns[k]];
    return sum * d[row];
}

double sum_of_row(const FormFactorMatrix& matrix, std::size_t row)
{
    double sum = 0;
    for (std::size_t k = matrix.row_start[row]; k < matrix.row_start[row + 1]; ++k) sum += matrix.factors[k];
    return sum;
}

Balance balance_of(const FormFactorMatrix& matrix, const FormFactorMatrix& G, const PatchField<double>& areas,
                   bool closed)
{
    Balance balance{std::vector<double>(G.size()), std::vector<double>(G.size())};
    for (std::size_t i = 0; i < G.size(); ++i) {
        const PatchId patch(i);
        const double share = 1 - (matrix.backs.empty() ? 0 : matrix.backs[patch]);
        const double escaped = closed                   ? 0
                               : matrix.escaped.empty() ? positive_part(share - sum_of_row(matrix, i))
                                                        : matrix.escaped[patch];
        balance.escaped[i] = areas[patch] * escaped;
        // A row that sees nothing but backs keeps what little it has, and its backs make room for it.
        balance.targets[i] = share > least_share ? areas[patch] * share : balance.escaped[i] + sum_of_row(G, i);
    }
    return balance;
}

/// d that brings all rows to their targets. Rows without anything stay as they are.
std::vector<double> symmetric_scaling(const FormFactorMatrix& G, const Balance& balance, RepairReport& report)
{
    std::vector<double> d(G.size(), 1.0), sums(G.size());
    for (;;) {
        double worst = 0;
        for (std::size_t i = 0; i < G.size(); ++i) {
            sums[i] = scaled_sum(G, balance, d, i);
            if (sums[i] > 0) worst = std::max(worst, std::abs(sums[i] / balance.targets[i] - 1));
        }
        report.converged = worst <= row_tolerance;
        if (report.converged || report.iterations == most_iterations) return d;
        ++report.iterations;
        for (std::size_t i = 0; i < G.size(); ++i)
            if (sums[i] > 0)
                d[i] = std::clamp(d[i] * std::sqrt(balance.targets[i] / sums[i]), 1 / largest_scale, largest_scale);
    }
}

void scale(FormFactorMatrix& G, const std::vector<double>& d, RepairReport& report)
{
    for (std::size_t i = 0; i < G.size(); ++i) {
        for (std::size_t k = G.row_start[i]; k < G.row_start[i + 1]; ++k) {
            // The product of both first: the same bits from either side.
            const double factor = d[i] * d[G.columns[k]];
            G.factors[k] *= factor;
            if (G.factors[k] > 0) report.largest_scaling = std::max(report.largest_scaling, std::abs(factor - 1));
        }
    }
}

void divide_by_areas(FormFactorMatrix& G, const PatchField<double>& areas)
{
    for (std::size_t i = 0; i < G.size(); ++i)
        for (std::size_t k = G.row_start[i]; k < G.row_start[i + 1]; ++k) G.factors[k] /= areas[PatchId(i)];
}

/// max_i Σ_j |F'_ij − F_ij|; the new pattern contains the old one, and both ascend.
double largest_row_change(const FormFactorMatrix& before, const FormFactorMatrix& after)
{
    double largest = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        std::size_t k = before.row_start[i];
        double change = 0;
        for (std::size_t l = after.row_start[i]; l < after.row_start[i + 1]; ++l) {
            const bool known = k < before.row_start[i + 1] && before.columns[k] == after.columns[l];
            change += std::abs(after.factors[l] - (known ? before.factors[k++] : 0.0));
        }
        largest = std::max(largest, change);
    }
    return largest;
}

}  // namespace

RepairReport repair_symmetrically(FormFactorMatrix& matrix, const PatchField<double>& areas, bool closed)
{
    require_positive(matrix);
    sort_columns(matrix);
    const FormFactorAudit before = audit(matrix, areas, closed);
    RepairReport report;
    report.closure_before = before.closure;
    report.reciprocity_before = before.reciprocity;
    FormFactorMatrix G = mean_with_transposed(exchanges(matrix, areas), report.added);
    const Balance balance = balance_of(matrix, G, areas, closed);
    const std::vector<double> d = symmetric_scaling(G, balance, report);
    scale(G, d, report);
    divide_by_areas(G, areas);
    report.largest_row_change = largest_row_change(matrix, G);
    matrix.row_start = std::move(G.row_start);
    matrix.columns = std::move(G.columns);
    matrix.factors = std::move(G.factors);
    matrix.escaped = PatchField<double>(matrix.size());
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        const PatchId patch(i);
        matrix.escaped[patch] = d[i] * balance.escaped[i] / areas[patch];
        if (!matrix.backs.empty() && !(1 - matrix.backs[patch] > least_share))
            matrix.backs[patch] = positive_part(1 - sum_of_row(matrix, i) - matrix.escaped[patch]);
    }
    const FormFactorAudit after = audit(matrix, areas, closed);
    report.closure_after = after.closure;
    report.reciprocity_after = after.reciprocity;
    return report;
}

}  // namespace patchlight
