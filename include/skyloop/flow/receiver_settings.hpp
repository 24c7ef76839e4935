/// What the device under test has configured.
#pragma once

#include <set>

#include "skyloop/base/units.hpp"
#include "skyloop/gnss/signal.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// How the vehicle is expected to move (u-blox: CFG-NAV5 dynModel).
enum class DynamicModel { portable, stationary, pedestrian, automotive, sea, airborne_1g, airborne_2g, airborne_4g };

/// What a receiver still knows when it starts.
enum class StartKind {
    cold,  ///< nothing
    warm,  ///< time, place and almanac, no ephemerides
    hot,   ///< everything
};

/// A signal of one system.
struct SystemSignal {
    Constellation constellation = Constellation::gps;
    Signal signal = Signal::l1;
    auto operator<=>(const SystemSignal&) const = default;
};

/// How far a receiver has come with the corrections of a base station.
enum class CorrectionState { none, differential, rtk_float, rtk_fixed };

/// The settings that measurement, solution and the world outside the firmware must respect.
struct ReceiverSettings {
    Nanoseconds navigation_period{1'000'000'000};
    std::set<SystemSignal> signals{};  ///< that are tracked; empty: the first signal of every system
    Angle elevation_mask = Angle::degrees(5);
    DbHz minimum_cn0{6};  ///< of a satellite that is used
    DynamicModel dynamic_model = DynamicModel::portable;
    MetresPerSecond static_hold_below{0};  ///< 0: never held
    StartKind start = StartKind::hot;      ///< what the receiver knew at its last start
    int restarts = 0;                      ///< counts up with each restart; the receiver forgets what `start` says
    bool navigating = true;                ///< false: stopped by its user, it tracks nothing
    bool subframes = false;                ///< received subframes are wanted
    CorrectionState corrections = CorrectionState::none;  ///< of those that a client hands in

    [[nodiscard]] bool tracks(Constellation constellation, Signal signal) const {
        return signals.empty() ? signal == first_signal(constellation) : signals.contains({constellation, signal});
    }
};

}  // namespace skyloop
