/// State vectors of GLONASS and SBAS satellites in RINEX text.
#pragma once

#include "navigation_record.hpp"

namespace skyloop::rinex {

/// Reads four lines, or the five of version 3.05 and later (RINEX 3.05, table A10).
tl::expected<GlonassEphemeris, Defect> read_glonass_record(const RecordKind& kind, RecordFields fields);

/// Reads four lines (RINEX 3.05, table A16).
tl::expected<SbasEphemeris, Defect> read_sbas_record(const RecordKind& kind, RecordFields fields);

}  // namespace skyloop::rinex
