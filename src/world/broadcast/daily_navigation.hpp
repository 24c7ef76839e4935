/// The merged navigation file of a day: its name, its place in the cache, and whether a file is that of the day.
/// Mirrors that publish such files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// The first instant of a day of the calendar of GPS time, at which daily files are cut.
GpsTime day_of(GpsTime time);
/// "2023-01-01"
std::string day_text(GpsTime day);
/// The reverse. Fails with `usage` and a sentence that quotes the text.
Result<GpsTime> parse_day(std::string_view text);

/// "BRDC_20230010000_01D_MN.rnx.gz": as RINEX 3.04, appendix 1, names such files, without the country and source of the
/// one who merged it.
std::string daily_navigation_name(GpsTime day);
/// Where the file of a day is kept.
/// @param cache folder of the program's cache
std::filesystem::path cached_navigation_path(const std::filesystem::path& cache, GpsTime day);

/// Who publishes the file, and at which addresses; the first that has the file serves.
struct NavigationMirror {
    std::string name;
    std::vector<std::string> addresses;  ///< with {year}, {yy} and {doy} (three digits) where those of the day go
};

/// Fails with `usage` unless a text is an http or https address whose braces are those of NavigationMirror.
Result<void> check_address_pattern(std::string_view pattern);
/// The address of a day. @param pattern that check_address_pattern() takes
std::string address_of_day(std::string_view pattern, GpsTime day);
/// The mirrors that somebody names, in this order: those of the list by name, others by an address pattern. Fails with
/// `usage`.
Result<std::vector<NavigationMirror>> chosen_mirrors(std::span<const NavigationMirror> known,
                                                     std::span<const std::string> wanted);

/// How many GPS satellites a file has orbits of, within an hour of each even hour of the day: as many as the system has
/// slots (GPS SPS Performance Standard, 5th edition, 2020, section 3.2).
inline constexpr std::size_t least_daily_satellites = 24;
/// Bytes of a packed file beyond which it is none; those of 2024 have about one million.
inline constexpr std::size_t most_daily_bytes = std::size_t{64} << 20;

/// What the file of a day holds.
struct DailyNavigation {
    std::size_t records = 0, satellites = 0;
    std::string systems;  ///< "gps, galileo"
    GpsTime until;        ///< up to then it has orbits of least_daily_satellites, as it has from the day's begin on
    bool whole = false;   ///< that is the whole day
};

/// Looks into a packed navigation file: it unpacks without damage, is a navigation file, of this day, and has orbits of
/// enough satellites from the begin of the day on. Fails with `input` and one sentence.
/// @param name of the file, for messages
Result<DailyNavigation> check_daily_navigation(std::string_view packed, const std::string& name, GpsTime day);

}  // namespace skyloop::inline world
