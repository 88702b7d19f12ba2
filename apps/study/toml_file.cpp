#include "apps/study/toml_file.h"

#include "apps/run/nearest_names.h"
#include "apps/study/deep_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <set>
#include <system_error>
#include <tuple>

namespace patchlight {

namespace {

constexpr std::size_t largest_file = 1'000'000;

TextPlace place_of(const toml::source_region& region)
{
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string_view kind_of(const toml::node& value)
{
    switch (value.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "a list";
    case toml::node_type::string:
        return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    default:
        return "a date or time";
    }
}

std::string too_large(const std::filesystem::path& file)
{
    return fmt::format("{}: more than {} bytes, too many for such a file", file.string(), largest_file);
}

}  // namespace

std::string text_of_study(const std::filesystem::path& file)
{
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    std::string text(largest_file + 1, '\0');
    if (!in.read(text.data(), static_cast<std::streamsize>(text.size())) && !in.eof()) {
        const std::string reason = std::generic_category().message(errno != 0 ? errno : EIO);
        throw StudyError(fmt::format("{}: {}", file.string(), reason));
    }
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest_file) throw StudyError(too_large(file));
    return text;
}

TextPlace TomlEntry::value_place() const
{
    return place_of(value->source());
}

void TomlFile::refuse(const TextPlace& place, const std::string& cause) const
{
    const std::string where = place.line > 0 ? fmt::format(":{}:{}", place.line, place.column) : "";
    throw StudyError(fmt::format("{}{}: {}", file_.string(), where, cause));
}

TomlFile::TomlFile(std::string_view text, const std::filesystem::path& file) : file_(file)
{
    if (text.size() > largest_file) throw StudyError(too_large(file));
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
        refuse({}, fmt::format("not a text: byte {} is zero", zero + 1));
    }
    if (const TextPlace deep = place_of_deep_key(text); deep.line > 0) {
        refuse(deep, "a key of so many parts is no study's");
    }
    try {
        root_ = toml::parse(text, file.string());
    } catch (const toml::parse_error& error) {
        std::string cause(error.description());
        std::ranges::replace_if(
            cause, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
        refuse(place_of(error.source()), "not TOML: " + cause);
    }
}

void TomlFile::refuse_key(const TomlEntry& entry, std::span<const std::string> names, const std::string& instead) const
{
    std::vector<std::string> written(names.begin(), names.end());
    // In the manner of the one who asks.
    if (entry.key.find('-') == std::string::npos)
        for (std::string& name : written) std::ranges::replace(name, '-', '_');
    const std::string meant = did_you_mean(entry.key, written);
    refuse(entry.place, fmt::format("unknown key \"{}\"{}", entry.key, meant.empty() ? instead : meant));
}

std::vector<TomlEntry> TomlFile::entries(const toml::table& table) const
{
    std::vector<TomlEntry> found;
    for (const auto& [key, value] : table) {
        TomlEntry entry{std::string(key.str()), std::string(key.str()), place_of(key.source()), &value};
        std::ranges::replace(entry.name, '_', '-');
        found.push_back(std::move(entry));
    }
    std::ranges::sort(found, {}, [](const TomlEntry& e) { return std::tuple(e.place.line, e.place.column); });
    std::set<std::string> names;
    for (const TomlEntry& entry : found)
        if (!names.insert(entry.name).second) refuse(entry.place, fmt::format("\"{}\" stands there twice", entry.key));
    return found;
}

std::vector<TomlEntry> TomlFile::table(const TomlEntry& entry) const
{
    const toml::table* table = entry.value->as_table();
    if (table == nullptr) {
        refuse(entry.value_place(),
               fmt::format("\"{0}\" is {1}, wanted is a table: [{0}]", entry.key, kind_of(*entry.value)));
    }
    return entries(*table);
}

std::vector<std::vector<TomlEntry>> TomlFile::tables(const TomlEntry& entry) const
{
    if (entry.value->is_table()) return {table(entry)};
    std::vector<std::vector<TomlEntry>> found;
    for (const toml::node& one : array(entry, fmt::format("tables: [[{}]]", entry.key))) {
        if (!one.is_table()) {
            refuse(place_of(one.source()),
                   fmt::format("\"{0}\" holds {1}, wanted are tables: [[{0}]]", entry.key, kind_of(one)));
        }
        found.push_back(entries(*one.as_table()));
    }
    return found;
}

std::string TomlFile::word(const toml::node& value, const std::string& key) const
{
    const auto wrong = [&](const std::string& cause) { refuse(place_of(value.source()), cause); };
    if (const auto* text = value.as_string()) {
        const std::string& word = text->get();
        if (word.empty()) wrong(fmt::format("\"{}\" is empty", key));
        if (std::ranges::any_of(word, [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
            wrong(fmt::format("\"{}\" holds a control character", key));
        }
        return word;
    }
    if (const auto* whole = value.as_integer()) return fmt::format("{}", whole->get());
    if (const auto* real = value.as_floating_point()) {
        if (!std::isfinite(real->get())) wrong(fmt::format("\"{}\" is not finite", key));
        return fmt::format("{}", real->get());
    }
    if (const auto* flag = value.as_boolean()) return flag->get() ? "true" : "false";
    wrong(fmt::format("\"{}\" is {}, wanted is a text, a number, true or false", key, kind_of(value)));
    return {};
}

std::string TomlFile::text(const TomlEntry& entry) const
{
    if (!entry.value->is_string()) {
        refuse(entry.value_place(), fmt::format("\"{}\" is {}, wanted is a text", entry.key, kind_of(*entry.value)));
    }
    return word(*entry.value, entry.key);
}

double TomlFile::number(const TomlEntry& entry, double low, double high) const
{
    const auto value = entry.value->is_number() ? entry.value->value<double>() : std::nullopt;
    // Not-a-number is between nothing.
    if (!value || !(*value >= low && *value <= high)) {
        refuse(entry.value_place(), fmt::format("\"{}\" is to be a number from {} to {}", entry.key, low, high));
    }
    return *value;
}

std::int64_t TomlFile::whole(const TomlEntry& entry, std::int64_t low, std::int64_t high) const
{
    const auto* value = entry.value->as_integer();
    if (value == nullptr || value->get() < low || value->get() > high) {
        refuse(entry.value_place(), fmt::format("\"{}\" is to be a whole number from {} to {}", entry.key, low, high));
    }
    return value->get();
}

const toml::array& TomlFile::array(const TomlEntry& entry, const std::string& wanted) const
{
    const toml::array* list = entry.value->as_array();
    if (list == nullptr) {
        refuse(entry.value_place(),
               fmt::format("\"{}\" is {}, wanted are {}", entry.key, kind_of(*entry.value), wanted));
    }
    if (list->empty()) refuse(entry.value_place(), fmt::format("\"{}\" is an empty list", entry.key));
    return *list;
}

std::vector<double> TomlFile::growing_numbers(const TomlEntry& entry) const
{
    std::vector<double> values;
    for (const toml::node& one : array(entry, "numbers in brackets")) {
        const auto value = one.is_number() ? one.value<double>() : std::nullopt;
        if (!value || !std::isfinite(*value) || *value <= (values.empty() ? 0 : values.back())) {
            refuse(place_of(one.source()), fmt::format("\"{}\" is to be a growing list of numbers above 0", entry.key));
        }
        values.push_back(*value);
    }
    return values;
}

std::vector<std::string> TomlFile::texts(const TomlEntry& entry) const
{
    if (entry.value->is_string()) return {text(entry)};
    std::vector<std::string> found;
    for (const toml::node& one : array(entry, "texts in brackets")) {
        if (!one.is_string()) {
            refuse(place_of(one.source()), fmt::format("\"{}\" holds {}, wanted are texts", entry.key, kind_of(one)));
        }
        found.push_back(word(one, entry.key));
    }
    return found;
}

OptionText TomlFile::option(const TomlEntry& entry) const
{
    OptionText option{entry.name, {}, entry.place};
    if (!entry.value->is_array()) {
        option.value = word(*entry.value, entry.key);
        return option;
    }
    for (const toml::node& one : array(entry, "values")) {
        if (one.is_array()) refuse(place_of(one.source()), fmt::format("\"{}\" is a list of lists", entry.key));
        if (!option.value.empty()) option.value += one.is_string() ? '\n' : ',';
        option.value += word(one, entry.key);
    }
    return option;
}

std::vector<OptionText> TomlFile::axis_values(const TomlEntry& entry) const
{
    std::vector<OptionText> values;
    std::set<std::string> seen;
    for (const toml::node& one : array(entry, "its values in brackets: an axis")) {
        const TextPlace place = place_of(one.source());
        if (one.is_array()) {
            refuse(place, fmt::format("\"{}\" is a list of lists: an axis has single values", entry.key));
        }
        const auto* text = one.as_string();
        const bool left_out = entry.name != "scene" && text != nullptr && text->get().empty();
        values.push_back({entry.name, left_out ? std::string() : word(one, entry.key), place});
        if (!seen.insert(values.back().value).second) {
            refuse(place, fmt::format("\"{}\" has the value {} twice", entry.key, values.back().value));
        }
    }
    return values;
}

}  // namespace patchlight
