/// How a receiver's report of itself goes on from epoch to epoch.
#pragma once

#include <optional>

#include "firmware/navigation_state.hpp"
#include "skyloop/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// What a restart forgets (CFG-RST navBbrMask; RECEIVER.md 4.8).
struct Forgotten {
    bool ephemerides = false, almanac = false, health = false, ionosphere = false, position = false, clock = false,
         utc = false, rtc = false;
    static Forgotten by_mask(std::uint16_t nav_bbr_mask);
    /// hot: nothing but the state of tracking; warm: ephemerides; cold: everything.
    [[nodiscard]] StartKind kind() const;
};

/// Validity of time and date, time to first fix, coasting, limits of the dynamic models and of export, static hold,
/// course freezing, monitors, odometer: RECEIVER.md 4.8 to 4.11.
class StateTracker {
public:
    explicit StateTracker(const BoardProfile& board) : board_(board) {}

    /// The receiver starts, with what it has not forgotten. @param running it has been on for long, and knows all
    void start(GpsTime now, const Forgotten& forgotten, bool running = false);
    /// The next epoch, in the receiver's own words. @param corrections of CorrectionInput at that instant
    const NavigationState& update(const Epoch& epoch, const ConfigStore& config, const CorrectionStatus& corrections);
    [[nodiscard]] const NavigationState& state() const { return state_; }
    void reset_odometer() { state_.odometer_m = 0; }

private:
    const BoardProfile& board_;
    NavigationState state_;
};

}  // namespace skyloop::firmware
