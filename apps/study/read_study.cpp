#include "apps/study/study_sections.h"
#include "apps/study/toml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace patchlight {

namespace {

const std::vector<std::string> top_names{"title",     "scene",   "unit",  "seed",    "options",  "vary",  "skip",
                                         "reference", "metrics", "gates", "compare", "pictures", "limits"};

/// Options that have no place in a study, and why.
const std::vector<std::pair<std::string, std::string>> refused_options{
    {"o", "each cell's folder is the study's to choose"},
    {"scene", "scenes are named at the top of the file: scene = [\"a.obj\", \"b.obj\"]"},
    {"json", "cells print nothing"},
    {"quiet", "cells print nothing"},
    {"config", "a study has its options in itself"},
    {"threads", "results don't depend on it: it is given on the command line"}};

void check_option(const TomlFile& toml, const TomlEntry& entry, const OptionNames& names)
{
    for (const auto& [name, reason] : refused_options)
        if (entry.name == name)
            toml.refuse(entry.place, fmt::format("\"{}\" is no option of a study: {}", entry.key, reason));
    if (std::ranges::find(names, entry.name) == names.end())
        toml.refuse_key(entry, names, "; patchlight solve --help lists the options");
}

std::vector<OptionText> options_in(const TomlFile& toml, const TomlEntry& section, const OptionNames& names)
{
    std::vector<OptionText> options;
    for (const TomlEntry& entry : toml.table(section)) {
        check_option(toml, entry, names);
        options.push_back(toml.option(entry));
    }
    return options;
}

bool has(const std::vector<OptionText>& options, std::string_view name)
{
    return std::ranges::find(options, name, &OptionText::name) != options.end();
}

void add_axes(const TomlFile& toml, const TomlEntry& section, const OptionNames& names, Study& study)
{
    for (const TomlEntry& entry : toml.table(section)) {
        check_option(toml, entry, names);
        study.axes.push_back({entry.name, toml.axis_values(entry)});
    }
}

void add_scenes(const TomlFile& toml, const TomlEntry& entry, Study& study)
{
    std::vector<OptionText> written;
    if (entry.value->is_array())
        written = toml.axis_values(entry);
    else
        written.push_back({"scene", toml.text(entry), entry.value_place()});
    for (const OptionText& scene : written) {
        study.scenes.push_back({"scene", beside(study.file, scene.value).string(), scene.place});
    }
    if (written.size() > 1) study.axes.insert(study.axes.begin(), StudyAxis{"scene", std::move(written)});
}

StudySkip skip_in(const TomlFile& toml, const std::vector<TomlEntry>& conditions, const Study& study)
{
    StudySkip skip;
    std::vector<std::string> names;
    std::ranges::transform(study.axes, std::back_inserter(names), &StudyAxis::name);
    for (const TomlEntry& entry : conditions) {
        const auto axis = std::ranges::find(study.axes, entry.name, &StudyAxis::name);
        if (axis == study.axes.end()) toml.refuse_key(entry, names, ": nothing in [vary] is called so");
        const OptionText wanted = toml.option(entry);
        if (std::ranges::find(axis->values, wanted.value, &OptionText::value) == axis->values.end()) {
            toml.refuse(entry.value_place(), fmt::format("{} is no value of \"{}\"", wanted.value, entry.key));
        }
        skip.all.push_back(wanted);
    }
    return skip;
}

bool is_numeric(const StudyAxis& axis)
{
    return std::ranges::all_of(axis.values, [](const OptionText& value) {
        double number = 0;
        const char* end = value.value.data() + value.value.size();
        return std::from_chars(value.value.data(), end, number).ptr == end;
    });
}

/// The last axis by which a solution gets better.
std::string usual_along(const Study& study)
{
    static const std::vector<std::string> names{"max-elements", "max-edge", "target-error", "vertex-rays", "rays"};
    std::string along;
    for (const StudyAxis& axis : study.axes)
        if (std::ranges::find(names, axis.name) != names.end() && is_numeric(axis)) along = axis.name;
    return along;
}

void read_metrics(const TomlFile& toml, const TomlEntry& section, Study& study)
{
    for (const TomlEntry& entry : toml.table(section)) {
        if (entry.name == "probes") {
            study.probes = beside(study.file, toml.text(entry));
        } else if (entry.name == "along") {
            study.along = toml.text(entry);
            std::ranges::replace(study.along, '_', '-');
            const auto axis = std::ranges::find(study.axes, study.along, &StudyAxis::name);
            if (axis == study.axes.end() || !is_numeric(*axis)) {
                toml.refuse(entry.value_place(), fmt::format("\"{}\" is no axis of numbers in [vary]", study.along));
            }
        } else {
            toml.refuse_key(entry, std::vector<std::string>{"along", "probes"}, "; there are along, probes");
        }
    }
}

void read_top(const TomlFile& toml, const TomlEntry& entry, const OptionNames& names, Study& study)
{
    if (entry.name == "title") {
        study.name = toml.text(entry);
    } else if (entry.name == "unit" || entry.name == "seed") {
        if (entry.value->is_array()) toml.refuse(entry.value_place(), "one for all; what varies stands in [vary]");
        study.options.push_back(toml.option(entry));
    } else if (entry.name == "options") {
        for (OptionText& option : options_in(toml, entry, names)) {
            if (has(study.options, option.name)) {
                toml.refuse(option.place, fmt::format("\"{}\" stands at the top, too", option.name));
            }
            study.options.push_back(std::move(option));
        }
    } else if (entry.name == "vary") {
        add_axes(toml, entry, names, study);
    } else if (entry.name == "reference") {
        study.reference = reference_in(toml, entry, study.file,
                                       [&](const TomlEntry& section) { return options_in(toml, section, names); });
    } else if (entry.name == "compare") {
        study.comparisons = comparisons_in(toml, entry);
    } else if (entry.name == "pictures") {
        study.pictures = pictures_in(toml, entry, study.file);
    } else if (entry.name == "limits") {
        study.limits = limits_in(toml, entry);
    }
}

/// Sections that speak of others.
void read_dependent(const TomlFile& toml, const TomlEntry& entry, Study& study)
{
    if (entry.name == "scene") {
        add_scenes(toml, entry, study);
    } else if (entry.name == "metrics") {
        read_metrics(toml, entry, study);
    } else if (entry.name == "skip") {
        for (const auto& conditions : toml.tables(entry)) {
            if (conditions.empty()) toml.refuse(entry.value_place(), "[[skip]] without a condition would skip all");
            study.skips.push_back(skip_in(toml, conditions, study));
        }
    }
}

}  // namespace

std::filesystem::path beside(const std::filesystem::path& file, const std::string& written)
{
    // Joined as it is: no link is followed, no ".." taken out.
    return file.parent_path() / written;
}

Study read_study(std::string_view text, const std::filesystem::path& file, const OptionNames& options)
{
    const TomlFile toml(text, file);
    Study study;
    study.file = file;
    study.name = file.stem().string();
    study.reference.kind = ReferenceKind::path_traced;
    const std::vector<TomlEntry> top = toml.top();
    for (const TomlEntry& entry : top) {
        if (std::ranges::find(top_names, entry.name) == top_names.end()) {
            const bool option = std::ranges::find(options, entry.name) != options.end();
            toml.refuse_key(entry, top_names, option ? ": options stand in [options]" : "");
        }
        read_top(toml, entry, options, study);
    }
    const auto scene = std::ranges::find(top, "scene", &TomlEntry::name);
    if (scene == top.end()) toml.refuse({}, "no scene; set scene = \"FILE.obj\" at the top");
    read_dependent(toml, *scene, study);
    study.along = usual_along(study);
    for (const TomlEntry& entry : top)
        if (entry.name != "scene") read_dependent(toml, entry, study);
    if (const auto gates = std::ranges::find(top, "gates", &TomlEntry::name); gates != top.end())
        study.gates = gates_in(toml, *gates, study);
    const auto is_pictures = [](const StudyAxis& axis) { return axis.name == "pictures"; };
    if (!has(study.options, "pictures") && std::ranges::none_of(study.axes, is_pictures))
        study.options.push_back({"pictures", "none", {}});
    return study;
}

std::vector<OptionText> read_configuration(std::string_view text, const std::filesystem::path& file,
                                           const OptionNames& options)
{
    const TomlFile toml(text, file);
    std::vector<OptionText> found;
    for (const TomlEntry& entry : toml.top()) {
        if (entry.name == "scene" || entry.name == "o")
            toml.refuse(entry.place, fmt::format("\"{}\" is given on the command line", entry.key));
        if (std::ranges::find(options, entry.name) == options.end())
            toml.refuse_key(entry, options, "; patchlight solve --help lists the options");
        found.push_back(toml.option(entry));
    }
    return found;
}

}  // namespace patchlight
