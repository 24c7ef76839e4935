/// How a receiver goes on and off by itself to save power.
#pragma once

#include <optional>

#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {

/// The states Acquisition, Tracking, optimized tracking and Inactive (NEO-M9N integration manual UBX-19014286, 3.11.2;
/// MAX-M10S UBX-20053088, 2.7.2; u-blox 6 receiver description, 9.3). It decides; who acts on it is the receiver.
///
/// State: where it is and since when. Times of update() never go back but with a restart.
class PowerSave {
public:
    /// A time of being off.
    struct Rest {
        std::optional<GpsTime> until;  ///< nothing: until it is woken
    };

    explicit PowerSave(const PowerAbility& ability) : ability_(ability) {}

    void adopt(const PowerSaveSettings& settings);
    /// Navigation starts. @param knows_ephemerides those of before
    void restart(bool knows_ephemerides);
    /// The next epoch that it is on. @param report of it, before faults edit what is told
    /// @return that it goes off after the epoch, or nothing
    std::optional<Rest> update(const NavigationState& report);
    /// The receiver is off.
    void go_off() { state_ = PowerSaveState::inactive; }
    [[nodiscard]] PowerSaveState state() const { return state_; }
    [[nodiscard]] bool saves() const { return settings_.mode != PowerMode::full; }
    /// That of its epochs. @param configured by CFG-RATE
    [[nodiscard]] Nanoseconds navigation_period(Nanoseconds configured) const;

private:
    void enter(PowerSaveState state, GpsTime now);
    void track(GpsTime now);
    [[nodiscard]] bool may_track(const NavigationState& report) const;
    [[nodiscard]] bool gives_up(GpsTime now) const;
    [[nodiscard]] bool on_time_is_over(GpsTime now) const;
    bool downloads(GpsTime now);
    [[nodiscard]] Rest rest_until_update(const NavigationState& report) const;
    [[nodiscard]] Rest rest_until_search(const NavigationState& report) const;
    [[nodiscard]] GpsTime on_grid(GpsTime after, Nanoseconds period, const NavigationState& report) const;

    const PowerAbility& ability_;
    PowerSaveSettings settings_;
    PowerSaveState state_ = PowerSaveState::full_power;
    GpsTime since_{};
    std::optional<GpsTime> solved_since_;  ///< of a solution without a gap
    bool heard_ = false;                   ///< a satellite, in this search
    std::optional<GpsTime> download_due_;  ///< when ephemerides are to be had again
};

}  // namespace skyloop::firmware
