#pragma once

#include "meshing/vectors.h"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// Splits a text as the OBJ and MTL reader does: at \n, \r\n and \r. Numbers lines from 1.
class LineReader {
public:
    explicit LineReader(std::string_view text) : rest_(text) {}
    /// The next line without its end, false when there is none.
    bool next(std::string_view& line);
    std::size_t number() const { return number_; }

private:
    std::string_view rest_;
    std::size_t number_ = 0;
};

/// The next word of a line, which is cut off its front; empty at the end.
std::string_view next_word(std::string_view& line);
std::string_view trimmed(std::string_view text);

/// The number a word spells; NaN when it spells none, when it doesn't fit a double, or when it is NaN or infinite.
double number_or_nan(std::string_view word);

/// What the OBJ reader doesn't tell or gets wrong: line numbers, numbers that aren't (it reads `nan 0 1` as
/// `0 0 1`), indices that don't fit (it wraps them), and the names of material files with spaces in them.
struct ObjText {
    std::vector<Vec3> vertices;  ///< file units; NaN where the text has no finite number
    std::vector<std::size_t> vertex_lines;
    std::vector<std::size_t> face_lines;
    std::map<std::size_t, std::string> bad_corners;  ///< line of a face → the corner that is no index
    std::vector<std::string> material_files;         ///< the rest of each mtllib line
    std::size_t lines_and_points = 0;                ///< l and p statements
    std::size_t curved = 0;                          ///< curv, curv2 and surf statements
};

/// The text without a byte order mark or zero bytes, lines that end in a backslash joined with the next; every
/// other line keeps its number.
std::string cleaned_obj(std::string text);

ObjText scan_obj(std::string_view text);

}  // namespace patchlight
