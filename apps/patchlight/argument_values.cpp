#include "apps/patchlight/argument_values.h"

#include "apps/imaging/image.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace patchlight {

namespace {

/// from_chars knows no locale, no blanks and no rests.
template <class Number>
std::optional<Number> exactly(std::string_view text)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty()) {
        return std::nullopt;
    }
    if constexpr (std::is_floating_point_v<Number>) {
        if (!std::isfinite(value)) {
            return std::nullopt;
        }
    }
    return value;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& wanted)
{
    throw UsageError("usage", fmt::format("{}: \"{}\" is not {}", option, text, wanted));
}

std::vector<std::string_view> pieces(std::string_view text, char separator)
{
    std::vector<std::string_view> result;
    for (;;) {
        const auto end = text.find(separator);
        result.push_back(text.substr(0, end));
        if (end == std::string_view::npos) {
            return result;
        }
        text.remove_prefix(end + 1);
    }
}

std::optional<Vec3> three_numbers(std::string_view text)
{
    const auto parts = pieces(text, ',');
    Vec3 result;
    if (parts.size() != 3) {
        return std::nullopt;
    }
    for (int k = 0; k < 3; ++k) {
        const auto value = exactly<double>(parts[k]);
        if (!value) {
            return std::nullopt;
        }
        result[k] = *value;
    }
    return result;
}

CLI::Validator checked(std::string shown, std::function<bool(const std::string&)> good)
{
    return CLI::Validator(
        [shown, good = std::move(good)](const std::string& text) {
            return good(text) ? std::string() : fmt::format("\"{}\" is not {}", text, shown);
        },
        "");
}

}  // namespace

CLI::Validator whole_between(long long low, long long high)
{
    return checked(fmt::format("a whole number from {} to {}", low, high), [=](const std::string& text) {
        const auto value = exactly<long long>(text);
        return value && *value >= low && *value <= high;
    });
}

CLI::Validator number_between(double low, double high)
{
    return checked(fmt::format("a number from {} to {}", low, high), [=](const std::string& text) {
        const auto value = exactly<double>(text);
        return value && *value >= low && *value <= high;
    });
}

CLI::Validator number_above(double low)
{
    return checked(fmt::format("a number above {}", low), [=](const std::string& text) {
        const auto value = exactly<double>(text);
        return value && *value > low;
    });
}

std::pair<int, int> size_in(const std::string& option, const std::string& text)
{
    const auto parts = pieces(text, 'x');
    const std::string wanted = fmt::format("WxH with sides from 1 to {}", largest_picture_side);
    if (parts.size() != 2) {
        refuse(option, text, wanted);
    }
    const auto width = exactly<int>(parts[0]), height = exactly<int>(parts[1]);
    if (!width || !height || *width < 1 || *height < 1 || *width > largest_picture_side ||
        *height > largest_picture_side) {
        refuse(option, text, wanted);
    }
    return {*width, *height};
}

Vec3 vector_in(const std::string& option, const std::string& text)
{
    const auto value = three_numbers(text);
    if (!value) {
        refuse(option, text, "x,y,z");
    }
    return *value;
}

std::vector<int> shots_in(const std::string& option, const std::string& text)
{
    std::vector<int> shots;
    for (std::string_view part : pieces(text, ',')) {
        const auto value = exactly<int>(part);
        if (!value || *value < 1 || *value > 100'000 || (!shots.empty() && *value <= shots.back())) {
            refuse(option, text, "a growing list of whole numbers from 1 to 100000, such as 1,2,3,16");
        }
        shots.push_back(*value);
    }
    return shots;
}

std::pair<std::string, Rgb> emitter_in(const std::string& option, const std::string& text)
{
    const auto equals = text.rfind('=');
    const std::string wanted = "MATERIAL=W or MATERIAL=r,g,b, in W/m2 and not negative";
    if (equals == std::string::npos || equals == 0) {
        refuse(option, text, wanted);
    }
    const std::string value = text.substr(equals + 1);
    Rgb exitance{0.0};
    if (const auto grey = exactly<double>(value)) {
        exitance = Rgb(*grey);
    } else if (const auto bands = three_numbers(value)) {
        exitance = *bands;
    } else {
        refuse(option, text, wanted);
    }
    if (exitance.r < 0 || exitance.g < 0 || exitance.b < 0) {
        refuse(option, text, wanted);
    }
    return {text.substr(0, equals), exitance};
}

WhichCycle cycle_in(const std::string& option, const std::string& text)
{
    if (text == "first") {
        return {WhichCycle::Kind::first, 0};
    }
    if (text == "last") {
        return {WhichCycle::Kind::last, 0};
    }
    const auto number = exactly<int>(text);
    if (!number || *number < 0) {
        refuse(option, text, "a cycle's number, first or last");
    }
    return {WhichCycle::Kind::number, *number};
}

double number_in(const std::string& option, const std::string& text)
{
    const auto value = exactly<double>(text);
    if (!value) {
        refuse(option, text, "a number");
    }
    return *value;
}

double bytes_in(const std::string& option, const std::string& text)
{
    static const std::vector<std::pair<std::string_view, double>> units{
        {"KiB", 0x1p10}, {"MiB", 0x1p20}, {"GiB", 0x1p30}, {"TiB", 0x1p40}, {"kB", 1e3},  {"K", 0x1p10}, {"M", 0x1p20},
        {"G", 0x1p30},   {"T", 0x1p40},   {"MB", 1e6},     {"GB", 1e9},     {"TB", 1e12}, {"B", 1}};
    for (const auto& [unit, bytes] : units) {
        if (!text.ends_with(unit)) {
            continue;
        }
        const auto number = exactly<double>(std::string_view(text).substr(0, text.size() - unit.size()));
        if (number && *number > 0) {
            return *number * bytes;
        }
        break;
    }
    refuse(option, text, "a size such as 8G, 8GiB or 500MB");
}

double seconds_in(const std::string& option, const std::string& text)
{
    constexpr double longest = 1e9;
    static const std::vector<std::pair<std::string_view, double>> units{{"min", 60}, {"h", 3600}, {"s", 1}, {"", 1}};
    for (const auto& [unit, seconds] : units) {
        if (!text.ends_with(unit)) {
            continue;
        }
        const auto number = exactly<double>(std::string_view(text).substr(0, text.size() - unit.size()));
        if (number && *number > 0 && *number * seconds <= longest) {
            return *number * seconds;
        }
        break;
    }
    refuse(option, text, "a time such as 90s, 10min or 2h");
}

}  // namespace patchlight
