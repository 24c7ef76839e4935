/// Everything from which messages are made.
/// The instants of a receiver's own clock.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"
#include "firmware/core/base_station.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/core/receiver_config.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// What the receiver knows of the time.
struct TimeKnowledge {
    bool time = false;          ///< the time of day, and of the week
    bool date = false;          ///< and with it the week
    bool leap_seconds = false;  ///< decoded, not the firmware's own number: fully resolved
    bool confirmed = false;     ///< by several systems (NAV-PVT flags2)
    Seconds accuracy{0};        ///< 1 σ; meaningless without `time`
    /// Whose satellites told the leap seconds; nothing of those that were known from before the run.
    std::optional<Constellation> leap_source{};
};

/// What captured receivers tell of a solution that they never had (RECEIVER.md 4.10): no estimate is worse. 1 σ.
inline constexpr Metres unknown_horizontal_accuracy{4294967.295}, unknown_vertical_accuracy{3750000.128};
inline constexpr MetresPerSecond unknown_speed_accuracy{20};

/// Why the whole receiver has started last.
enum class BootCause {
    power,           ///< switched on, or its power was cut
    hardware_reset,  ///< by CFG-RST
    software_reset,  ///< by CFG-RST, or another command
    backup           ///< woken, after it was off by its own doing
};

/// What came in by RTCM.
struct CorrectionStatus {
    CorrectionState state = CorrectionState::none;  ///< of what can be solved; as reported, of what was
    std::optional<Seconds> age;                     ///< of the last observations; nothing before the first
    std::optional<int> station;                     ///< DF003
    std::optional<Position<Ecef>> base;             ///< where that station says it stands
    bool come = false;                              ///< they do, whatever the reported solution has of them
};

/// What a receiver's monitor tells of one of its bands.
struct BandMonitor {
    int jamming_state = 0;      ///< 0 unknown or off, 1 ok, 2 warning, 3 critical
    int jamming_indicator = 0;  ///< 0 … 255
    int agc = 0;                ///< 0 … 8191
    int noise_per_ms = 0;
};

/// The receiver's monitors as it reports them.
struct MonitorStatus {
    BandMonitor upper;  ///< the band of L1
    BandMonitor lower;  ///< that of L2 and L5; of a board with one band as it begins
    /// That of the band where it is worse.
    [[nodiscard]] int jamming_state() const { return std::max(upper.jamming_state, lower.jamming_state); }
    AntennaStatus antenna = AntennaStatus::unknown;
    int antenna_power = 2;  ///< 0 off, 1 on, 2 unknown
    SpoofingIndication spoofing = SpoofingIndication::unknown;
    int temperature = 28;    ///< of the chip, °C
    std::uint64_t dice = 0;  ///< of what is noise within a message, other for each epoch
    /// MON-HW and MON-RF say "unknown" whatever `jamming_state` is, and SEC-SIG alone tells it (F9 HPG 1.50 and later).
    bool jamming_hidden = false;
    bool told_elsewhere = false;  ///< the board has SEC-SIG or Septentrio's RFStatus, which nothing hides
    /// As messages of the board can tell it.
    [[nodiscard]] int told_jamming_state() const { return jamming_hidden && !told_elsewhere ? 0 : jamming_state(); }
};

/// How far a receiver that saves power has come; the numbers are those of NAV-PVT psmState.
enum class PowerSaveState {
    full_power,   ///< it does not save
    enabled,      ///< before it begins
    acquisition,  ///< it searches
    tracking,     ///< it tracks and downloads
    optimized,    ///< it tracks in turns with rests, and downloads nothing
    inactive      ///< it is off
};

/// A leap second by which the receiver counts, though nobody has announced it. Offsets are GPST − UTC, s.
struct LeapEvent {
    GpsTime at;  ///< first instant at which `after` holds
    int before = 18, after = 18;
};

/// The receiver at one epoch, as it reports itself. Free of the truth.
struct NavigationState {
    Epoch epoch;                  ///< its fix is the one to report: after limits, static hold and coasting
    bool fix_ok = false;          ///< within the user's limits (gnssFixOK)
    bool place_given = false;     ///< the position is the user's own: only the time was solved
    bool kind_forbidden = false;  ///< the user wants no solution of this kind, which is why fix_ok is false
    bool ever_had_fix = false;    ///< since the last cold start: `epoch.fix` has a position, if an old one
    bool only_place_known =
        false;                    ///< that of before a start: no accuracies, velocity and clock have been solved since
    bool position_known = false;  ///< the position is of now, or was of a fix before
    TimeKnowledge time;
    CorrectionStatus corrections;
    MonitorStatus monitors;
    std::optional<Seconds> time_to_first_fix;
    Seconds since_start{0};       ///< since navigation has
    Seconds since_boot{0};        ///< since the receiver has
    bool position_held = false;   ///< by static hold
    std::optional<Angle> course;  ///< frozen at low speed; nothing before the first
    bool course_is_frozen = false;
    std::optional<double> turn_rate_dpm{};  ///< of the heading that sentences tell, degrees per minute to starboard
    double odometer_m = 0, odometer_total_m = 0, odometer_deviation_m = 0;
    std::uint64_t epoch_index = 0;       ///< since the last start
    std::optional<BaseSurvey> survey{};  ///< with CFG-TMODE-MODE 1
    PowerSaveState power_save = PowerSaveState::full_power;
    BootCause boot_cause = BootCause::power;
    std::optional<LeapEvent> leap_event{};
    bool old_position_shown = false;  ///< sentences show it without a valid fix too, whatever is configured
    Seconds week_lag{0};      ///< week numbers change so much after their times of week begin anew; below 0 before
    int reports = 1;          ///< how many times its messages are sent
    Seconds report_delay{0};  ///< more until they are; those of later epochs may overtake them
    /// The states before, the last one first: as many as the board's late sentences reach back. They have none.
    std::vector<std::shared_ptr<const NavigationState>> earlier{};
};

/// Whether accuracies, velocity and clock in the fix are of a solution, if an old one.
inline bool estimates_known(const NavigationState& state) { return state.ever_had_fix && !state.only_place_known; }

/// What one port has done, for MON-COMMS, MON-TXBUF, MON-RXBUF and MON-IO.
struct PortStatus {
    PortId id = PortId::uart1;
    std::size_t pending = 0;  ///< bytes waiting to leave
    std::uint64_t bytes_out = 0, bytes_in = 0;
    int usage_percent = 0, peak_usage_percent = 0;  ///< of the transmit buffer
    std::array<std::uint16_t, 4> messages_in{};     ///< UBX, NMEA, RTCM3, SPARTN
    std::uint32_t skipped = 0;                      ///< bytes of no message
    std::uint16_t overruns = 0;
    bool transmit_full = false;  ///< a message did not fit since the last report
};

/// What is counted of one port from outside: unlike PortStatus it outlives the receiver's restarts.
struct PortTotals {
    std::uint64_t messages_out = 0, messages_dropped = 0;  ///< queued to leave; that found the buffer full
    std::uint32_t dropped_at_baud = 0;                     ///< the speed when the last one was dropped; 0: none was
};

/// What a message is made from.
struct ReportContext {
    const BoardProfile& board;
    const ReceiverConfig& config;
    const NavigationState& state;
    std::span<const PortStatus> ports{};
    PortId port = PortId::uart1;                ///< by which it leaves
    std::span<const UbxMessageId> following{};  ///< what is due by the port in the same epoch, after it
};

/// How far the receiver's clock is ahead of GPS time, whole milliseconds aside, as NAV-CLOCK's clkB: ±0.5 ms. Nothing
/// before it has been solved.
Nanoseconds clock_ahead(const NavigationState& state);

/// Carries the position, which was solved for a whole millisecond of GPS time, to the one of the receiver's clock, for
/// which it is reported.
void carry_to_clock_instant(NavigationState& state);

/// Carries what was measured `past` a whole millisecond of the receiver's clock back to that, by the Doppler: ranges by
/// centimetres, to better than a millimetre. Receivers measure at whole milliseconds of their clocks (rcvTow of 4568
/// epochs of ZED-F9T, M8P and M8T).
Observation carried(const Observation& measured, Seconds past);

/// What stands where it was told and solves the time alone has that place for its position.
void tell_given_place(NavigationState& state);

/// Where one comes from there with that velocity.
Geodetic carried(const Geodetic& from, const VelocityNed& velocity, Seconds time);

}  // namespace skyloop::firmware
