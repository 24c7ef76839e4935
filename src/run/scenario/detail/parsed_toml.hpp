/// TOML texts to tables, of bounded depth.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <string_view>

namespace skyloop {

/// How many parts a key or header has at most; with one in whose inline table it stands, they count together.
inline constexpr std::size_t most_key_parts = 256;

/// toml::parse() for texts from anywhere: what it does with the tables of a dotted key takes stack for each part.
/// @param file its name, for the places in its errors
/// Throws toml::parse_error, for a key of more than most_key_parts, too.
toml::table parsed_toml(std::string_view text, std::string_view file = {});

}  // namespace skyloop
