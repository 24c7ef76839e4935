/// What the device under test has configured.
/// Dynamic platform models and how far a vehicle may go in them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/reference_station.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline world {

/// How the vehicle is expected to move (u-blox: CFG-NAV5 dynModel).
enum class DynamicModel { portable, stationary, pedestrian, automotive, sea, airborne_1g, airborne_2g, airborne_4g };

/// Beyond these a receiver takes its own solution for wrong.
struct MotionLimits {
    static constexpr double any = std::numeric_limits<double>::infinity();
    Metres height{any};  ///< above mean sea level
    MetresPerSecond horizontal_speed{any};
    MetresPerSecond vertical_speed{any};
    double acceleration = any;  ///< m/s²
};

/// u-blox 8 / u-blox M8 receiver description (UBX-13003221), table of the dynamic platform models. Of the airborne
/// models the ceiling and the acceleration that they are named for: at full throttle of a quadcopter a receiver uses no
/// satellites with the model of 1 g, and goes on with that of 4 g (Betaflight issue 14330). Their speeds are not looked
/// at.
/// @param airborne_ceiling 50 km up to generation 8, 80 km from M9 on
constexpr MotionLimits motion_limits(DynamicModel model, Metres airborne_ceiling) {
    if (model >= DynamicModel::airborne_1g) {
        constexpr double g = 9.80665;
        constexpr std::array accelerations{1 * g, 2 * g, 4 * g};
        return {
            .height = airborne_ceiling,
            .acceleration =
                accelerations[static_cast<std::size_t>(model) - static_cast<std::size_t>(DynamicModel::airborne_1g)]};
    }
    struct Row {
        double height, horizontal_speed, vertical_speed;
    };
    constexpr std::array<Row, 5> below_airborne{
        {{12'000, 310, 50}, {9'000, 10, 6}, {9'000, 30, 20}, {6'000, 100, 15}, {500, 25, 5}}};
    const Row& row = below_airborne[static_cast<std::size_t>(model)];
    return {Metres(row.height), MetresPerSecond(row.horizontal_speed), MetresPerSecond(row.vertical_speed),
            MotionLimits::any};
}

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

/// Whether a receiver looks for a satellite; of other systems than SBAS always.
/// @param mask bit i stands for PRN 120 + i (u-blox: CFG-SBAS-PRNSCANMASK); 0: all
constexpr bool in_sbas_scan_mask(SatelliteId satellite, std::uint64_t mask) {
    constexpr int first = 20, bits = 64;  // S20 is PRN 120
    if (satellite.constellation != Constellation::sbas || mask == 0) return true;
    const int bit = satellite.number - first;
    return bit >= 0 && bit < bits && (mask >> bit & 1) != 0;
}

/// The settings that measurement, solution and the world outside the firmware must respect.
struct ReceiverSettings {
    Nanoseconds navigation_period{1'000'000'000};
    std::set<SystemSignal> signals{};  ///< that are tracked; empty: the first signal of every system
    std::uint64_t sbas_scan_mask = 0;  ///< of in_sbas_scan_mask()
    bool sbas_ranging = true;          ///< SBAS satellites are used as those of other systems
    bool sbas_corrections = true;      ///< what SBAS satellites say of others is used
    bool sbas_test_mode = false;       ///< of those, too, that say that they are tested
    bool beidou_b1c = false;           ///< BeiDou's first signal is B1C, of BeiDou-3's MEO and IGSO satellites alone
    std::size_t most_satellites = 0;   ///< that a solution takes, the strongest; 0: all
    Angle elevation_mask = Angle::degrees(5);
    DbHz minimum_cn0{6};  ///< of a satellite that is used
    DynamicModel dynamic_model = DynamicModel::portable;
    bool dynamic_limits = true;            ///< no fix beyond the limits of that model
    Metres airborne_ceiling{80'000};       ///< of a fix with an airborne model, above mean sea level
    MetresPerSecond static_hold_below{0};  ///< 0: never held
    MetresPerSecond course_held_below{0.3};
    StartKind start = StartKind::hot;  ///< what the receiver knew at its last start
    int restarts = 0;                  ///< counts up with each restart; the receiver forgets what `start` says
    bool navigating = true;            ///< false: stopped by its user, it tracks nothing
    bool subframes = false;            ///< received subframes are wanted
    Corrections corrections{};         ///< that a client hands in

    [[nodiscard]] bool tracks(Constellation constellation, Signal signal) const {
        return signals.empty() ? signal == first_signal(constellation) : signals.contains({constellation, signal});
    }
    [[nodiscard]] bool tracks(SatelliteId satellite, Signal signal) const {
        if (beidou_b1c && signal == Signal::b1i && !sends_modern_signals(satellite)) return false;
        return tracks(satellite.constellation, signal) && in_sbas_scan_mask(satellite, sbas_scan_mask);
    }
};

}  // namespace skyloop::inline world
