/// RTCM 3 messages 1007, 1008 and 1033: what antenna and what receiver a base station has (RTCM 10403.3, tables 3.5-8
/// and 3.5-86).
#pragma once

#include <optional>
#include <string>

#include "base/core/bytes.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::inline receiver {

/// Texts of characters that may be any byte; empty ones are not told.
struct Rtcm3Descriptors {
    int number = 1033;            ///< 1007, 1008 or 1033
    int station = 0;              ///< DF003
    std::string antenna;          ///< DF030: its name and radome as the IGS writes them
    int antenna_setup = 0;        ///< DF031: 0 for the standard model of the antenna
    std::string antenna_serial;   ///< DF033: of 1008 and 1033
    std::string receiver;         ///< DF228: of 1033, as the two below
    std::string firmware;         ///< DF230
    std::string receiver_serial;  ///< DF232
    bool operator==(const Rtcm3Descriptors&) const = default;
};
/// Nothing for other numbers and cut messages.
std::optional<Rtcm3Descriptors> decode_descriptors(const Rtcm3Message& message);
/// Texts are cut to 31 bytes, which is what their counters may say. Empty for other numbers.
Bytes encode(const Rtcm3Descriptors& descriptors);

}  // namespace skyloop::inline receiver
