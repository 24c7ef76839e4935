#include "firmware/core/power_save.hpp"

#include <algorithm>
#include <utility>

#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum PowerSaveState;

constexpr Nanoseconds acquisition_period = 500ms;  // of on and off
constexpr Nanoseconds ephemeris_grid = 30min;
// With CFG-PM-WAITTIMEFIX there are to be fixes for so long.
constexpr Nanoseconds steady_fix = 2s;

Nanoseconds week() { return std::chrono::seconds(seconds_per_week); }

bool is_solved(const NavigationState& report) {
    const Fix& fix = report.epoch.fix;
    return report.fix_ok && fix.has_position() && fix.type != FixType::dead_reckoning;
}

bool hears(const NavigationState& report) {
    const auto& satellites = report.epoch.fix.satellites;
    return std::any_of(satellites.begin(), satellites.end(), [](const SatelliteStatus& s) { return s.cn0; });
}

GpsTime next_half_hour(GpsTime after) { return after - after.time_since_epoch() % ephemeris_grid + ephemeris_grid; }

}  // namespace

void PowerSave::adopt(const PowerSaveSettings& settings) {
    const bool same = settings.mode == settings_.mode;
    settings_ = settings;
    if (!same && (!saves() || state_ == inactive)) state_ = full_power;
}

void PowerSave::restart(bool knows_ephemerides) {
    state_ = full_power;
    solved_since_.reset();
    if (!knows_ephemerides) download_due_.reset();
}

void PowerSave::enter(PowerSaveState state, GpsTime now) {
    state_ = state;
    since_ = now;
    heard_ = false;
    // With the first fix it has them.
    if (state == tracking && !download_due_) download_due_ = next_half_hour(now);
}

std::optional<PowerSave::Rest> PowerSave::update(const NavigationState& report) {
    if (!saves()) return std::nullopt;
    const GpsTime now = report.epoch.fix.time;
    if (!is_solved(report))
        solved_since_.reset();
    else if (!solved_since_)
        solved_since_ = now;
    switch (state_) {
        case full_power:
        case inactive:
            enter(enabled, now);
            break;
        case enabled:
            enter(acquisition, now);
            break;
        case acquisition:
            if (may_track(report)) enter(tracking, now);
            break;
        case tracking:
        case optimized:
            track(now);
            break;
    }
    heard_ = heard_ || hears(report);
    std::optional<Rest> rest;
    if (state_ == acquisition && gives_up(now)) rest = rest_until_search(report);
    const bool goes_off = settings_.mode == PowerMode::on_off && state_ == tracking;
    if (goes_off && !downloads(now) && on_time_is_over(now)) rest = rest_until_update(report);
    return rest;
}

// Optimized tracking is left for tracking when signals are lost, or ephemerides are due; tracking for a search only
// when there is still no fix.
void PowerSave::track(GpsTime now) {
    if (state_ == tracking) {
        if (!solved_since_) return enter(acquisition, now);
        if (settings_.mode == PowerMode::cyclic && !downloads(now) && on_time_is_over(now)) enter(optimized, now);
        return;
    }
    const bool due = settings_.update_ephemerides && download_due_ && now >= *download_due_;
    if (settings_.mode != PowerMode::cyclic || !solved_since_ || due) enter(tracking, now);
}

bool PowerSave::may_track(const NavigationState& report) const {
    if (!solved_since_) return false;
    const GpsTime now = report.epoch.fix.time;
    if (!settings_.never_off && difference(now, since_) < settings_.least_acquisition) return false;
    if (!settings_.wait_for_time) return true;
    return report.time.time && report.time.accuracy <= settings_.time_accuracy && now - *solved_since_ >= steady_fix;
}

bool PowerSave::gives_up(GpsTime now) const {
    if (settings_.never_off) return false;
    const bool own = settings_.longest_acquisition.value() <= 0;
    Seconds limit = own ? ability_.acquisition : settings_.longest_acquisition;
    if (!heard_ && ability_.blind_acquisition.value() > 0) limit = std::min(limit, ability_.blind_acquisition);
    return difference(now, since_) >= std::max(limit, settings_.least_acquisition);
}

bool PowerSave::on_time_is_over(GpsTime now) const { return difference(now, since_) >= settings_.on_time; }

// Whether it has to go on tracking for ephemerides.
bool PowerSave::downloads(GpsTime now) {
    if (!settings_.update_ephemerides || !download_due_ || now < *download_due_) return false;
    if (difference(now, std::max(since_, *download_due_)) < ability_.download) return true;
    download_due_ = next_half_hour(now);
    return false;
}

// The grid begins anew with each week; before the time is known there is none.
GpsTime PowerSave::on_grid(GpsTime after, Nanoseconds period, const NavigationState& report) const {
    if (!report.time.time) return after + period;
    const Nanoseconds shift = std::chrono::seconds(settings_.in_utc ? report.epoch.fix.leap_seconds : 0);
    const Nanoseconds tow = (after.time_since_epoch() - shift) % week();
    const GpsTime begin = after - tow;
    const Nanoseconds first = settings_.grid_offset % period;
    if (tow < first) return begin + first;
    const Nanoseconds next = first + ((tow - first) / period + 1) * period;
    return next < week() ? begin + next : begin + week() + first;
}

PowerSave::Rest PowerSave::rest_until_update(const NavigationState& report) const {
    if (settings_.update_period <= 0s) return {};
    const GpsTime update = on_grid(report.epoch.fix.time, settings_.update_period, report);
    const bool downloads = settings_.update_ephemerides && download_due_;
    return {downloads ? std::min(update, *download_due_) : update};
}

PowerSave::Rest PowerSave::rest_until_search(const NavigationState& report) const {
    if (settings_.search_period <= 0s) return {};
    const Nanoseconds margin = std::min(to_nanoseconds(ability_.search_margin), settings_.search_period / 2);
    return {on_grid(report.epoch.fix.time + margin, settings_.search_period, report) - margin};
}

Nanoseconds PowerSave::navigation_period(Nanoseconds configured) const {
    const bool searches = state_ != tracking && state_ != optimized && state_ != inactive;
    if (settings_.mode == PowerMode::on_off && searches) return acquisition_period;
    const bool rests = settings_.mode == PowerMode::cyclic && state_ == optimized;
    return rests && settings_.cyclic_period > 0s ? settings_.cyclic_period : configured;
}

}  // namespace skyloop::firmware
