/// The NMEA 0183 sentences of a GNSS receiver as values, and their text.
/// Less common NMEA 0183 sentences of a GNSS receiver as values, and their text.
/// NMEA 0183 text back into values.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "receiver/protocol/nmea_fields.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::inline receiver {

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

/// Magnetic heading. What a compass is off by for the iron of its vehicle is a compass's, and left out.
struct Hdg {
    std::string talker = "HC";
    std::optional<Angle> magnetic_heading;
    std::optional<Angle> variation;  ///< of the magnetic from the true north, east positive
    bool operator==(const Hdg&) const = default;
};

/// Rate of turn.
struct Rot {
    std::string talker = "GN";
    std::optional<double> degrees_per_minute;  ///< positive: the bow turns to starboard
    bool valid = false;
    bool operator==(const Rot&) const = default;
};

/// The sentence, with checksum and line end. Layouts and digits: RECEIVER.md 5.2 and 5.3.
std::string encode(const Gns& message, const NmeaFormat& format);
std::string encode(const Gbs& message, const NmeaFormat& format);
std::string encode(const Grs& message, const NmeaFormat& format);
std::string encode(const Dtm& message, const NmeaFormat& format);
std::string encode(const Vlw& message, const NmeaFormat& format);
std::string encode(const Ths& message, const NmeaFormat& format);
std::string encode(const Hdt& message, const NmeaFormat& format);
std::string encode(const Hdg& message, const NmeaFormat& format);
std::string encode(const Rot& message, const NmeaFormat& format);

// Every message names its talker ("GN"), and absent values are empty fields.

/// Recommended minimum data.
struct Rmc {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    bool valid = false;
    std::optional<NmeaPosition> position;
    std::optional<MetresPerSecond> speed;  ///< over ground
    std::optional<Angle> course;           ///< over ground, true
    std::optional<NmeaDate> date;
    std::optional<NmeaMode> mode;
    bool operator==(const Rmc&) const = default;
};

/// Course and speed over ground.
struct Vtg {
    std::string talker = "GN";
    std::optional<Angle> course;           ///< true
    std::optional<MetresPerSecond> speed;  ///< over ground
    std::optional<NmeaMode> mode;
    bool operator==(const Vtg&) const = default;
};

/// Fix data.
struct Gga {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    std::optional<NmeaPosition> position;
    int quality = 0;  ///< 0 none, 1 autonomous, 2 differential, 3 PPS, 4 RTK fixed, 5 RTK float, 6 estimated,
                      ///< 7 manual, 8 simulated
    int satellites_used = 0;
    std::optional<double> hdop;
    std::optional<Metres> altitude;          ///< above mean sea level
    std::optional<Metres> geoid_separation;  ///< of the geoid above the ellipsoid
    std::optional<Seconds> correction_age;
    std::optional<int> correction_station;
    bool operator==(const Gga&) const = default;
};

/// Active satellites and dilution of precision.
struct Gsa {
    std::string talker = "GN";
    bool automatic = true;        ///< the receiver chooses between 2D and 3D
    bool has_mode = true;         ///< it says which of both
    int fix_mode = 1;             ///< 1 none, 2 2D, 3 3D
    std::vector<int> satellites;  ///< at most twelve are shown
    std::optional<double> pdop, hdop, vdop;
    std::optional<int> system_id;  ///< since version 4.10
    bool operator==(const Gsa&) const = default;
};

/// One satellite of GSV.
struct GsvSatellite {
    std::optional<int> number;
    std::optional<int> elevation_deg;
    std::optional<int> azimuth_deg;
    std::optional<int> cn0_dbhz;  ///< nothing: not tracked
    bool operator==(const GsvSatellite&) const = default;
};

/// Satellites in view, one page of at most four.
struct Gsv {
    std::string talker = "GP";
    int pages = 1;
    int page = 1;
    int satellites_in_view = 0;
    std::vector<GsvSatellite> satellites;
    std::optional<int> signal_id;  ///< since version 4.10
    bool operator==(const Gsv&) const = default;
};
/// All pages of one group, at least one; satellites beyond 36 (nine pages) are left out.
std::vector<Gsv> gsv_pages(const std::string& talker, const std::vector<GsvSatellite>& satellites,
                           std::optional<int> signal_id);

/// Position without height.
struct Gll {
    std::string talker = "GN";
    std::optional<NmeaPosition> position;
    std::optional<NmeaTime> time;
    bool valid = false;
    std::optional<NmeaMode> mode;
    bool operator==(const Gll&) const = default;
};

/// Error statistics, 1 σ.
struct Gst {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    std::optional<Metres> range_rms;
    std::optional<Metres> semi_major, semi_minor;  ///< of the horizontal error ellipse
    std::optional<Angle> orientation;              ///< of the major axis, from true north
    std::optional<Metres> latitude, longitude, altitude;
    bool operator==(const Gst&) const = default;
};

/// Time and date. The local zone is always UTC.
struct Zda {
    std::string talker = "GN";
    std::optional<NmeaTime> time;
    std::optional<NmeaDate> date;
    bool operator==(const Zda&) const = default;
};

/// A text for people.
struct Txt {
    std::string talker = "GN";
    int count = 1;
    int index = 1;
    int type = 2;  ///< u-blox: 00 error, 01 warning, 02 notice, 07 user
    std::string text;
    bool operator==(const Txt&) const = default;
};

using NmeaMessage =
    std::variant<Rmc, Vtg, Gga, Gsa, Gsv, Gll, Gst, Zda, Txt, Gns, Gbs, Grs, Dtm, Vlw, Ths, Hdt, Hdg, Rot>;

/// The sentence, with checksum and line end. Layouts and digits: RECEIVER.md 5.2, 5.3 and 5.5.
std::string encode(const Rmc& message, const NmeaFormat& format);
std::string encode(const Vtg& message, const NmeaFormat& format);
std::string encode(const Gga& message, const NmeaFormat& format);
std::string encode(const Gsa& message, const NmeaFormat& format);
std::string encode(const Gsv& message, const NmeaFormat& format);
std::string encode(const Gll& message, const NmeaFormat& format);
std::string encode(const Gst& message, const NmeaFormat& format);
std::string encode(const Zda& message, const NmeaFormat& format);
std::string encode(const Txt& message, const NmeaFormat& format);
std::string encode(const NmeaMessage& message, const NmeaFormat& format);

/// Reads RMC, VTG, GGA, GSA, GSV, GLL, GST, ZDA, TXT, GNS, GBS, GRS, DTM, VLW, THS, HDT, HDG and ROT of any version and
/// talker. Fields that a later version added may be missing. Fails with `input`, naming the sentence and the field,
/// when a field is not what its place demands, and for every other kind of sentence.
Result<NmeaMessage> decode_nmea(const SentenceView& sentence);

/// parse_sentence(), then decode_nmea().
Result<NmeaMessage> decode_nmea(std::string_view line);

}  // namespace skyloop::inline receiver
