#pragma once

#include "apps/run/run_options.h"
#include "apps/study/study_result.h"

#include <string>

namespace patchlight {

enum class TableFormat { markdown, csv, json, latex };

struct TableOptions {
    TableFormat format = TableFormat::markdown;
    bool seconds = false;  ///< also what the clock says: the same study then gives other bytes each time
    bool cycles = false;   ///< a row each cycle of a cell, not its last alone
};

/// A study's results in a notation. Markdown holds rates, comparisons and gates below the cells; CSV and JSON numbers
/// in full and errors as fractions, Markdown and LaTeX a few digits and errors in per cent. Without `seconds` it
/// depends on the results alone.
std::string table_text(const StudyResult& study, const TableOptions& options = {});

/// The same as data, with rates, comparisons and gates: {schema, name, axes, along, error, cells, rates, comparisons,
/// gates}.
Json table_json(const StudyResult& study, const TableOptions& options = {});

}  // namespace patchlight
