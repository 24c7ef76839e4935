/// Signal strengths from the satellites.csv of a run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "study/analysis/fix_series.hpp"

namespace skyloop {

/// What a row tells.
struct DatedSignal {
    GpsTime time;
    SignalReport report;
};

/// Reads the columns time_utc, elevation_deg and cn0_dbhz of a table (INTERFACE.md, section 3). Rows without C/N0, or
/// without pseudorange_m where the table has that column, are satellites that are not tracked, and are left out as they
/// are out of receivers' logs.
Result<std::vector<DatedSignal>> parse_satellites_table(std::string_view text, const std::string& name);

/// Where `fixes` is a file fixes.csv or fixes.csv.gz, adds what the satellites.csv (or .gz) in its folder tells to
/// the samples of these times. What cannot be read there becomes a warning of `series`: its fixes are good without it.
void add_satellites_beside(const std::filesystem::path& fixes, FixSeries& series);

}  // namespace skyloop
