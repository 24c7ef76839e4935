/// Observation files made of invented numbers, for tests that bend them.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace skyloop::test {

/// A field as F14.3 and two digits write it.
inline std::string observed(double value, char lock = ' ', char strength = ' ') {
    return fmt::format("{:14.3f}{}{}", value, lock, strength);
}
inline std::string not_observed() { return std::string(16, ' '); }

inline std::string label_line(std::string_view content, std::string_view label) {
    return fmt::format("{:<60}{}\n", content, label);
}

/// A header with the given lines between its version and its end.
inline std::string observation_header(std::string_view version, std::string_view more, char system = 'M') {
    return label_line(fmt::format("{:>9}           OBSERVATION DATA    {}", version, system), "RINEX VERSION / TYPE") +
           std::string(more) + label_line("", "END OF HEADER");
}

inline std::string types_line(std::string_view types) { return label_line(types, "SYS / # / OBS TYPES"); }
inline std::string types_line_2(std::string_view types) { return label_line(types, "# / TYPES OF OBSERV"); }

/// An epoch line of version 3 on 2024-03-05 at 12:00.
inline std::string epoch_line(double second, int count, int flag = 0) {
    return fmt::format("> 2024 03 05 12 00{:11.7f}  {}{:3}\n", second, flag, count);
}
/// The same of version 2, with the list of satellites.
inline std::string epoch_line_2(double second, int count, std::string_view satellites, int flag = 0) {
    return fmt::format(" 24  3  5 12  0{:11.7f}  {}{:3}{}\n", second, flag, count, satellites);
}

}  // namespace skyloop::test
