#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/signal_lock.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double strongest_signal = 50;     // dB-Hz; found first
constexpr double shortest_search = 0.15;    // of the whole time
constexpr double share_of_chance = 0.5;     // of what lies above the shortest
constexpr double certain_difference = 1.0;  // dB; keeps the share of strength finite for any threshold

DbHz search_threshold(const AcquisitionParameters& parameters, StartKind knowledge) {
    return knowledge == StartKind::cold ? parameters.cold_threshold : parameters.warm_threshold;
}

bool passed(GpsTime since, GpsTime now, Seconds span) { return difference(now, since) >= span; }

}  // namespace

void SignalLock::advance(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now) {
    if (!sight.cn0) {
        if (code_since_) lose(now);
        found_at_.reset();
        return;
    }
    if (code_since_)
        hold_code(parameters, *sight.cn0, now);
    else
        search(parameters, sight, now);
    if (code_since_) hold_phase(parameters, sight, now);
}

void SignalLock::forget() {
    found_at_.reset();
    weak_since_.reset();
    lost_at_.reset();
    code_since_.reset();
    pull_in_since_.reset();
    phase_since_.reset();
    half_cycle_resolved_ = false;
}

void SignalLock::search(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now) {
    const StartKind knowledge = lost_at_ ? StartKind::hot : sight.knowledge;
    if (!sight.searchable || !(*sight.cn0 >= search_threshold(parameters, knowledge))) {
        found_at_.reset();
        return;
    }
    if (!found_at_) found_at_ = advanced(now, search_time(parameters, knowledge, *sight.cn0, now));
    if (now < *found_at_) return;
    code_since_ = now;
    found_at_.reset();
}

void SignalLock::hold_code(const AcquisitionParameters& parameters, DbHz cn0, GpsTime now) {
    if (cn0 >= parameters.loss_threshold) {
        weak_since_.reset();
        return;
    }
    if (!weak_since_) weak_since_ = now;
    if (passed(*weak_since_, now, parameters.loss_after)) lose(now);
}

void SignalLock::hold_phase(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now) {
    const DbHz threshold = phase_since_ ? parameters.phase_loss_threshold : parameters.phase_threshold;
    if (!sight.phase_trackable || !(*sight.cn0 >= threshold)) {
        pull_in_since_.reset();
        phase_since_.reset();
        half_cycle_resolved_ = false;
        return;
    }
    if (!pull_in_since_) pull_in_since_ = now;
    if (!phase_since_ && passed(*pull_in_since_, now, parameters.pull_in)) phase_since_ = now;
    half_cycle_resolved_ = phase_since_ && (pilot_ || passed(*phase_since_, now, parameters.half_cycle_after));
}

void SignalLock::lose(GpsTime now) {
    forget();
    lost_at_ = now;
}

Seconds SignalLock::search_time(const AcquisitionParameters& parameters, StartKind knowledge, DbHz cn0, GpsTime now) {
    constexpr double longest_away = 300;  // s; from then on nothing more is forgotten
    const double chance = searches_.uniform();
    const double threshold = search_threshold(parameters, knowledge).value();
    const double weakness = std::clamp(
        (strongest_signal - cn0.value()) / std::max(strongest_signal - threshold, certain_difference), 0.0, 1.0);
    const double part =
        shortest_search + (1 - shortest_search) * (share_of_chance * chance + (1 - share_of_chance) * weakness);
    if (lost_at_) {
        const double away = std::min(difference(now, *lost_at_).value(), longest_away);
        return (parameters.reacquisition + Seconds(parameters.reacquisition_growth * away)) * part;
    }
    switch (knowledge) {
        case StartKind::cold:
            return parameters.cold_search * part;
        case StartKind::warm:
            return parameters.warm_search * part;
        case StartKind::hot:
            break;
    }
    return parameters.hot_search * part;
}

namespace {

constexpr double quiet_phase = 0.2;            // rad
constexpr double span_of_starts = 100;         // cycles, to either side: near the range, as u-blox starts its count
constexpr double share_of_single_slips = 0.8;  // the others are double

}  // namespace

double slips_per_second(const CarrierLoop& loop, Angle jitter) {
    if (!(jitter.rad() > quiet_phase)) return 0;
    return 2 * loop.bandwidth.value() * std::erfc(std::numbers::pi / 2 / (std::numbers::sqrt2 * jitter.rad()));
}

void CycleCount::start(bool half_unknown) {
    cycles_ = std::floor((2 * starts_.uniform() - 1) * span_of_starts);
    const bool half = starts_.uniform() < 0.5;
    if (half_unknown && half) cycles_ += 0.5;
}

bool CycleCount::slip(double expected, bool half_cycle_resolved) {
    // Two numbers each time, so that a weaker signal has the slips of a stronger one and more.
    const double happens = slips_.uniform(), kind = slips_.uniform();
    if (!(happens < -std::expm1(-expected))) return false;
    const double direction = kind < 0.5 ? -1 : 1;
    const double cycles = std::abs(2 * kind - 1) < share_of_single_slips ? 1 : 2;
    cycles_ += direction * cycles * (half_cycle_resolved ? 1.0 : 0.5);
    return true;
}

bool CycleCount::resolve_half_cycle() {
    const double whole = std::floor(cycles_);
    if (whole == cycles_) return false;
    cycles_ = whole;
    return true;
}

}  // namespace skyloop::inline receiver
