#include "apps/study/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

namespace patchlight {

namespace {

/// Characters of UTF-8: every byte but those that go on with one.
std::size_t width_of(std::string_view text)
{
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right)
{
    const std::string room(width - std::min(width, width_of(text)), ' ');
    return right ? room + text : text + room;
}

using Fields = std::vector<std::string>;

/// All rows, the heads first, as a notation has their texts.
std::vector<Fields> escaped(const TextTable& table, const std::function<std::string(std::string_view)>& escape)
{
    std::vector<Fields> rows{table.heads};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    for (Fields& row : rows)
        for (std::string& field : row) field = escape(field);
    return rows;
}

std::string line_of(const Fields& row, const std::vector<std::size_t>& widths, const std::vector<bool>& right,
                    const char* begin, const char* between, const char* end)
{
    std::string line = begin;
    for (std::size_t c = 0; c < row.size(); ++c) line += (c == 0 ? "" : between) + padded(row[c], widths[c], right[c]);
    return line + end;
}

std::vector<std::size_t> widths_of(const std::vector<Fields>& rows)
{
    std::vector<std::size_t> widths(rows.front().size(), 3);
    for (const Fields& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
    return widths;
}

}  // namespace

std::string markdown(const TextTable& table)
{
    const auto rows = escaped(table, markdown_text);
    const auto widths = widths_of(rows);
    std::string out = line_of(rows.front(), widths, table.right, "| ", " | ", " |\n");
    for (std::size_t c = 0; c < widths.size(); ++c) {
        const std::string rule(widths[c] - 1, '-');
        out += "| " + (table.right[c] ? rule + ":" : ":" + rule) + " ";
    }
    out += "|\n";
    for (std::size_t r = 1; r < rows.size(); ++r) out += line_of(rows[r], widths, table.right, "| ", " | ", " |\n");
    return out;
}

std::string latex(const TextTable& table)
{
    const auto rows = escaped(table, latex_text);
    const auto widths = widths_of(rows);
    std::string out = "% needs \\usepackage{booktabs}\n\\begin{tabular}{";
    for (const bool right : table.right) out += right ? 'r' : 'l';
    out += "}\n\\toprule\n" + line_of(rows.front(), widths, table.right, "", " & ", " \\\\\n\\midrule\n");
    for (std::size_t r = 1; r < rows.size(); ++r) out += line_of(rows[r], widths, table.right, "", " & ", " \\\\\n");
    return out + "\\bottomrule\n\\end{tabular}\n";
}

std::string csv(const TextTable& table)
{
    std::string out;
    for (const Fields& row : escaped(table, csv_field)) out += fmt::format("{}\r\n", fmt::join(row, ","));
    return out;
}

std::string markdown_text(std::string_view text)
{
    const auto is_in_word = [&](std::size_t i) {
        return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
    };
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        // Inside words GitHub's underscores are letters, and better read without a backslash.
        const bool letter = c == '_' && is_in_word(i - 1) && is_in_word(i + 1);
        if (!letter && std::string_view("\\|`*_<>[]&#~").find(c) != std::string_view::npos) out += '\\';
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out;
}

std::string latex_text(std::string_view text)
{
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\textbackslash{}";
        else if (c == '~')
            out += "\\textasciitilde{}";
        else if (c == '^')
            out += "\\textasciicircum{}";
        else if (c == '\n' || c == '\r')
            out += ' ';
        else if (std::string_view("{}$&#_%").find(c) != std::string_view::npos)
            out += std::string("\\") + c;
        else
            out += c;
    }
    return out;
}

std::string csv_field(std::string_view text)
{
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string rounded(double value, int digits)
{
    if (!std::isfinite(value)) return "–";
    if (value == 0) return "0";
    // Of the rounded number: 9.999 has the digits of 10.
    const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
    const int power = std::stoi(scientific.substr(scientific.find('e') + 1));
    if (power < -4 || power > 6) return scientific;
    return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - power));
}

std::string in_full(double value)
{
    return std::isfinite(value) ? fmt::format("{}", value) : "";
}

}  // namespace patchlight
