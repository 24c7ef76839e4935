/// What the fields of NMEA 0183 sentences hold, and how they are written.
#pragma once

#include <compare>
#include <cstdint>
#include <string_view>

#include "base/core/units.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/protocol/nmea_satellites.hpp"

namespace skyloop::inline receiver {

/// Digits and version of encoded sentences. Digits beyond those shown are rounded, except those of times, which are
/// cut: round an epoch's time once with rounded_utc(), so that every sentence of it, and the date, agree.
struct NmeaFormat {
    NmeaVersion version = NmeaVersion::v4_10;
    int time_decimals = 2;
    int coordinate_decimals = 5;  ///< of the minutes of latitude and longitude
    int altitude_decimals = 1;
    bool limit_82 = true;  ///< GGA, GNS and GRS give up decimals rather than exceed 82 characters
    // Where makers differ (RECEIVER.md 5.8 to 5.10); the defaults are u-blox's.
    int speed_decimals = 3;             ///< of RMC and VTG
    int course_decimals = 2;            ///< of RMC and VTG
    int vtg_speed_decimals = -1;        ///< of VTG; -1: as of RMC
    int vtg_course_decimals = -1;       ///< the same
    bool magnetic_fields = false;       ///< RMC has the magnetic variation, VTG the magnetic course
    double magnetic_variation_deg = 0;  ///< east positive; of HDG too
    int heading_decimals = 2;           ///< of HDT, THS and HDG
    char rmc_status = 'V';              ///< navigational status of a valid RMC since version 4.10
    bool empty_gsv_fields = false;      ///< a page of GSV without satellites has the fields of one, and no signal
    int dop_decimals = 2;               ///< of GGA, GNS and GSA
    double most_dop = 99.99;            ///< what larger ones are shown as
    bool satellites_padded = true;      ///< numSV of GGA and GNS has two digits: "07", not "7"
    bool units_always = false;          ///< GGA has the units of heights that it does not tell
    bool deviations_padded = false;     ///< GST in the manner of MediaTek: "004.0", the last field "00014"
    std::string_view no_station{};      ///< the last field of GGA without a correction station: empty, or "0000"
};

/// `time` in UTC, rounded to `decimals` (0 … 9) digits of a second: the carry goes as far as the year, and through
/// second 60 where the table has a leap second.
UtcTime rounded_utc(GpsTime time, int decimals, const LeapSeconds& leap_seconds);

/// A time of day, UTC; second 60 is a leap second.
struct NmeaTime {
    unsigned hour = 0, minute = 0, second = 0;
    std::uint32_t nanosecond = 0;
    auto operator<=>(const NmeaTime&) const = default;
};
/// A calendar day. RMC writes two digits of the year: 80 … 99 are read as 1980 … 1999.
struct NmeaDate {
    int year = 1980;
    unsigned month = 1, day = 6;
    auto operator<=>(const NmeaDate&) const = default;
};
NmeaTime nmea_time(const UtcTime& utc);
NmeaDate nmea_date(const UtcTime& utc);

/// Where, on the ellipsoid; without height.
struct NmeaPosition {
    Angle latitude;
    Angle longitude;
    bool operator==(const NmeaPosition&) const = default;
};

/// Mode indicator of RMC, VTG and GLL (since version 2.3), and for each system of GNS.
enum class NmeaMode : char {
    none = 'N',
    autonomous = 'A',
    differential = 'D',
    estimated = 'E',
    rtk_float = 'F',
    rtk_fixed = 'R',
    manual = 'M',
    simulator = 'S',
    precise = 'P',
};

}  // namespace skyloop::inline receiver
