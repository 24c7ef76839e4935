/// Fixes in rows and columns, with a header line or without.
#pragma once

#include <string>
#include <string_view>

#include "study/analysis/fix_series.hpp"

namespace skyloop {

/// Reads a table. A first row of numbers only means latitude, longitude, height; otherwise it names the columns.
Result<FixSeries> parse_fix_table(std::string_view text, const std::string& name);

/// A geodetic position from degrees and metres, or the sentence part that says what is wrong with it.
/// Longitudes of 180 … 360° are taken as −180 … 0°.
tl::expected<Geodetic, std::string> checked_position(double latitude_deg, double longitude_deg, double height_m);

}  // namespace skyloop
