/// JSON for the rooms that read or write it: nlohmann/json behind one header.
#pragma once

#include <concepts>
#include <nlohmann/json.hpp>
#include <string>

namespace skyloop::inline base {

/// What is written: members stay in the order in which they were put.
using Json = nlohmann::ordered_json;
/// What was read: members are found by their names, however many there are.
using JsonData = nlohmann::json;

/// The text; bytes that are no UTF-8 become replacement characters, numbers that are none null.
/// @param indent spaces a level; below 0 all on one line
inline std::string json_text(const Json& value, int indent = -1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}
template <std::same_as<JsonData> Data>
std::string json_text(const Data& value) {
    return value.dump(-1, ' ', false, Data::error_handler_t::replace);
}

}  // namespace skyloop::inline base
