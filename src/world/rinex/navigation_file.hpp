/// RINEX navigation files.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// How many records of a file were passed over, by reason.
struct SkippedRecords {
    /// Version 4: blocks of messages that are not read: "CNAV", "CNV1", "EOP", "ION" of kinds other than LNAV, D1D2,
    /// IFNV.
    std::map<std::string, int, std::less<>> messages;
    int defective = 0;   ///< a field is no number, is needed and blank, or lies outside what a satellite can broadcast
    int incomplete = 0;  ///< lines are missing
    bool operator==(const SkippedRecords&) const = default;
};

/// What a navigation file holds: the ephemerides of all systems, and what its header says.
struct NavigationFile {
    double version = 0;
    std::vector<Ephemeris> records;   ///< in the order of the file, repetitions included
    BroadcastIonosphere ionosphere;   ///< the first of each system
    std::optional<int> leap_seconds;  ///< GPST − UTC, s
    SkippedRecords skipped;
    std::vector<std::string> warnings;  ///< one line for each kind of thing passed over, naming file and first line

    /// How many records of each system were read.
    [[nodiscard]] std::map<Constellation, int> counts() const;
};

/// Reads the text of a RINEX 2.00–2.12, 3.00–3.05 or 4.00–4.02 navigation file of any system.
///
/// Read are the messages LNAV (GPS, QZSS, NavIC), I/NAV, F/NAV, D1, D2, FDMA and SBAS, of version 4 CNAV and CNAV-2
/// (GPS, QZSS) and B-CNAV1 to 3 (BeiDou), too. Exponents may be D or E; blank fields are 0; what only costs a record
/// costs that record and a warning. Times are resolved by each record's own calendar epoch (BDT of BeiDou, UTC of
/// GLONASS, GPST of the others), so weeks may be reduced modulo 1024. Fails with `input` when the text is of another
/// kind or version, or when no record can be read.
/// @param name of the file, for messages
Result<NavigationFile> read_navigation(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_navigation do.
Result<NavigationFile> read_navigation_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
