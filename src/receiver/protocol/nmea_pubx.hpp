/// u-blox's own NMEA sentences that tell of a solution (RECEIVER.md 5.7).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "receiver/protocol/nmea_fields.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::inline receiver {

/// PUBX,00: position, velocity, accuracies.
struct PubxPosition {
    std::optional<NmeaTime> time;
    NmeaPosition position;
    Metres altitude;            ///< above the ellipsoid
    std::string status = "NF";  ///< NF none, DR, G2, G3, D2, D3, RK GNSS with dead reckoning, TT time only
    Metres horizontal_accuracy, vertical_accuracy;
    MetresPerSecond speed;  ///< over ground
    Angle course;           ///< over ground
    MetresPerSecond down;   ///< vertical velocity
    std::optional<int> correction_age_s;
    double hdop = 99.99, vdop = 99.99, tdop = 99.99;
    int satellites_used = 0;
    bool dead_reckoning = false;
    bool operator==(const PubxPosition&) const = default;
};

/// One satellite of PUBX,03.
struct PubxSatellite {
    int number = 0;  ///< in one byte: GPS 1 …, BeiDou 33 … 64 and 159 …, GLONASS 65 …, SBAS 120 …, QZSS 193 …,
                     ///< Galileo 211 …
    char status = '-';  ///< U used, e not used though its orbit is known, - not used
    std::optional<int> azimuth_deg, elevation_deg, cn0_dbhz;
    int lock_s = 0;  ///< 0 … 64
    bool operator==(const PubxSatellite&) const = default;
};
/// PUBX,03: satellites.
struct PubxSatellites {
    std::vector<PubxSatellite> satellites;  ///< at most 99 are shown
    bool operator==(const PubxSatellites&) const = default;
};

/// PUBX,04: time of day and clock.
struct PubxTime {
    std::optional<NmeaTime> time;
    std::optional<NmeaDate> date;
    std::optional<double> utc_tow_s;
    std::optional<int> utc_week;
    int leap_seconds = 18;
    bool leap_seconds_by_default = false;  ///< the firmware's own number: "18D"
    double clock_bias_ns = 0, clock_drift_ns_s = 0;
    int granularity_ns = 0;  ///< of the time pulse
    bool operator==(const PubxTime&) const = default;
};

using PubxMessage = std::variant<PubxPosition, PubxSatellites, PubxTime>;

/// The sentence, with checksum and line end; of `format` the digits of times and coordinates count.
std::string encode(const PubxPosition& message, const NmeaFormat& format);
std::string encode(const PubxSatellites& message, const NmeaFormat& format);
std::string encode(const PubxTime& message, const NmeaFormat& format);

/// Reads PUBX,00, 03 and 04 as a receiver sends them. Fails with `input`, naming the field, for everything else.
Result<PubxMessage> decode_pubx(const SentenceView& sentence);

}  // namespace skyloop::inline receiver
