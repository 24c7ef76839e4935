/// Cells of a line of a table.
/// Which column of a table of fixes says what, and in which unit.
/// Fixes in rows and columns, with a header line or without.
/// Signal strengths from the satellites.csv of a run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/table_text.hpp"
#include "base/core/written_place.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop::inline study {

/// The cells of a line, each without blanks around it. A separator between double quotes separates nothing. With a
/// space as `separator` several count as one.
LineCells split_cells(std::string_view line, char separator);

/// The number that a cell is, or nothing.
std::optional<double> cell_value(std::string_view cell);

/// Where a quantity stands in a row, and what its numbers are multiplied by: to degrees, metres or seconds.
struct FixColumn {
    std::size_t index = 0;
    double scale = 1;
};

/// The columns of a table.
struct FixColumns {
    bool named = false;  ///< the first line is a header, not a sample
    std::size_t count = 0;
    FixColumn latitude, longitude, height;
    std::optional<FixColumn> true_latitude, true_longitude, true_height;
    std::optional<FixColumn> fix_type, time, week, tow, used;
    HemisphereColumns hemispheres;  ///< of latitude and longitude; no others have such letters
    std::string above_sea;          ///< the name of a height that is told to be above the sea; empty: none is
    /// Of a table without a time: the columns whose names tell one all the same.
    std::vector<std::string> unread_times;

    [[nodiscard]] bool has_truth() const { return true_latitude && true_longitude && true_height; }

    /// Of a first line of names. Fails with what is wrong in it, without the file.
    static tl::expected<FixColumns, std::string> of(const std::vector<std::string_view>& header);
    /// Latitude, longitude and height, without a header.
    static FixColumns of_numbers();
};

/// Reads a table. A first row of numbers only means latitude, longitude, height; otherwise it names the columns.
Result<FixSeries> parse_fix_table(std::string_view text, const std::string& name);

/// A geodetic position from degrees and metres, or the sentence part that says what is wrong with it.
/// Longitudes of 180 … 360° are taken as −180 … 0°.
tl::expected<Geodetic, std::string> checked_position(double latitude_deg, double longitude_deg, double height_m);

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

}  // namespace skyloop::inline study
