/// What a receiver is set to do, whoever made it: makers derive it from their own settings.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/core/port_id.hpp"
#include "receiver/protocol/nmea_satellites.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// Kinds of fix that the user allows.
enum class FixMode { only_2d, only_3d, automatic };

/// Limits within which a fix counts, and what is known beside the satellites.
struct FixLimits {
    FixMode mode = FixMode::automatic;
    Metres height{0};                ///< above sea level, of a 2D fix by FixMode::only_2d
    double height_variance_m2 = 0;   ///< of that
    std::uint64_t least_used = 3;    ///< satellites of any fix; up to 3 it makes no difference
    std::uint64_t least_strong = 0;  ///< satellites of at least `strong`
    DbHz strong{0};
    double most_pdop = 25;          ///< of a valid fix; 0: no limit
    double most_accuracy_m = 100;   ///< of position, 1 σ; 0: no limit
    int dynamic_model = 0;          ///< its limits, numbered as by dynamic_model_of()
    MetresPerSecond held_below{0};  ///< slower than this, the position is held; 0: never
    Metres held_within{0};          ///< until the antenna is so far off; 0: for ever
};

/// What a receiver's configuration allows of corrections.
struct CorrectionLimits {
    Seconds timeout{60};      ///< of differential corrections
    bool float_only = false;  ///< ambiguities are not fixed
};

/// When a survey of the receiver's own place is over.
struct SurveyLimits {
    Seconds least{0};
    Metres accuracy{0};  ///< 3D, 1 σ
    bool operator==(const SurveyLimits&) const = default;
};

/// Where a base station stands.
struct BasePlace {
    Position<Ecef> position;
    Metres accuracy;  ///< 1 σ
};

/// A circle on the ground.
struct FenceArea {
    std::uint8_t number = 1;
    Geodetic centre;
    Metres radius{0};
};

/// A rate of time pulses: `period`, or `hertz` where that is not 0. Neither: there are none.
struct PulseRate {
    Nanoseconds period{0};
    std::int64_t hertz = 0;
};

struct PulseConfig {
    PulseRate locked{.period = std::chrono::seconds(1)};    ///< while there is time from space
    PulseRate unlocked{.period = std::chrono::seconds(1)};  ///< before
    std::uint64_t time_grid = 0;                            ///< 0 UTC, 1 GPS, 2 GLONASS, 3 BeiDou, 4 Galileo, 5 NavIC
};

/// How a receiver goes on and off by itself.
enum class PowerMode { full, on_off, cyclic };

/// What is configured of it.
struct PowerSaveSettings {
    PowerMode mode = PowerMode::full;
    Nanoseconds update_period{0};    ///< of on and off; 0: it stays off until it is woken
    Nanoseconds search_period{0};    ///< from one vain search to the next; 0: the same
    Nanoseconds grid_offset{0};      ///< of both, after the start of the week
    Nanoseconds cyclic_period{0};    ///< between epochs of optimized tracking; 0: the navigation period
    Seconds on_time{0};              ///< in Tracking
    Seconds least_acquisition{0};    ///< in Acquisition
    Seconds longest_acquisition{0};  ///< the same without a fix; 0: the receiver's own
    Seconds time_accuracy{0};        ///< to which the time is to be known with `wait_for_time`
    bool wait_for_time = false;      ///< before Tracking
    bool never_off = false;          ///< for want of a fix
    bool update_ephemerides = false;
    bool in_utc = true;  ///< weeks begin with those of UTC, not of GPS time
};

/// Which protocols pass a port in one direction.
struct PortProtocols {
    bool ubx = true, nmea = true, rtcm3 = false;  ///< `ubx`: or what else its maker has for frames
};

struct PortConfig {
    bool on = true;             ///< whether bytes pass at all
    std::uint32_t baud = 9600;  ///< of USB, I2C and SPI that of their bus
    PortProtocols in{}, out{};
    /// Texts for people that are let out, a bit for each level: 0 error, 1 warning, 2 notice, 3 test, 4 debug.
    std::uint64_t ubx_texts = 0, nmea_texts = 7;

    /// Whether the port sends messages of that protocol; of UBX, whatever the message.
    [[nodiscard]] bool lets_out(UbxMessageId message) const {
        if (!on) return false;
        if (message.message_class == class_nmea || message.message_class == class_pubx) return out.nmea;
        return message.message_class == class_rtcm ? out.rtcm3 : out.ubx;
    }
};

/// How sentences look, and what they leave out.
struct NmeaConfig {
    NmeaVersion version = NmeaVersion::v4_0;
    NmeaNumbering numbering = NmeaNumbering::strict;
    std::string talker;                   ///< of all sentences but GSV; empty: by the systems that are on
    std::string beidou_talker = "GB";     ///< of GSV
    bool main_talker_everywhere = false;  ///< in GSV, too
    std::set<Constellation> left_out;     ///< of lists of satellites
    bool numbers_empty_lists = false;     ///< GSV without satellites names the signal of GPS
    std::uint64_t most_listed = 0;        ///< satellites in GSV, of a system; 0: all
    bool gps_only = false;
    bool counts_considered = true;  ///< satellites, too, that the solution looked at and left out
    bool limit_82 = false, compatible = false, high_precision = false;
    bool shows_invalid_fix = false, shows_masked_fix = false, shows_invalid_time = false, shows_invalid_date = false,
         shows_frozen_course = false;
};

/// Defaults are those of u-blox's NEO-M9N (interface description SPG 4.04, UBX-21022436), where it has such an item.
struct ReceiverConfig {
    ReceiverSettings settings;           ///< of measurement and solution
    std::vector<Constellation> systems;  ///< that can be received: GPS, SBAS, Galileo, BeiDou, QZSS, GLONASS, NavIC
    Angle elevation_mask;                ///< in whole degrees, as lists of satellites go by it
    FixLimits limits;
    CorrectionLimits corrections;
    std::optional<SurveyLimits> survey;  ///< a base surveys its own place
    std::optional<BasePlace> place;      ///< it has been given
    int station = 0;                     ///< of RTCM 3, 0 … 4095
    std::vector<FenceArea> fences;
    double fence_confidence = 0;  ///< standard deviations from the line within which a place is on no side
    PulseConfig pulses;
    PowerSaveSettings power;
    bool counts_distance = true;  ///< the odometer is on
    bool predicts_orbits = true;
    bool trusts_l5 = true;  ///< GPS's L5, of which GPS says that it is not in operation
    bool watches_interference = false, watches_antenna = false, short_ends_supply = false;
    bool reports_dead_reckoning = true, reports_spoofing = false;
    bool reports_jamming_elsewhere = false;  ///< than in its interference monitor, where nothing hides it
    std::uint8_t utc_standard = 0;           ///< as NAV-PVT numbers it; 0: by the systems in use
    std::int64_t first_week = 2117;          ///< before the first time from space
    NmeaConfig nmea;
    std::array<PortConfig, port_count> ports{};

    [[nodiscard]] const PortConfig& port(PortId id) const { return ports[static_cast<std::size_t>(id)]; }
    [[nodiscard]] bool has_on(Constellation system) const {
        return std::find(systems.begin(), systems.end(), system) != systems.end();
    }
};

}  // namespace skyloop::firmware
