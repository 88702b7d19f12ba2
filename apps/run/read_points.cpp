#include "apps/run/probing.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace patchlight {

namespace {

constexpr std::array<std::string_view, 9> names{"x", "y", "z", "nx", "ny", "nz", "br", "bg", "bb"};
constexpr std::size_t absent = static_cast<std::size_t>(-1);
using Columns = std::array<std::size_t, names.size()>;

std::string_view trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line)
{
    std::vector<std::string_view> fields;
    for (;;) {
        const auto comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) {
            return fields;
        }
        line.remove_prefix(comma + 1);
    }
}

/// Nothing when it isn't a finite number from its first character to its last.
std::optional<double> number_in(std::string_view text)
{
    if (text.starts_with('+')) {
        text.remove_prefix(1);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value;
}

class PointReader {
public:
    PointReader(const std::string& name) : name_(name) {}

    void line(std::string_view text)
    {
        ++number_;
        text = number_ == 1 && text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
        if (trimmed(text).empty()) {
            return;
        }
        const std::vector<std::string_view> fields = fields_of(text);
        if (width_ == 0) {
            width_ = fields.size();
            if (is_header(fields)) {
                header(fields);
                return;
            }
            if (width_ != 3 && width_ != 6) {
                fail(fmt::format("{} values; a row is x,y,z or x,y,z,nx,ny,nz", width_));
            }
            columns_.fill(absent);
            for (std::size_t k = 0; k < width_; ++k) columns_[k] = k;
        }
        row(fields);
    }

    std::vector<ProbePoint> take() { return std::move(points_); }

private:
    [[noreturn]] void fail(const std::string& cause) const
    {
        throw PointsError(fmt::format("{}:{}: {}", name_, number_, cause));
    }

    /// A word that begins as numbers do is a mistyped number, not a name.
    static bool is_header(const std::vector<std::string_view>& fields)
    {
        for (std::string_view field : fields) {
            if (field == "x" || field == "X") {
                return true;
            }
        }
        return false;
    }

    void header(const std::vector<std::string_view>& fields)
    {
        columns_.fill(absent);
        for (std::size_t i = 0; i < fields.size(); ++i) {
            std::string lower(fields[i]);
            for (char& c : lower) {
                c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
            }
            for (std::size_t k = 0; k < names.size(); ++k) {
                columns_[k] = lower == names[k] ? i : columns_[k];
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (columns_[k] == absent) {
                fail(fmt::format("the header has no column \"{}\"", names[k]));
            }
        }
        for (std::size_t k = 3; k < names.size(); k += 3) {
            const auto given = columns_.begin() + static_cast<std::ptrdiff_t>(k);
            const auto missing = std::count(given, given + 3, absent);
            if (missing == 1 || missing == 2) {
                fail(fmt::format("the header has only part of {}", k == 3 ? "nx,ny,nz" : "Br,Bg,Bb"));
            }
        }
    }

    Vec3 three(const std::vector<std::string_view>& fields, std::size_t k) const
    {
        return {value(fields, k), value(fields, k + 1), value(fields, k + 2)};
    }

    double value(const std::vector<std::string_view>& fields, std::size_t column) const
    {
        const std::string_view field = fields[columns_[column]];
        const auto number = number_in(field);
        if (!number) {
            fail(fmt::format("\"{}\" is not a finite number", field));
        }
        return *number;
    }

    void row(const std::vector<std::string_view>& fields)
    {
        if (fields.size() != width_) {
            fail(fmt::format("{} values where the first row has {}", fields.size(), width_));
        }
        ProbePoint point;
        point.position = three(fields, 0);
        for (std::size_t k = 0; k < 3; ++k) {
            point.as_written[k] = std::string(fields[columns_[k]]);
        }
        if (columns_[3] != absent) {
            const Vec3 normal = three(fields, 3);
            if (!(glm::length(normal) > 0) || !std::isfinite(glm::length(normal))) {
                fail("the normal has no length");
            }
            point.normal = normal;
        }
        // `probe` leaves them empty where no surface is.
        if (columns_[6] != absent && !fields[columns_[6]].empty()) {
            point.B = three(fields, 6);
        }
        points_.push_back(point);
    }

    const std::string& name_;
    std::size_t number_ = 0;
    std::size_t width_ = 0;
    Columns columns_{};
    std::vector<ProbePoint> points_;
};

}  // namespace

std::vector<ProbePoint> read_points(std::string_view text, const std::string& name)
{
    PointReader reader(name);
    while (!text.empty()) {
        const auto end = text.find('\n');
        reader.line(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return reader.take();
}

}  // namespace patchlight
