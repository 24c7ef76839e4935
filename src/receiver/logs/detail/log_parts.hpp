/// What the readers of the kinds of log share.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <string>

#include "receiver/logs/receiver_log.hpp"

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

/// Epochs ascending in time, each time once. Left out: a single epoch whose time ran ahead, those that repeat a time or
/// go back, and those without a place that do not fit between their neighbours with one, which they never outdate.
/// Recordings of one file that have times of their own are put in the order of time. It is told.
void put_epochs_in_order(ReceiverLog& log);

/// Leaves out epochs more than a week from the middle one, whose clock is wrong, and puts the others in order, unless a
/// track is wanted, whose rows are cleaned as those of every track. Fails when none is left.
Result<ReceiverLog> finish_log(ReceiverLog log, const LogReading& reading);

/// UBX and NMEA, mixed as receivers send them.
Result<ReceiverLog> read_stream_log(ByteSpan bytes, const std::string& name, const LogReading& reading);
/// The log of PX4 (skyloop/logs/ulog.hpp).
Result<ReceiverLog> read_ulog(ByteSpan bytes, const std::string& name, const LogReading& reading);
/// The log of ArduPilot (skyloop/logs/dataflash.hpp).
Result<ReceiverLog> read_dataflash(ByteSpan bytes, const std::string& name, const LogReading& reading);

}  // namespace skyloop
