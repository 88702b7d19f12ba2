#include "meshing/obj_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace patchlight {

namespace {

constexpr std::string_view blanks = " \t\r";

bool is_corner(std::string_view word)
{
    const std::string_view index = word.substr(0, word.find('/'));
    int value = 0;
    const char* end = index.data() + index.size();
    const auto parsed = std::from_chars(index.data(), end, value);
    return parsed.ec == std::errc{} && parsed.ptr == end;
}

Vec3 scan_vertex(std::string_view rest)
{
    Vec3 v{0.0};
    for (int k = 0; k < 3; ++k) v[k] = number_or_nan(next_word(rest));
    return v;
}

}  // namespace

bool LineReader::next(std::string_view& line)
{
    if (rest_.empty()) return false;
    ++number_;
    const std::size_t end = rest_.find_first_of("\r\n");
    line = rest_.substr(0, end);
    if (end == std::string_view::npos) {
        rest_ = {};
    } else {
        const bool two = rest_[end] == '\r' && end + 1 < rest_.size() && rest_[end + 1] == '\n';
        rest_.remove_prefix(end + (two ? 2 : 1));
    }
    return true;
}

std::string_view next_word(std::string_view& line)
{
    const std::size_t start = line.find_first_not_of(blanks);
    if (start == std::string_view::npos) return line = {};
    line.remove_prefix(start);
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t start = text.find_first_not_of(blanks);
    if (start == std::string_view::npos) return {};
    return text.substr(start, text.find_last_not_of(blanks) - start + 1);
}

double number_or_nan(std::string_view word)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const char* end = word.data() + word.size();
    const auto parsed = std::from_chars(word.data(), end, value);
    if (parsed.ptr != end || word.empty() || parsed.ec == std::errc::invalid_argument) return nan;
    if (parsed.ec == std::errc::result_out_of_range) {
        // Too small is zero, too large is no number that can be used.
        return word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos ? 0.0 : nan;
    }
    return std::isfinite(value) ? value : nan;
}

std::string cleaned_obj(std::string text)
{
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    std::replace(text.begin(), text.end(), '\0', '?');
    std::size_t owed = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\n') continue;
        const std::size_t last = i > 0 && text[i - 1] == '\r' ? i - 1 : i;
        if (last > 0 && text[last - 1] == '\\') {
            for (std::size_t k = last - 1; k <= i; ++k) text[k] = ' ';
            ++owed;
        } else if (owed > 0) {
            text.insert(i, owed, '\n');
            i += owed;
            owed = 0;
        }
    }
    return text;
}

ObjText scan_obj(std::string_view text)
{
    ObjText found;
    LineReader lines(text);
    std::string_view line;
    while (lines.next(line)) {
        const std::string_view keyword = next_word(line);
        if (keyword == "v" && !line.empty()) {
            found.vertices.push_back(scan_vertex(line));
            found.vertex_lines.push_back(lines.number());
        } else if (keyword == "f") {
            if (trimmed(line).empty()) continue;
            found.face_lines.push_back(lines.number());
            for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
                if (!is_corner(word)) found.bad_corners.emplace(lines.number(), std::string(word));
            }
        } else if (keyword == "mtllib") {
            found.material_files.emplace_back(trimmed(line));
        } else if (keyword == "l" || keyword == "p") {
            ++found.lines_and_points;
        } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
            ++found.curved;
        }
    }
    return found;
}

}  // namespace patchlight
