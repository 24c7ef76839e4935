/// Configuration items of receivers by their names, as boards and scenarios set them.
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "table_reader.hpp"

namespace skyloop {

/// "CFG-RATE-MEAS" and all others.
std::vector<std::string_view> config_item_names();

/// Reads each key of the table as the value of the item that it names: a whole number within the item's bytes, a number
/// for R8, true and false or 0 and 1 for L. A name that no item has is a mistake.
/// @param other a key that is no item, and not read
/// @return raw values by the items' ids
std::map<std::uint32_t, std::uint64_t> read_config_items(TableReader& config, std::string_view other = {});

}  // namespace skyloop
