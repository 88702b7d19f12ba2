#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// Plain texts, to be written in some notation. Every row has as many fields as there are heads.
struct TextTable {
    std::vector<std::string> heads;
    std::vector<bool> right;  ///< one a column: aligned right, as numbers are
    std::vector<std::vector<std::string>> rows;
};

/// A GitHub table, its columns padded so that it reads well as it is.
std::string markdown(const TextTable& table);
/// A tabular in the manner of the package booktabs.
std::string latex(const TextTable& table);
/// RFC 4180: lines end in CR LF.
std::string csv(const TextTable& table);

/// Text in which nothing is markup, on one line.
std::string markdown_text(std::string_view text);
std::string latex_text(std::string_view text);
/// Quoted where it must be.
std::string csv_field(std::string_view text);

/// A number in so many significant digits, 1.230, with an exponent where it is very small or large, as 1.2e-06. "–" for
/// what isn't finite.
std::string rounded(double value, int digits);
/// In as few digits as give the same number back; empty for what isn't finite.
std::string in_full(double value);

}  // namespace patchlight
