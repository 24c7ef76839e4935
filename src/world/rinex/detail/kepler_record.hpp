/// A Kepler-type ephemeris of GPS, QZSS, Galileo, BeiDou or NavIC in RINEX text.
#pragma once

#include "navigation_record.hpp"

namespace skyloop::rinex {

/// Reads eight lines (RINEX 3.05, tables A6, A8, A12, A14, A18).
tl::expected<KeplerEphemeris, Defect> read_kepler_record(const RecordKind& kind, RecordFields fields);

}  // namespace skyloop::rinex
