/// The NMEA 0183 sentences of a GNSS receiver as values, and their text.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/core/units.hpp"
#include "receiver/protocol/nmea_fields.hpp"
#include "receiver/protocol/nmea_supplements.hpp"

namespace skyloop {

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
    int quality = 0;  ///< 0 none, 1 autonomous, 2 differential, 4 RTK fixed, 5 RTK float, 6 estimated
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

using NmeaMessage = std::variant<Rmc, Vtg, Gga, Gsa, Gsv, Gll, Gst, Zda, Txt, Gns, Gbs, Grs, Dtm, Vlw, Ths, Hdt>;

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

}  // namespace skyloop
