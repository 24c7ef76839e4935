/// JSON as this folder writes it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace skyloop {

/// Members stay in the order in which they are set.
using Json = nlohmann::ordered_json;

/// One line; bytes that are no UTF-8 become replacement characters, numbers that are none null.
inline std::string json_text(const Json& value) {
    return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace skyloop
