#pragma once

#include "formfactor/form_factors.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// Collects rows, each once and in any order and from many threads at once, and joins them into a matrix.
class CompressedRows {
public:
    explicit CompressedRows(std::size_t patches);

    /// Row i: its factors, raw_sum, escaped and backs.
    void put(PatchId i, const FormFactorRow& row);

    /// All rows; the collector is empty afterwards.
    FormFactorMatrix matrix(std::size_t rays);

private:
    struct Row {
        std::vector<std::uint32_t> columns;
        std::vector<double> factors;
    };
    std::vector<Row> rows_;
    FormFactorMatrix matrix_;
};

}  // namespace patchlight
