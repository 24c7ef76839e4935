/// JSON as this folder writes it.
/// Values and tables of parameters as JSON.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/core/json.hpp"
#include "base/core/result.hpp"
#include "run/fault/command.hpp"
#include "run/fault/parameters.hpp"

namespace skyloop::inline run {

/// The list of what `make` makes of each item.
template <class Items, class Make>
Json json_list(const Items& items, const Make& make) {
    Json list = Json::array();
    for (const auto& item : items)
        list.push_back(make(item));
    return list;
}

/// The members of the one object that `text` is. Fails with `input` for anything else, for members that stand there
/// twice, and for values that no parameter takes.
Result<ParameterMap> parameters_from_json(std::string_view text);

Json to_json(const ParameterValue& value);
Json to_json(const ParameterSpec& spec);
/// The JSON Schema of a parameter.
Json schema_of(const ParameterSpec& spec);

}  // namespace skyloop::inline run
