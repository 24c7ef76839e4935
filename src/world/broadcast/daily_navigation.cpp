#include "world/broadcast/daily_navigation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "base/core/archive.hpp"
#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::inline world {
namespace {

using std::chrono::hours;

constexpr Nanoseconds whole_day = hours(24);
// GPS records come with a toe every two hours (IS-GPS-200, 20.3.4.4). Each of a single station's satellites has one in
// some of them, of all stations' in every.
constexpr Nanoseconds mark_step = hours(2);
constexpr Seconds mark_reach{3600};

std::string day_of_year_text(GpsTime day) {
    return fmt::format("{:03}", static_cast<int>(day_of_year(gps_calendar(day))));
}

// What a pattern's braces may hold, and what stands there for a day.
std::array<std::pair<std::string_view, std::string>, 3> placeholders(GpsTime day) {
    const int year = gps_calendar(day).year;
    return {{{"{year}", fmt::format("{:04}", year)},
             {"{yy}", fmt::format("{:02}", year % 100)},
             {"{doy}", day_of_year_text(day)}}};
}

// The day that most records are of.
GpsTime main_day(const std::vector<Ephemeris>& records) {
    std::map<GpsTime, std::size_t> counts;
    for (const Ephemeris& record : records)
        ++counts[day_of(toe_of(record))];
    return std::max_element(counts.begin(), counts.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

std::size_t gps_satellites_at(const NavigationData& data, GpsTime time) {
    const std::vector<SatelliteId> satellites = data.satellites();
    return static_cast<std::size_t>(std::count_if(satellites.begin(), satellites.end(), [&](SatelliteId id) {
        return id.constellation == Constellation::gps && data.ephemeris(id, time).has_value();
    }));
}

// As much of an unknown file as shows what it is.
std::string beginning_of(std::string_view bytes) {
    std::string text(bytes.substr(0, 20));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '.');
    return text;
}

Result<NavigationFile> unpacked_navigation(std::string_view packed, const std::string& name) {
    if (!packed.starts_with("\x1f\x8b"))
        return fail(ErrorCode::input,
                    fmt::format("{}: found '{}'; expected a file packed by gzip", name, beginning_of(packed)));
    const auto text = uncompressed(std::string(packed), name, max_text_file_size);
    if (!text) return fail(text.error());
    return read_navigation(*text, name);
}

}  // namespace

GpsTime day_of(GpsTime time) { return std::chrono::floor<std::chrono::days>(time); }

std::string day_text(GpsTime day) { return format_utc(gps_calendar(day), 0).substr(0, 10); }

Result<GpsTime> parse_day(std::string_view text) {
    const auto day = text.size() == 10 ? parse_instant(text) : fail(ErrorCode::usage, "");
    if (!day) return fail(ErrorCode::usage, fmt::format("'{}'; expected a day such as 2023-01-01", text));
    return gps_calendar_time(day->year, day->month, day->day, 0, 0, 0);
}

std::string daily_navigation_name(GpsTime day) {
    return fmt::format("BRDC_{:04}{}0000_01D_MN.rnx.gz", gps_calendar(day).year, day_of_year_text(day));
}

std::filesystem::path cached_navigation_path(const std::filesystem::path& cache, GpsTime day) {
    return cache / "navigation" / daily_navigation_name(day);
}

Result<void> check_address_pattern(std::string_view pattern) {
    std::string address = address_of_day(pattern, GpsTime{});
    const bool web = address.starts_with("https://") || address.starts_with("http://");
    const bool plain = std::all_of(address.begin(), address.end(), [](char c) { return c > ' ' && c <= '~'; });
    if (web && plain && address.find_first_of("{}") == std::string::npos) return {};
    return fail(ErrorCode::usage,
                fmt::format("'{}'; expected an address that begins with https:// or http://, with {{year}}, {{yy}} and "
                            "{{doy}} where those of the day go",
                            pattern));
}

std::string address_of_day(std::string_view pattern, GpsTime day) {
    std::string address(pattern);
    for (const auto& [mark, text] : placeholders(day))
        for (std::size_t at = address.find(mark); at != std::string::npos; at = address.find(mark, at + text.size()))
            address.replace(at, mark.size(), text);
    return address;
}

Result<std::vector<NavigationMirror>> chosen_mirrors(std::span<const NavigationMirror> known,
                                                     std::span<const std::string> wanted) {
    std::vector<NavigationMirror> chosen;
    for (const std::string& text : wanted) {
        const auto named =
            std::find_if(known.begin(), known.end(), [&](const NavigationMirror& m) { return m.name == text; });
        if (named != known.end()) {
            chosen.push_back(*named);
            continue;
        }
        if (text.find(':') == std::string::npos) {
            std::vector<std::string_view> names;
            for (const NavigationMirror& mirror : known)
                names.push_back(mirror.name);
            return fail(ErrorCode::usage, fmt::format("'{}'; expected {} or an address{}", text, fmt::join(names, ", "),
                                                      did_you_mean(text, names)));
        }
        if (const auto checked = check_address_pattern(text); !checked) return fail(checked.error());
        chosen.push_back({text, {text}});
    }
    return chosen;
}

Result<DailyNavigation> check_daily_navigation(std::string_view packed, const std::string& name, GpsTime day) {
    const auto file = unpacked_navigation(packed, name);
    if (!file) return fail(file.error());
    if (const GpsTime found = main_day(file->records); found != day)
        return fail(ErrorCode::input,
                    fmt::format("{}: its records are of {}; expected {}", name, day_text(found), day_text(day)));
    const NavigationData data(file->records, {}, name, {EphemerisRule::nearest, mark_reach});
    DailyNavigation result{file->records.size(), data.satellites().size(), {}, day, true};
    for (GpsTime mark = day; mark < day + whole_day && result.whole; mark += mark_step) {
        const std::size_t satellites = gps_satellites_at(data, mark);
        if (mark == day && satellites < least_daily_satellites)
            return fail(ErrorCode::input, fmt::format("{}: has orbits of {} GPS satellites at 00:00; expected at least "
                                                      "{}",
                                                      name, satellites, least_daily_satellites));
        result.whole = satellites >= least_daily_satellites;
        if (result.whole) result.until = mark + mark_step;
    }
    std::vector<std::string_view> systems;
    for (const auto& [system, count] : file->counts())
        systems.push_back(constellation_name(system));
    result.systems = fmt::format("{}", fmt::join(systems, ", "));
    return result;
}

}  // namespace skyloop::inline world
