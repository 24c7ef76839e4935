/// Fixes from a log of NMEA 0183 sentences.
#pragma once

#include <string>
#include <string_view>

#include "study/analysis/fix_series.hpp"

namespace skyloop {

/// True when something near the start of the text looks like an NMEA sentence ("$GPGGA,").
bool has_nmea_sentence(std::string_view text);

/// A sample from each GGA or GNS sentence whose checksum holds, or from several of one time that differ in talker or
/// kind; heights are altitude plus geoid separation. RMC sentences with status A give the date, GSV signal strengths
/// (since version 4.10 of one signal of each system: that on L1 where it is told, else the first by number), GSA the
/// satellites used where they are more than GGA can show; both belong to the sample before them. Damaged sentences,
/// other sentences and binary data between them are skipped; damaged ones of these kinds, and those that pass their
/// checksum and make no sense, are counted in the warnings. A position without an altitude is no fix.
FixSeries parse_nmea_log(std::string_view text, const std::string& name);

}  // namespace skyloop
