/// Fixes from a solution file of RTKLIB (.pos).
#pragma once

#include <string>
#include <string_view>

#include "study/analysis/fix_series.hpp"

namespace skyloop {

/// True when the text starts as solution files do: with comment lines ('%') of which one names the columns.
bool is_rtklib_solution(std::string_view text);

/// A sample from each row of a solution (RTKLIB manual 2.4.2, appendix B.1): times in GPST, UTC or JST as a calendar or
/// as week and time of week; positions as degrees, as degrees, minutes and seconds, or Earth-centred; any field
/// separator. A quality of 0 is no fix. Heights above the geoid are taken as they are, with a warning. Baselines are
/// refused: they have no place on the Earth.
Result<FixSeries> parse_rtklib_solution(std::string_view text, const std::string& name);

}  // namespace skyloop
