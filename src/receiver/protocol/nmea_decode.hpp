/// NMEA 0183 text back into values.
#pragma once

#include "base/core/result.hpp"
#include "receiver/protocol/nmea_messages.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop {

/// Reads RMC, VTG, GGA, GSA, GSV, GLL, GST, ZDA, TXT, GNS, GBS, GRS, DTM, VLW, THS and HDT of any version and talker.
/// Fields that a later version added may be missing. Fails with `input`, naming the sentence and the field, when a
/// field is not what its place demands, and for every other kind of sentence.
Result<NmeaMessage> decode_nmea(const SentenceView& sentence);

/// parse_sentence(), then decode_nmea().
Result<NmeaMessage> decode_nmea(std::string_view line);

}  // namespace skyloop
