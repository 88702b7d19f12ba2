#pragma once

#include <nlohmann/json_fwd.hpp>

#include <concepts>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// A whole number out of JSON. Throws std::invalid_argument for anything else and for what T can't hold: JSON's own
/// getter turns 1.5, −1 and 1e99 into whatever fits.
template <std::integral T, class Json>
T whole_number_in(const Json& json)
{
    if (json.is_number_unsigned()) {
        const auto number = json.template get<typename Json::number_unsigned_t>();
        if (std::in_range<T>(number)) return static_cast<T>(number);
    } else if (json.is_number_integer()) {
        const auto number = json.template get<typename Json::number_integer_t>();
        if (std::in_range<T>(number)) return static_cast<T>(number);
    }
    throw std::invalid_argument(json.dump(-1, ' ', false, Json::error_handler_t::replace) +
                                " is not a whole number of its kind");
}

/// A list of them.
template <std::integral T, class Json>
std::vector<T> whole_numbers_in(const Json& json)
{
    if (!json.is_array()) throw std::invalid_argument("instead of a list there is a " + std::string(json.type_name()));
    std::vector<T> numbers;
    for (const Json& one : json) numbers.push_back(whole_number_in<T>(one));
    return numbers;
}

}  // namespace patchlight
