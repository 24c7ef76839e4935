// What a receiver knows of the time, and what its monitors say (RECEIVER.md 4.8, 4.9, 4.11).

#include <algorithm>
#include <cmath>
#include <set>

#include "firmware/core/state_tracker.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

// A handover word, and with it the time of week, comes every 6 s; the week in subframe 1, every 30 s.
constexpr double time_after_s = 8, date_after_s = 14;
// Time is confirmed when two systems have agreed for so long after the first fix.
constexpr double confirmed_after_s = 45;
// Drift of a crystal whose frequency was just solved.
constexpr double clock_drift_accuracy = 1e-8;
// Galileo sends UTC parameters in word type 6, once a nominal sub-frame of 30 s (OS SIS ICD 2.0, 4.3.3).
constexpr double galileo_utc_period_s = 30;
// GLONASS counts UTC itself: N_T and N_4, by which the day is known, are in strings 4 and 5 of each frame of 30 s
// (GLONASS ICD 5.1, 4.4 and 4.5).
constexpr double glonass_frame_s = 30;

// A page that comes once a cycle. Cycles are counted from the start of the week.
struct UtcPage {
    std::int64_t cycle_s, end_s;

    // Whether it has ended between the two.
    [[nodiscard]] bool ended(GpsTime from, GpsTime to) const { return pages_until(to) > pages_until(from); }
    [[nodiscard]] std::int64_t pages_until(GpsTime t) const {
        constexpr std::int64_t week_s = 604'800;
        const double tow = week_and_tow(t).tow_seconds();
        // A cycle that the end of the week cuts begins anew with it, and has its page only where that ends before.
        const std::int64_t pages_a_week = (week_s - end_s) / cycle_s + 1;
        return week_and_tow(t).week * pages_a_week +
               static_cast<std::int64_t>(
                   std::floor((tow - static_cast<double>(end_s)) / static_cast<double>(cycle_s))) +
               1;
    }
};
// Page 18 of subframe 4, of 25 frames of 30 s; that subframe ends after 24 s of its frame (IS-GPS-200, 20.3.3.5.1).
constexpr UtcPage gps_utc_page{750, 17 * 30 + 24};
// Page 10 of subframe 5, the last of its frame, of 24 frames of D1 (BeiDou ICD B1I 3.0, 5.2). BeiDou's week begins 14 s
// after GPS's.
constexpr UtcPage beidou_utc_page{720, 10 * 30 + 14};

bool tracks(const Fix& fix, Constellation constellation) {
    return std::any_of(fix.satellites.begin(), fix.satellites.end(),
                       [&](const auto& s) { return s.cn0 && s.id.constellation == constellation; });
}

std::size_t systems_used(const Fix& fix) {
    std::set<Constellation> systems;
    for (const SatelliteStatus& s : fix.satellites)
        if (s.used && s.id.constellation != Constellation::sbas) systems.insert(s.id.constellation);
    return systems.size();
}

// u-blox's thresholds are not published: a rise of the noise by 3 dB is seen, by 10 dB is a warning.
constexpr double interference_ok_db = 3, interference_warning_db = 10;
constexpr double indicator_per_db = 9, gain_per_db = 140;

}  // namespace

void StateTracker::learn_time() {
    TimeKnowledge& time = state_.time;
    Fix& fix = state_.epoch.fix;
    const auto since = [&](const std::optional<GpsTime>& t) { return t ? difference(fix.time, *t).value() : -1.0; };
    const bool solved = last_good_ == fix.time;
    const double tracking = since(first_tracking());
    time.time = time.time || tracking >= time_after_s || solved;
    time.date = time.date || tracking >= date_after_s || solved;
    if (const auto source = told_leap_seconds()) {
        time.leap_seconds = true;
        time.leap_source = source;
    }
    if (!time.confirmed) time.confirmed = since(first_fix_) >= confirmed_after_s && systems_used(fix) >= 2;
    if (!time.leap_seconds && board_.quirks.leap_seconds) fix.leap_seconds = *board_.quirks.leap_seconds;
    if (solved) {
        time.accuracy = Seconds(std::max(1e-9, fix.time_accuracy.value() / speed_of_light));
    } else if (last_good_) {
        const double away = since(last_good_);
        time.accuracy = Seconds(last_fix_.time_accuracy.value() / speed_of_light + clock_drift_accuracy * away);
    }
}

// Whose leap seconds were just learnt. What GPS tells takes the place of the others' (NAV-TIMELS); what was known from
// before stays.
std::optional<Constellation> StateTracker::told_leap_seconds() const {
    using enum Constellation;
    const TimeKnowledge& time = state_.time;
    if (time.leap_seconds && (!time.leap_source || time.leap_source == gps)) return std::nullopt;
    const Fix& fix = state_.epoch.fix;
    const auto told = [&](Constellation system) {
        const auto first = first_tracked_.find(system);
        if (first == first_tracked_.end() || !tracks(fix, system)) return false;
        const double tracking = difference(fix.time, first->second).value();
        switch (system) {
            case gps:
                return gps_utc_page.ended(first->second, fix.time);
            case galileo:
                return tracking >= galileo_utc_period_s;
            case beidou:
                return beidou_utc_page.ended(first->second, fix.time);
            case glonass:
                return tracking >= glonass_frame_s;
            default:
                return false;
        }
    };
    if (told(gps)) return gps;
    if (time.leap_seconds) return std::nullopt;
    for (const Constellation system : {galileo, beidou, glonass})
        if (told(system)) return system;
    return std::nullopt;
}

std::optional<GpsTime> StateTracker::first_tracking() const {
    std::optional<GpsTime> first;
    for (const auto& [system, time] : first_tracked_)
        first = std::min(first.value_or(time), time);
    return first;
}

BandMonitor StateTracker::monitor_band(const QuietBand& quiet, Decibels interference, bool watched) const {
    BandMonitor m;
    const double rise = std::max(0.0, interference.value());
    m.jamming_indicator = static_cast<int>(std::lround(std::min(255.0, quiet.indicator + indicator_per_db * rise)));
    m.agc = drift_.gain_count(quiet.gain - gain_per_db * rise);
    m.noise_per_ms = static_cast<int>(std::lround(std::min(65535.0, quiet.noise * std::pow(10.0, rise / 20))));
    if (!watched) return m;
    m.jamming_state = rise < interference_ok_db ? 1 : 2;
    if (rise >= interference_warning_db && !state_.epoch.fix.has_position()) m.jamming_state = 3;
    return m;
}

void StateTracker::monitor(const ReceiverConfig& config) {
    MonitorStatus& m = state_.monitors;
    const FrontEnd& front = state_.epoch.front_end;
    drift_.advance(state_.epoch.fix.time);
    m.upper = monitor_band(drift_.upper(), front.interference, config.watches_interference);
    if (board_.dual_frequency)
        m.lower = monitor_band(drift_.lower(), front.lower_interference, config.watches_interference);
    m.temperature = static_cast<int>(std::lround(drift_.temperature(state_.since_boot)));
    m.dice = drift_.dice();
    m.spoofing = config.reports_spoofing ? front.spoofing : SpoofingIndication::unknown;

    if (!config.watches_antenna) {
        m.antenna = AntennaStatus::unknown;
        m.antenna_power = 2;
        return;
    }
    m.antenna = front.antenna;
    const bool off = front.antenna == AntennaStatus::short_circuit && config.short_ends_supply;
    m.antenna_power = off ? 0 : 1;
}

namespace {

// The export limit of all receivers: "velocity 500 m/s" of their data sheets, whose direction they leave open.
constexpr double fastest_mps = 500;

double speed_in_space(const Fix& fix) { return std::hypot(fix.speed.value(), fix.velocity.down); }

double altitude_of(const Fix& fix) {
    return above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
}

}  // namespace

bool within_dynamic_model(std::uint64_t number, const Fix& fix, int generation) {
    const MotionLimits limits = motion_limits(dynamic_model_of(number), airborne_ceiling(generation));
    return speed_in_space(fix) <= fastest_mps && altitude_of(fix) <= limits.height.value() &&
           fix.speed <= limits.horizontal_speed && std::abs(fix.velocity.down) <= limits.vertical_speed.value();
}

Metres airborne_ceiling(int generation) {
    constexpr Metres up_to_m8(50'000), since_m9(80'000);
    return generation <= 8 ? up_to_m8 : since_m9;
}

bool within_export_limits(ExportLimits limits, const Fix& fix) {
    constexpr double highest_m = 18'288, fastest_of_export_mps = 515;
    const bool high = altitude_of(fix) > highest_m, fast = speed_in_space(fix) > fastest_of_export_mps;
    if (limits == ExportLimits::off) return true;
    return limits == ExportLimits::both_exceeded ? !(high && fast) : !(high || fast);
}

bool within_limits(const BoardProfile& board, std::uint64_t dynamic_model, const Fix& fix) {
    const bool moves_as_expected = board.dynamic_limits
                                       ? within_dynamic_model(dynamic_model, fix, board.identity.generation)
                                       : speed_in_space(fix) <= fastest_mps;
    return moves_as_expected && within_export_limits(board.export_limits, fix);
}

}  // namespace skyloop::firmware
