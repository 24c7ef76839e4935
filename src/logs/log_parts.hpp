/// What the readers of the kinds of log share.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <string>

#include "skyloop/logs/receiver_log.hpp"

namespace skyloop {

/// A little-endian number at `at`, which lies inside. Every format here is little-endian, as the machines are.
template <class Number>
Number number_at(ByteSpan bytes, std::size_t at) {
    static_assert(std::endian::native == std::endian::little);
    Number value{};
    std::memcpy(&value, bytes.data() + at, sizeof(Number));
    return value;
}

/// The place, or nothing for numbers that are none. Degrees; metres above the ellipsoid.
std::optional<Geodetic> logged_place(double latitude_deg, double longitude_deg, double height_m);

/// A count or a code: 0 for what is none, as a log may declare any field to be a float.
int logged_number(std::optional<double> value);

/// Keeps the strongest signal of each satellite.
void add_satellite(std::vector<LoggedSatellite>& satellites, const LoggedSatellite& satellite);

/// "3 epochs … ", when there are any.
void add_note(ReceiverLog& log, std::size_t count, const std::string& what);

/// Puts epochs in order: those more than a week from the middle one have a wrong clock, those that repeat a time or go
/// back are left out. Fails when none is left.
Result<ReceiverLog> finish_log(ReceiverLog log);

/// UBX and NMEA, mixed as receivers send them.
Result<ReceiverLog> read_stream_log(ByteSpan bytes, const std::string& name, const LogReading& reading);
/// The log of PX4 (skyloop/logs/ulog.hpp).
Result<ReceiverLog> read_ulog(ByteSpan bytes, const std::string& name, const LogReading& reading);
/// The log of ArduPilot (skyloop/logs/dataflash.hpp).
Result<ReceiverLog> read_dataflash(ByteSpan bytes, const std::string& name, const LogReading& reading);

}  // namespace skyloop
