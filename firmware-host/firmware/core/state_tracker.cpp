#include "firmware/core/state_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/geo/local_frame.hpp"
#include "firmware/core/base_station.hpp"
#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {
namespace {

// Of a receiver that finds no satellite for its first fix: what it shows after how long, s (RECEIVER.md 4.8, the middle
// of the ranges).
constexpr double first_satellite_cold = 3, first_satellite_warm = 1.5, first_satellite_hot = 0.5;
// One satellite after the other.
constexpr double between_satellites = 1.2;

// Growth of the accuracies while there is no solution, per second: 27 to 63 m in 5 s was captured (RECEIVER.md 4.10).
constexpr double accuracy_growth_mps = 7.2, speed_accuracy_growth = 0.5;

double horizontal_distance(const Geodetic& a, const Geodetic& b) {
    const Position<Enu> to = LocalFrame(a).to_enu(to_ecef(b));
    return std::hypot(to.vector().x(), to.vector().y());
}

// What a start leaves of a solution: where it was.
Fix place_of(const Fix& solved) {
    Fix place;
    place.position = solved.position;
    place.geoid_undulation = solved.geoid_undulation;
    place.horizontal_accuracy = unknown_horizontal_accuracy;
    place.vertical_accuracy = unknown_vertical_accuracy;
    place.speed_accuracy = unknown_speed_accuracy;
    return place;
}

// The accuracies of a solution so many seconds later. None is worse than those without any solution.
void grow_accuracies(const Fix& before, double seconds, Fix& fix) {
    const double metres = accuracy_growth_mps * seconds, speed = speed_accuracy_growth * seconds;
    fix.horizontal_accuracy = std::min(unknown_horizontal_accuracy, before.horizontal_accuracy + Metres(metres));
    fix.vertical_accuracy = std::min(unknown_vertical_accuracy, before.vertical_accuracy + Metres(metres));
    fix.speed_accuracy = std::min(unknown_speed_accuracy, before.speed_accuracy + MetresPerSecond(speed));
}

// A receiver looks for no satellite of a system that it does not have, or that is off, and for no SBAS satellite
// outside of its scan mask.
void leave_out_others(Fix& fix, const ReceiverConfig& config) {
    std::erase_if(fix.satellites, [&](const SatelliteStatus& s) {
        return !config.has_on(s.id.constellation) || !in_sbas_scan_mask(s.id, config.settings.sbas_scan_mask);
    });
}

}  // namespace

Forgotten Forgotten::by_mask(std::uint16_t mask) {
    const auto bit = [&](int n) { return (mask >> n & 1) != 0; };
    return {bit(0), bit(1), bit(2), bit(3), bit(4), bit(5) || bit(6), bit(7), bit(8)};
}

Forgotten Forgotten::of(StartKind kind) {
    if (kind == StartKind::cold) return by_mask(0xFFFF);
    Forgotten forgotten;
    forgotten.ephemerides = kind == StartKind::warm;
    return forgotten;
}

StartKind Forgotten::kind() const {
    if (position || rtc) return StartKind::cold;
    return ephemerides ? StartKind::warm : StartKind::hot;
}

void StateTracker::start(GpsTime now, const Forgotten& forgotten, bool running) {
    const bool keeps_place = !forgotten.position;
    const NavigationState before = std::move(state_);
    state_ = {};
    // The odometer goes on over all starts but a cold one (M8 interface description, UBX-NAV-ODO).
    if (forgotten.kind() != StartKind::cold) {
        state_.odometer_m = before.odometer_m;
        state_.odometer_total_m = before.odometer_total_m;
        state_.odometer_deviation_m = before.odometer_deviation_m;
    }
    if (keeps_place) {
        state_.ever_had_fix = before.ever_had_fix;
        state_.position_known = state_.only_place_known = before.position_known;
    }
    last_fix_ = place_of(keeps_place ? last_fix_ : Fix());
    if (state_.position_known) state_.epoch.fix = last_fix_;  // for polls before the first epoch
    started_ = running ? std::nullopt : std::optional(now);
    if (running)
        acquired_at_.reset();
    else
        begin_acquisition(now, forgotten.kind());
    state_.time.time = running || (before.time.time && !forgotten.rtc);
    state_.time.date = running || (before.time.date && !forgotten.rtc);
    state_.time.leap_seconds = running || (before.time.leap_seconds && !forgotten.rtc && !forgotten.utc);
    if (state_.time.leap_seconds) state_.time.leap_source = before.time.leap_source;
    state_.time.confirmed = running;
    // A clock that ran on a crystal alone since the last fix.
    state_.time.accuracy = Seconds(running ? 20e-9 : 1.0);
    first_tracked_.clear();
    first_fix_.reset();
    last_good_.reset();
    held_.reset();
    epochs_beyond_limits_ = 0;
    measured_ = false;
    state_.boot_cause = boot_cause_;
    if (running) state_.time_to_first_fix = board_.timing.cold_start;
}

const NavigationState& StateTracker::update(const Epoch& epoch, const ReceiverConfig& config,
                                            const CorrectionStatus& corrections) {
    const Fix before = state_.epoch.fix;
    if (state_.epoch.fix.time != GpsTime{}) ++state_.epoch_index;
    state_.epoch = epoch;
    Fix& fix = state_.epoch.fix;
    leave_out_others(fix, config);
    constexpr auto long_ago = std::chrono::hours(1);
    if (!booted_) booted_ = fix.time - long_ago;
    state_.since_boot = difference(fix.time, *booted_);
    state_.since_start = started_ ? difference(fix.time, *started_) : state_.since_boot;
    measured_ |= !epoch.observations.signals.empty();
    for (const SatelliteStatus& s : fix.satellites)
        if (s.cn0) first_tracked_.try_emplace(s.id.constellation, fix.time);

    acquire();
    keep_level(config);
    keep_within_limits(config);
    apply_corrections(corrections);
    coast(before);
    if (fix.has_position()) {
        hold(config);
        if (!first_fix_) first_fix_ = fix.time;
        if (!state_.time_to_first_fix) state_.time_to_first_fix = state_.since_start;
        state_.ever_had_fix = state_.position_known = true;
        state_.only_place_known = false;
    }
    learn_time();
    freeze_course();
    state_.turn_rate_dpm = turn_rate_.follow(told_heading(state_, board_.style.heading), fix.time);
    if (config.counts_distance) count_distance(before);
    monitor(config);
    if (fix.has_position()) last_fix_ = fix;
    survey(config);
    stand_still(config);
    return state_;
}

Seconds StateTracker::acquisition_time(StartKind kind) const {
    const Timing& t = board_.timing;
    return kind == StartKind::cold ? t.cold_start : kind == StartKind::warm ? t.warm_start : t.hot_start;
}

// What the receiver has not found out yet it does not know after a start that forgets nothing either: that start does
// not come to a fix before the unfinished one would have.
void StateTracker::begin_acquisition(GpsTime now, StartKind kind) {
    const bool unfinished = acquired_at_ && !first_fix_;
    const GpsTime own = advanced(now, acquisition_time(kind));
    acquired_at_ = unfinished ? std::max(own, *acquired_at_) : own;
    start_kind_ = unfinished ? std::min(start_kind_, kind) : kind;
}

// Models that measure nothing have a solution from the first epoch on: the time of acquisition is the board's.
void StateTracker::acquire() {
    Fix& fix = state_.epoch.fix;
    if (measured_ || !acquired_at_ || fix.time >= *acquired_at_) return;
    const double elapsed = state_.since_start.value();
    fix.type = FixType::none;
    const double first = start_kind_ == StartKind::cold   ? first_satellite_cold
                         : start_kind_ == StartKind::warm ? first_satellite_warm
                                                          : first_satellite_hot;
    double heard_from = first;
    std::vector<SatelliteStatus> found;
    for (SatelliteStatus s : fix.satellites) {
        if (!s.cn0) continue;
        if (elapsed < heard_from) break;
        heard_from += between_satellites;
        s.used = false;
        s.has_ephemeris = start_kind_ == StartKind::hot;
        found.push_back(s);
    }
    fix.satellites = std::move(found);
}

// A fix of two dimensions alone has a height that the user tells, above sea level (CFG-NAV5 fixedAlt).
void StateTracker::keep_level(const ReceiverConfig& config) {
    Fix& fix = state_.epoch.fix;
    if (!fix.has_position() || fix.type == FixType::dead_reckoning || config.limits.mode != FixMode::only_2d) return;
    fix.type = FixType::fix_2d;
    fix.position.height.above_ellipsoid = config.limits.height + fix.geoid_undulation;
    fix.vertical_accuracy = Metres(std::sqrt(config.limits.height_variance_m2));
    fix.velocity.down = 0;
    if (fix.correlation) fix.correlation->part_height();
    // Nothing is solved of the height, so that there is no DOP of it, nor one of all three.
    fix.dop.gdop = fix.dop.pdop = fix.dop.vdop = std::numeric_limits<double>::quiet_NaN();
}

// Fewer satellites than the user wants for a fix at all, or too few that are strong enough.
bool StateTracker::hears_too_little(const ReceiverConfig& config) const {
    const Fix& fix = state_.epoch.fix;
    if (fix.type == FixType::dead_reckoning) return false;
    constexpr std::uint64_t of_any_fix = 3;
    const FixLimits& limits = config.limits;
    const auto used = static_cast<std::uint64_t>(fix.satellites_used());
    if (limits.least_used > of_any_fix && used < limits.least_used) return true;
    const auto strong = std::count_if(fix.satellites.begin(), fix.satellites.end(),
                                      [&](const SatelliteStatus& s) { return s.cn0 && *s.cn0 >= limits.strong; });
    return static_cast<std::uint64_t>(strong) < limits.least_strong;
}

void StateTracker::keep_within_limits(const ReceiverConfig& config) {
    Fix& fix = state_.epoch.fix;
    state_.fix_ok = false;
    // A solution beyond the limits is not lost, so that nothing goes on in its place.
    if (fix.withheld) last_good_.reset();
    if (!fix.has_position()) return;
    constexpr int epochs_until_no_fix = 3;
    const bool moves_as_expected = within_limits(board_, static_cast<std::uint64_t>(config.limits.dynamic_model), fix);
    epochs_beyond_limits_ = moves_as_expected ? 0 : epochs_beyond_limits_ + 1;
    const bool two_d = fix.type == FixType::fix_2d;
    const bool mode_forbids = two_d && config.limits.mode == FixMode::only_3d;
    const bool untold = fix.type == FixType::dead_reckoning && !config.reports_dead_reckoning;
    const bool beyond = epochs_beyond_limits_ >= epochs_until_no_fix;
    if (beyond) last_good_.reset();
    if (beyond || mode_forbids || untold || hears_too_little(config)) {
        fix.type = FixType::none;
        return;
    }
    const double p_dop = config.limits.most_pdop, p_acc = config.limits.most_accuracy_m;
    const double accuracy = std::hypot(fix.horizontal_accuracy.value(), fix.vertical_accuracy.value());
    // Of two dimensions there is no other DOP of the position.
    const double dop = two_d ? fix.dop.hdop : fix.dop.pdop;
    state_.fix_ok = moves_as_expected && (p_dop <= 0 || dop <= p_dop) && (p_acc <= 0 || accuracy <= p_acc);
}

void StateTracker::apply_corrections(const CorrectionStatus& corrections) {
    state_.corrections = corrections;
    Fix& fix = state_.epoch.fix;
    // What measures has used them itself, or could not.
    if (measured_ || fix.type != FixType::fix_3d) return;
    switch (corrections.state) {
        case CorrectionState::none:
            return;
        case CorrectionState::differential:
            fix.type = FixType::dgnss;
            return;
        case CorrectionState::rtk_float:
            fix.type = FixType::rtk_float;
            return;
        case CorrectionState::rtk_fixed:
            fix.type = FixType::rtk_fixed;
            return;
    }
}

// A solution that is lost goes on with its last velocity for a while, and what is shown grows less certain.
void StateTracker::coast(const Fix& before) {
    Fix& fix = state_.epoch.fix;
    if (fix.has_position()) {
        last_good_ = fix.time;
        last_good_was_ok_ = state_.fix_ok;
        return;
    }
    if (!state_.position_known) return;
    const Fix now = fix;
    // The first epoch after a start has none before it.
    const bool first = before.time == GpsTime{};
    const Fix& known = first ? last_fix_ : before;
    const double step = first ? 0 : std::max(0.0, difference(now.time, before.time).value());
    fix = last_fix_;
    fix.time = now.time;
    fix.leap_seconds = now.leap_seconds;
    fix.satellites = now.satellites;
    for (SatelliteStatus& s : fix.satellites)
        s.used = false;
    fix.type = now.type;
    const bool coasting = last_good_ && difference(now.time, *last_good_).value() <= board_.timing.coasting.value();
    if (coasting) {
        fix.type = FixType::dead_reckoning;
        fix.position = carried(last_fix_.position, last_fix_.velocity, Seconds(step));
        state_.fix_ok = last_good_was_ok_;
    }
    // The clock runs on by the drift that was solved last.
    fix.clock_bias = known.clock_bias + Metres(fix.clock_drift.value() * step);
    grow_accuracies(known, step, fix);
}

// Position and speed stand still below the threshold until the antenna has left the place (RECEIVER.md 4.8).
void StateTracker::hold(const ReceiverConfig& config) {
    Fix& fix = state_.epoch.fix;
    const double threshold = config.limits.held_below.value(), farthest = config.limits.held_within.value();
    state_.position_held = false;
    if (threshold <= 0 || fix.speed.value() >= threshold) {
        held_.reset();
        return;
    }
    if (held_ && farthest > 0 && horizontal_distance(held_->position, fix.position) > farthest) held_.reset();
    if (!held_) held_ = fix;
    fix.position = held_->position;
    fix.course = held_->course;
    fix.velocity = {};
    fix.speed = MetresPerSecond(0);
    state_.position_held = true;
}

void StateTracker::adopt(const ReceiverConfig& config) {
    if (state_.survey && config.survey != state_.survey->limits()) state_.survey.reset();
}

void StateTracker::survey(const ReceiverConfig& config) {
    adopt(config);
    const Fix& fix = state_.epoch.fix;
    const auto limits = config.survey;
    if (!limits) return;
    if (!state_.survey) state_.survey.emplace(*limits, fix.time);
    const bool solved_in_space =
        fix.has_position() && fix.type != FixType::fix_2d && fix.type != FixType::dead_reckoning;
    state_.survey->take(fix, solved_in_space && state_.fix_ok);
}

// A base that knows where it stands solves for the time alone (RECEIVER.md 4.12). What was solved goes on beneath,
// for the epochs after it moves again.
void StateTracker::stand_still(const ReceiverConfig& config) {
    const auto place = base_place(config.place, state_.survey);
    if (!place) return;
    Fix& fix = state_.epoch.fix;
    const bool solved = fix.has_position() && fix.type != FixType::dead_reckoning;
    fix.type = solved ? FixType::time_only : FixType::none;
    state_.fix_ok = state_.fix_ok && solved;
    state_.ever_had_fix = state_.position_known = true;
    state_.only_place_known = false;
    fix.position = to_geodetic(place->position);
    fix.horizontal_accuracy = fix.vertical_accuracy = place->accuracy;
    fix.correlation.reset();
    fix.velocity = {};
    fix.speed = MetresPerSecond(0);
}

void StateTracker::freeze_course() {
    const Fix& fix = state_.epoch.fix;
    if (!fix.has_position()) return;
    state_.course_is_frozen = state_.position_held || fix.speed < board_.course_min_speed;
    if (!state_.course_is_frozen) state_.course = fix.course;
}

void StateTracker::count_distance(const Fix& before) {
    const Fix& fix = state_.epoch.fix;
    if (!fix.has_position() || !before.has_position() || state_.course_is_frozen) return;
    const double step = fix.speed.value() * std::max(0.0, difference(fix.time, before.time).value());
    state_.odometer_m += step;
    state_.odometer_total_m += step;
    state_.odometer_deviation_m += step * fix.speed_accuracy.value() / std::max(1.0, fix.speed.value());
}

// 9 wrist, 10 bike, 11 mower and 12 e-scooter move about as the nearest of the others.
DynamicModel dynamic_model_of(std::uint64_t number) {
    using enum DynamicModel;
    constexpr std::array models{portable,    stationary,  stationary, pedestrian, automotive, sea,       airborne_1g,
                                airborne_2g, airborne_4g, pedestrian, automotive, pedestrian, pedestrian};
    return number < models.size() ? models[number] : portable;
}

std::uint64_t dynamic_model_number(DynamicModel model) {
    constexpr std::array<std::uint64_t, 8> numbers{0, 2, 3, 4, 5, 6, 7, 8};
    return numbers[static_cast<std::size_t>(model)];
}

}  // namespace skyloop::firmware
