/// The header of a RINEX navigation file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "fields.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::inline world::rinex {

/// What the header says that a reader of orbits needs.
struct NavigationHeader {
    double version = 0;
    Constellation system = Constellation::gps;  ///< of all records of a version 2 file
    BroadcastIonosphere ionosphere;
    std::optional<int> leap_seconds;
    std::vector<std::string> warnings;
    [[nodiscard]] int major() const { return static_cast<int>(version); }
};

/// Reads up to END OF HEADER. Fails with `input` for other kinds of file, other versions, or without an end.
Result<NavigationHeader> read_header(LineReader& lines, std::string_view name);

}  // namespace skyloop::inline world::rinex
