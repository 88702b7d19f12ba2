#pragma once

#include "apps/python/arrays.h"
#include "apps/run/run_options.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace patchlight {

/// The numbers that an option takes, both ends included unless `above`.
struct OptionRange {
    double low = 0, high = 0;
    bool above = false;  ///< low itself isn't taken
};

/// An option struct as a Python class: its members by name, set by keywords, shown by repr. Words stand for modes.
/// Values out of range and unknown words are ValueErrors, unknown names TypeErrors.
template <class Options>
class OptionClass {
public:
    OptionClass(pybind11::module_& module, const char* name, const char* doc)
        : name_(name), names_(std::make_shared<std::vector<std::string>>()), class_(module, name, doc)
    {
        class_.def(pybind11::init([name = name_, names = names_](const pybind11::kwargs& given) {
            Options made;
            const pybind11::object self = pybind11::cast(&made, pybind11::return_value_policy::reference);
            for (const auto& [key, value] : given) {
                const auto word = key.template cast<std::string>();
                if (std::find(names->begin(), names->end(), word) == names->end())
                    throw pybind11::type_error(name + " has no option \"" + word + "\"");
                pybind11::setattr(self, key, value);
            }
            return made;
        }));
        class_.def("__repr__", [name = name_, names = names_](const pybind11::object& self) {
            std::string text;
            for (const std::string& one : *names)
                text += (text.empty() ? "" : ", ") + one + "=" +
                        pybind11::repr(self.attr(one.c_str())).template cast<std::string>();
            return name + "(" + text + ")";
        });
    }

    template <class T>
    OptionClass& value(const char* name, T Options::*member, const char* doc)
    {
        names_->emplace_back(name);
        class_.def_readwrite(name, member, doc);
        return *this;
    }

    template <class Number>
    OptionClass& number(const char* name, Number Options::*member, OptionRange range, const char* doc)
    {
        names_->emplace_back(name);
        class_.def_property(
            name, [member](const Options& self) { return self.*member; },
            [member, range, full = name_ + "." + name](Options& self, Number given) {
                const auto x = static_cast<double>(given);
                if (!(range.above ? x > range.low : x >= range.low) || !(x <= range.high))
                    throw pybind11::value_error(fmt::format("{} = {} is not in {}{:g}, {:g}]", full, given,
                                                            range.above ? "(" : "[", range.low, range.high));
                self.*member = given;
            },
            doc);
        return *this;
    }

    template <class Mode>
    OptionClass& word(const char* name, Mode Options::*member, const ModeNames<Mode>& (*words)(), const char* doc)
    {
        names_->emplace_back(name);
        class_.def_property(
            name, [member, words](const Options& self) { return name_of(words(), self.*member); },
            [member, words, full = name_ + "." + name](Options& self, const std::string& given) {
                std::string known;
                for (const auto& [one, mode] : words()) {
                    if (one == given) {
                        self.*member = mode;
                        return;
                    }
                    known += (known.empty() ? "" : ", ") + one;
                }
                throw pybind11::value_error(fmt::format("{} = \"{}\" is none of {}", full, given, known));
            },
            doc);
        return *this;
    }

    /// What Python sees otherwise.
    template <class Get, class Set>
    OptionClass& property(const char* name, const Get& get, const Set& set, const char* doc)
    {
        names_->emplace_back(name);
        class_.def_property(name, get, set, doc);
        return *this;
    }

private:
    std::string name_;
    std::shared_ptr<std::vector<std::string>> names_;
    pybind11::class_<Options> class_;
};

}  // namespace patchlight
