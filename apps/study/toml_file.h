#pragma once

#include "apps/study/study.h"

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// A key of a table and its value.
struct TomlEntry {
    std::string key;   ///< as written
    std::string name;  ///< as the command line has it: dashes for underscores
    TextPlace place;   ///< of the key
    const toml::node* value = nullptr;

    TextPlace value_place() const;
};

/// A TOML file while it is read: what it says, and messages that begin with the place. All functions throw StudyError.
class TomlFile {
public:
    /// Refuses what isn't TOML or UTF-8, is over a megabyte, or is nested deeper than any study.
    TomlFile(std::string_view text, const std::filesystem::path& file);

    [[noreturn]] void refuse(const TextPlace& place, const std::string& cause) const;
    /// As `unknown key "max_egde", did you mean "max_edge"?`; `names` with dashes. Where none is near, `instead` goes
    /// on.
    [[noreturn]] void refuse_key(const TomlEntry& entry, std::span<const std::string> names,
                                 const std::string& instead) const;

    std::vector<TomlEntry> top() const { return entries(root_); }
    /// In the file's order; a name twice, with a dash and with an underscore, is refused.
    std::vector<TomlEntry> entries(const toml::table& table) const;

    /// A table in the place of a value.
    std::vector<TomlEntry> table(const TomlEntry& entry) const;
    /// `[[name]]`, one or many.
    std::vector<std::vector<TomlEntry>> tables(const TomlEntry& entry) const;

    /// A text without control characters, not empty.
    std::string text(const TomlEntry& entry) const;
    double number(const TomlEntry& entry, double low, double high) const;
    std::int64_t whole(const TomlEntry& entry, std::int64_t low, std::int64_t high) const;
    /// Growing numbers above 0, one at least.
    std::vector<double> growing_numbers(const TomlEntry& entry) const;
    std::vector<std::string> texts(const TomlEntry& entry) const;

    /// An option's value as a word; an array becomes numbers joined by commas, or texts joined by line feeds.
    OptionText option(const TomlEntry& entry) const;
    /// Each value of an axis, one at least, none twice.
    std::vector<OptionText> axis_values(const TomlEntry& entry) const;

private:
    const toml::array& array(const TomlEntry& entry, const std::string& wanted) const;
    std::string word(const toml::node& value, const std::string& key) const;

    std::filesystem::path file_;
    toml::table root_;
};

}  // namespace patchlight
