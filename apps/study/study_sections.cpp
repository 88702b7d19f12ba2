#include "apps/study/study_sections.h"

#include "apps/imaging/image.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <set>

namespace patchlight {

namespace {

using Names = std::vector<std::string>;

constexpr double any_number = 1e300;

/// An entry by its name; those that have none of `names` are refused.
void check_names(const TomlFile& toml, const std::vector<TomlEntry>& entries, const Names& names)
{
    for (const TomlEntry& entry : entries)
        if (std::ranges::find(names, entry.name) == names.end())
            toml.refuse_key(entry, names, fmt::format("; there are {}", fmt::join(names, ", ")));
}

const TomlEntry* find(const std::vector<TomlEntry>& entries, std::string_view name)
{
    const auto found = std::ranges::find(entries, name, &TomlEntry::name);
    return found == entries.end() ? nullptr : &*found;
}

/// The value of one of some words.
template <class Value>
Value one_of(const TomlFile& toml, const TomlEntry& entry, const std::vector<std::pair<std::string, Value>>& words)
{
    const std::string text = toml.text(entry);
    Names names;
    for (const auto& [word, value] : words) {
        if (word == text) return value;
        names.push_back(word);
    }
    toml.refuse(entry.value_place(),
                fmt::format("\"{}\" is \"{}\"; there are {}", entry.key, text, fmt::join(names, ", ")));
}

template <class Number>
bool all_of_is(std::string_view text, Number& number)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::pair<std::string, ReferenceKind>> reference_words()
{
    using enum ReferenceKind;
    std::vector<std::pair<std::string, ReferenceKind>> words;
    for (const ReferenceKind kind : {path_traced, solution, run, points, furnace, none})
        words.emplace_back(name_of(kind), kind);
    return words;
}

/// What a kind of reference is described by.
Names reference_names(ReferenceKind kind)
{
    switch (kind) {
    case ReferenceKind::path_traced:
        return {"kind", "points", "seen-from", "paths"};
    case ReferenceKind::solution:
        return {"kind", "points", "seen-from", "options"};
    case ReferenceKind::run:
        return {"kind", "points", "seen-from", "run"};
    case ReferenceKind::points:
        return {"kind", "file"};
    case ReferenceKind::furnace:
        return {"kind", "points"};
    case ReferenceKind::none:
        break;
    }
    return {"kind"};
}

/// "10min"; 90 alone is seconds.
double seconds_in(const TomlFile& toml, const TomlEntry& entry)
{
    constexpr double longest = 1e9;
    if (entry.value->is_number()) return toml.number(entry, 0, longest);
    const std::string text = toml.text(entry);
    static const std::vector<std::pair<std::string_view, double>> units{{"min", 60}, {"h", 3600}, {"s", 1}};
    for (const auto& [unit, seconds] : units) {
        if (!text.ends_with(unit)) continue;
        double number = 0;
        const bool good = all_of_is(std::string_view(text).substr(0, text.size() - unit.size()), number);
        // Not-a-number is between nothing.
        if (good && number > 0 && number * seconds <= longest) return number * seconds;
        break;
    }
    toml.refuse(entry.value_place(),
                fmt::format("\"{}\" is \"{}\", wanted is a time such as 90s, 10min or 2h", entry.key, text));
}

std::pair<int, int> size_in(const TomlFile& toml, const TomlEntry& entry)
{
    const std::string text = toml.text(entry);
    const std::size_t cross = text.find('x');
    int width = 0, height = 0;
    const bool numbers = cross != std::string::npos && all_of_is(std::string_view(text).substr(0, cross), width) &&
                         all_of_is(std::string_view(text).substr(cross + 1), height);
    const auto fits = [](int side) { return side >= 1 && side <= largest_picture_side; };
    if (!numbers || !fits(width) || !fits(height)) {
        toml.refuse(entry.value_place(), fmt::format("\"{}\" is \"{}\", wanted is WxH with sides from 1 to {}",
                                                     entry.key, text, largest_picture_side));
    }
    return {width, height};
}

}  // namespace

StudyReference reference_in(const TomlFile& toml, const TomlEntry& section, const std::filesystem::path& file,
                            const std::function<std::vector<OptionText>(const TomlEntry&)>& options_in)
{
    const std::vector<TomlEntry> entries = toml.table(section);
    StudyReference reference;
    reference.place = section.place;
    const TomlEntry* kind = find(entries, "kind");
    reference.kind = kind != nullptr ? one_of(toml, *kind, reference_words()) : ReferenceKind::path_traced;
    check_names(toml, entries, reference_names(reference.kind));
    if (const TomlEntry* e = find(entries, "points")) reference.points = toml.whole(*e, 1, 1'000'000);
    if (const TomlEntry* e = find(entries, "seen-from")) {
        reference.seen_from = toml.text(*e);
        if (reference.seen_from.ends_with(".json")) reference.seen_from = beside(file, reference.seen_from).string();
    }
    if (const TomlEntry* e = find(entries, "paths"))
        reference.paths = static_cast<std::uint32_t>(toml.whole(*e, 8, 100'000'000));
    if (const TomlEntry* e = find(entries, "options")) reference.options = options_in(*e);
    for (const char* name : {"run", "file"})
        if (const TomlEntry* e = find(entries, name)) reference.file = beside(file, toml.text(*e));
    if (reference.kind == ReferenceKind::solution && reference.options.empty()) {
        toml.refuse(section.place, "a solution that is no finer is no reference: say in [reference.options] what is");
    }
    if (reference.kind == ReferenceKind::run && reference.file.empty())
        toml.refuse(section.place, "the reference names no run = \"DIR\"");
    if (reference.kind == ReferenceKind::points && reference.file.empty())
        toml.refuse(section.place, "the reference names no file = \"POINTS.csv\"");
    return reference;
}

StudyGates gates_in(const TomlFile& toml, const TomlEntry& section, const Study& study)
{
    StudyGates gates;
    const std::vector<std::pair<std::string, std::optional<double> StudyGates::*>> known{
        {"min-rate", &StudyGates::min_rate},
        {"max-error", &StudyGates::max_error},
        {"max-energy-residual", &StudyGates::max_energy_residual},
        {"max-effectivity", &StudyGates::max_effectivity},
        {"min-effectivity", &StudyGates::min_effectivity}};
    Names names;
    std::ranges::transform(known, std::back_inserter(names), [](const auto& gate) { return gate.first; });
    const std::vector<TomlEntry> entries = toml.table(section);
    check_names(toml, entries, names);
    for (const TomlEntry& entry : entries) {
        const auto gate = std::ranges::find(names, entry.name) - names.begin();
        gates.*known[static_cast<std::size_t>(gate)].second = toml.number(entry, 0, any_number);
        if (entry.name == "min-rate" && study.along.empty()) {
            toml.refuse(entry.place, "a rate needs an axis along which the error falls: [metrics] along names it");
        }
        if (entry.name != "max-energy-residual" && study.reference.kind == ReferenceKind::none) {
            toml.refuse(entry.place, fmt::format("\"{}\" needs a reference to measure against", entry.key));
        }
    }
    if (gates.min_effectivity && gates.max_effectivity && *gates.min_effectivity > *gates.max_effectivity) {
        toml.refuse(section.place, "min_effectivity is above max_effectivity");
    }
    return gates;
}

std::vector<StudyComparison> comparisons_in(const TomlFile& toml, const TomlEntry& section)
{
    using At = StudyComparison::At;
    const std::vector<std::pair<std::string, At>> words{
        {"elements", At::elements}, {"seconds", At::seconds}, {"error", At::error}};
    std::vector<StudyComparison> comparisons;
    for (const auto& entries : toml.tables(section)) {
        check_names(toml, entries, {"at", "values"});
        const TomlEntry *at = find(entries, "at"), *values = find(entries, "values");
        if (at == nullptr || values == nullptr) toml.refuse(section.value_place(), "[[compare]] needs at and values");
        comparisons.push_back({one_of(toml, *at, words), toml.growing_numbers(*values)});
    }
    return comparisons;
}

StudyPictures pictures_in(const TomlFile& toml, const TomlEntry& section, const std::filesystem::path& file)
{
    StudyPictures pictures;
    const std::vector<TomlEntry> entries = toml.table(section);
    check_names(toml, entries, {"views", "exposure", "size"});
    if (const TomlEntry* e = find(entries, "views")) {
        std::set<std::string> seen;
        for (const std::string& view : toml.texts(*e)) {
            if (!seen.insert(view).second) toml.refuse(e->value_place(), fmt::format("view \"{}\" twice", view));
            pictures.views.push_back({view.ends_with(".json") ? beside(file, view).string() : view});
        }
    } else {
        pictures.views.emplace_back();
    }
    if (const TomlEntry* e = find(entries, "exposure"); e != nullptr && !e->value->is_string()) {
        pictures.exposure = toml.number(*e, -100, 100);
    } else if (e != nullptr && toml.text(*e) != "auto") {
        toml.refuse(e->value_place(), fmt::format("\"{}\" is to be \"auto\" or a number of stops", e->key));
    }
    if (const TomlEntry* e = find(entries, "size")) pictures.size = size_in(toml, *e);
    return pictures;
}

StudyLimits limits_in(const TomlFile& toml, const TomlEntry& section)
{
    constexpr std::int64_t most_cells = 100'000;
    StudyLimits limits;
    const std::vector<TomlEntry> entries = toml.table(section);
    check_names(toml, entries, {"time", "memory", "cells"});
    if (const TomlEntry* e = find(entries, "time")) limits.seconds = seconds_in(toml, *e);
    if (const TomlEntry* e = find(entries, "memory")) {
        limits.memory = toml.text(*e);
        limits.memory_place = e->value_place();
    }
    if (const TomlEntry* e = find(entries, "cells"))
        limits.cells = static_cast<std::size_t>(toml.whole(*e, 1, most_cells));
    return limits;
}

}  // namespace patchlight
