/// Less common NMEA 0183 sentences of a GNSS receiver as values, and their text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "receiver/protocol/nmea_fields.hpp"

namespace skyloop {

// Every message names its talker ("GN"), and absent values are empty fields.

/// Fix data of several systems.
struct Gns {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    std::optional<NmeaPosition> position;
    std::vector<NmeaMode> modes;  ///< of GPS, GLONASS, Galileo, BeiDou and what follows them
    int satellites_used = 0;      ///< up to 99
    std::optional<double> hdop;
    std::optional<Metres> altitude;          ///< above mean sea level
    std::optional<Metres> geoid_separation;  ///< of the geoid above the ellipsoid
    std::optional<Seconds> correction_age;
    std::optional<int> correction_station;
    bool operator==(const Gns&) const = default;
};

/// Satellite fault detection.
struct Gbs {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    std::optional<Metres> latitude, longitude, altitude;  ///< expected errors, 1 σ
    std::optional<int> satellite;                         ///< most likely to have failed
    std::optional<double> missed_probability;             ///< of a failure that was not seen
    std::optional<Metres> bias, bias_deviation;           ///< of that satellite's range
    std::optional<int> system_id, signal_id;              ///< since version 4.10
    bool operator==(const Gbs&) const = default;
};

/// Range residuals, in the order of the satellites of GSA.
struct Grs {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    int mode = 1;                                  ///< 0 those of the solution, 1 computed after it
    std::vector<std::optional<Metres>> residuals;  ///< at most twelve are shown
    std::optional<int> system_id, signal_id;       ///< since version 4.10
    bool operator==(const Grs&) const = default;
};

/// The datum of the positions.
struct Dtm {
    std::string talker = "GN";
    std::string datum = "W84", subdivision;
    double latitude_minutes = 0, longitude_minutes = 0;  ///< offsets from the reference, north and east positive
    double altitude_m = 0;
    std::string reference = "W84";
    bool operator==(const Dtm&) const = default;
};

/// Distances over ground. Those through water are not a receiver's.
struct Vlw {
    std::string talker = "GN";
    std::optional<Metres> total, since_reset;
    bool operator==(const Vlw&) const = default;
};

/// True heading, with its mode: A autonomous, E estimated, M manual, S simulated, V not valid.
struct Ths {
    std::string talker = "GN";
    std::optional<Angle> heading;
    char mode = 'V';
    bool operator==(const Ths&) const = default;
};

/// True heading.
struct Hdt {
    std::string talker = "GN";
    std::optional<Angle> heading;
    bool operator==(const Hdt&) const = default;
};

/// The sentence, with checksum and line end. Layouts and digits: RECEIVER.md 5.2 and 5.3.
std::string encode(const Gns& message, const NmeaFormat& format);
std::string encode(const Gbs& message, const NmeaFormat& format);
std::string encode(const Grs& message, const NmeaFormat& format);
std::string encode(const Dtm& message, const NmeaFormat& format);
std::string encode(const Vlw& message, const NmeaFormat& format);
std::string encode(const Ths& message, const NmeaFormat& format);
std::string encode(const Hdt& message, const NmeaFormat& format);

}  // namespace skyloop
