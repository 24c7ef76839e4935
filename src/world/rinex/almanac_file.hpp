/// YUMA and SEM almanacs of GPS.
#pragma once

#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// True for a text that begins as a YUMA or SEM almanac does.
bool is_almanac(std::string_view text);

/// Reads a YUMA or SEM almanac (the forms of the U.S. Coast Guard Navigation Center): records of
/// NavigationMessage::almanac without harmonic terms, toe and toc at the time of applicability. PRNs from 193 on are
/// QZSS. Fails with `input` at the first line that is wrong or missing: an almanac is used whole or not at all.
/// @param name of the file, for messages
/// @param near an instant from which the almanac lies less than ten years: its week may be reduced modulo 1024
Result<std::vector<KeplerEphemeris>> read_almanac(std::string_view text, std::string_view name, GpsTime near);

}  // namespace skyloop::inline world
