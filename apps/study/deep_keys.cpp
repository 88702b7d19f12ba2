#include "apps/study/deep_keys.h"

#include <cstddef>

namespace patchlight {

namespace {

constexpr int most_parts = 16;

/// Behind a comment or a string that begins at `at`; otherwise `at`.
std::size_t skipped(std::string_view toml, std::size_t at)
{
    const auto or_end = [&](std::size_t found, std::size_t more) {
        return found == std::string_view::npos ? toml.size() : found + more;
    };
    const char c = toml[at];
    if (c == '#') return or_end(toml.find('\n', at), 0);
    if (c != '"' && c != '\'') return at;
    const bool tall = toml.substr(at, 3) == std::string_view(c == '"' ? "\"\"\"" : "'''");
    for (std::size_t i = at + (tall ? 3 : 1); i < toml.size(); ++i) {
        if (c == '"' && toml[i] == '\\') {
            ++i;
        } else if (toml[i] == c && (!tall || toml.substr(i, 3) == toml.substr(at, 3))) {
            return i + (tall ? 3 : 1);
        } else if (toml[i] == '\n' && !tall) {
            return i;
        }
    }
    return toml.size();
}

}  // namespace

TextPlace place_of_deep_key(std::string_view toml)
{
    TextPlace place{1, 0};
    std::size_t line_start = 0;
    int dots = 0;
    for (std::size_t i = 0; i < toml.size(); ++i) {
        if (const std::size_t behind = skipped(toml, i); behind != i) {
            for (; i < behind; ++i)
                if (toml[i] == '\n') ++place.line, line_start = i + 1;
            --i;
            continue;
        }
        if (toml[i] == '\n') ++place.line, line_start = i + 1;
        if (toml[i] == '.') ++dots;
        // What can't stand within a key.
        if (std::string_view("\n=,[]{}").find(toml[i]) != std::string_view::npos) dots = 0;
        if (dots >= most_parts) {
            place.column = static_cast<int>(i - line_start) + 1;
            return place;
        }
    }
    return {};
}

}  // namespace patchlight
