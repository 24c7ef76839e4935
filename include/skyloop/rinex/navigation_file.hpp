/// RINEX navigation files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/gnss/ephemeris.hpp"
#include "skyloop/gnss/navigation_source.hpp"

namespace skyloop {

/// How many records of a file were passed over, by reason.
struct SkippedRecords {
    std::map<Constellation, int> other_systems;  ///< of systems other than GPS and QZSS
    std::map<std::string, int, std::less<>>
        messages;        ///< version 4: blocks that are not LNAV ephemerides: "CNAV", "STO", …
    int defective = 0;   ///< a field is no number, is needed and blank, or lies outside what a satellite can broadcast
    int incomplete = 0;  ///< lines are missing
};

/// What a navigation file holds: the LNAV ephemerides of GPS and QZSS, and what its header says.
struct NavigationFile {
    double version = 0;
    std::vector<KeplerEphemeris> records;            ///< in the order of the file, repetitions included
    std::optional<KlobucharCoefficients> klobuchar;  ///< of GPS
    std::optional<int> leap_seconds;                 ///< GPST − UTC, s
    SkippedRecords skipped;
    std::vector<std::string> warnings;  ///< one line for each kind of thing passed over, naming file and first line
};

/// Reads the text of a RINEX 2.00–2.12 GPS, 3.00–3.05 or 4.00–4.02 navigation file.
///
/// Exponents may be D or E; blank fields are 0; what only costs a record costs that record and a warning. Times are
/// resolved by each record's own calendar epoch, so weeks may be reduced modulo 1024.
/// Fails with `input` when the text is of another kind, system or version, or when no record can be read.
/// @param name of the file, for messages
Result<NavigationFile> read_navigation(std::string_view text, std::string_view name);

/// The same for a file, gzip-compressed or not. Fails as read_text_file and read_navigation do.
Result<NavigationFile> read_navigation_file(const std::filesystem::path& path);

}  // namespace skyloop
