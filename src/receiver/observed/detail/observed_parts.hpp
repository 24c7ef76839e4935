/// What the readers of the kinds of receivers' output share.
#pragma once

#include <bit>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "receiver/observed/nmea_epochs.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline receiver {

/// A little-endian number at `at`, which lies inside. Every format here is little-endian, as the machines are.
template <class Number>
Number number_at(ByteSpan bytes, std::size_t at) {
    static_assert(std::endian::native == std::endian::little);
    Number value{};
    std::memcpy(&value, bytes.data() + at, sizeof(Number));
    return value;
}

/// The same as a double.
template <class Number>
double double_at(ByteSpan bytes, std::size_t at) {
    return static_cast<double>(number_at<Number>(bytes, at));
}

/// The type of a fix that a format numbers 0, 1, …; none for a number that it does not have.
inline FixType numbered_type(std::span<const FixType> types, int number) {
    return number >= 0 && static_cast<std::size_t>(number) < types.size() ? types[static_cast<std::size_t>(number)]
                                                                          : FixType::none;
}

/// The place, or nothing for numbers that are none. Degrees; metres above the ellipsoid.
std::optional<Geodetic> observed_place(double latitude_deg, double longitude_deg, double height_m);

/// A count or a code: 0 for what is none, as a log may declare any field to be a float.
int observed_number(std::optional<double> value);

/// Keeps the strongest of each satellite and number, and its elevation.
void add_signal(std::vector<ObservedSignal>& signals, const ObservedSignal& signal);

/// "3 epochs … ", when there are any.
void add_note(ObservedLog& log, std::size_t count, const std::string& what);

/// Dates epochs by the ones whose date is told, counted on over midnights, those before the first date by that. Without
/// any the first day is 1980-01-06. @return a date is told
bool date_by_days(std::vector<NmeaEpoch>& epochs);

/// Counts the weeks of the epochs before the first one whose week is told from that. Those with a fix are dated so:
/// without one a receiver may count the time of week from its start. @return a week is told
bool date_by_weeks(std::vector<ObservedEpoch>& epochs);

/// Epochs ascending in time, each time once. Left out: a single epoch whose time ran ahead, those that repeat a time or
/// go back, and those without a place that do not fit between their neighbours with one, which they never outdate.
/// Recordings of one file that have times of their own are put in the order of time. It is told.
void put_epochs_in_order(ObservedLog& log);

/// What the use of the epochs asks for. Places of 0°, 0°, where receivers put what they do not know, and of epochs
/// without a fix are none. For events, and for tracks, whose rows are cleaned as those of every track, epochs more than
/// a week from the middle one, whose clock is wrong, are left out. Fails when none is left.
Result<ObservedLog> finish_log(ObservedLog log, const ObservedReading& reading);

/// UBX, SBF and NMEA, mixed as receivers send them.
Result<ObservedLog> read_observed_stream(ByteSpan bytes, const std::string& name, const ObservedReading& reading);
/// The log of PX4 (receiver/observed/ulog.hpp).
Result<ObservedLog> read_ulog(ByteSpan bytes, const std::string& name, const ObservedReading& reading);
/// The log of ArduPilot (receiver/observed/dataflash.hpp).
Result<ObservedLog> read_dataflash(ByteSpan bytes, const std::string& name, const ObservedReading& reading);
/// A solution of RTKLIB (.pos; RTKLIB manual 2.4.2, appendix B.1): times in GPST, UTC or JST as a calendar or as week
/// and time of week; places as degrees, as degrees, minutes and seconds, or Earth-centred; any separator of cells.
/// Baselines are refused: they have no place on the Earth.
Result<ObservedLog> read_rtklib_solution(ByteSpan bytes, const std::string& name, const ObservedReading& reading);

}  // namespace skyloop::inline receiver
