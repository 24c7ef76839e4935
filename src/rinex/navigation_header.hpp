/// The header of a RINEX navigation file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fields.hpp"
#include "skyloop/base/result.hpp"
#include "skyloop/gnss/navigation_source.hpp"

namespace skyloop::rinex {

/// What the header says that a reader of GPS orbits needs.
struct NavigationHeader {
    double version = 0;
    std::optional<KlobucharCoefficients> klobuchar;
    std::optional<int> leap_seconds;
    std::vector<std::string> warnings;
    [[nodiscard]] int major() const { return static_cast<int>(version); }
};

/// Reads up to END OF HEADER. Fails with `input` for other kinds of file, other systems, other versions, or without an
/// end.
Result<NavigationHeader> read_header(LineReader& lines, std::string_view name);

}  // namespace skyloop::rinex
