/// What a receiver has at one navigation epoch.
/// What a receiver's monitors tell of its antenna and of the band.
/// From one antenna of a pair to the other.
#pragma once

#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/observations.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// The antenna's supply, as u-blox numbers it (MON-HW aStatus).
enum class AntennaStatus { initialising = 0, unknown = 1, ok = 2, short_circuit = 3, open = 4 };

/// What the spoofing detector says (NAV-STATUS spoofDetState).
enum class SpoofingIndication { unknown = 0, none = 1, indicated = 2, several = 3 };

/// What the front end sees at one epoch.
struct FrontEnd {
    Decibels interference;        ///< rise of the noise floor by interference, in the band of L1
    Decibels lower_interference;  ///< the same in that of L2 and L5
    AntennaStatus antenna = AntennaStatus::ok;
    SpoofingIndication spoofing = SpoofingIndication::none;
};

/// The vector from the base antenna to this one, as the receiver solved it by carrier phases.
struct RelativePosition {
    double north_m = 0, east_m = 0, down_m = 0;
    Metres deviation;         ///< 1 σ of north and of east
    bool base_moves = true;   ///< a moving base: the heading of the vector means something
    bool fixed = true;        ///< the ambiguities are whole numbers
    int base_station = 0;     ///< 0 … 4095
    Metres down_deviation{};  ///< 1 σ
    Seconds age{0};           ///< of the base's data
    double ratio = 0;         ///< of the ratio test; 0 where none was passed
};

/// One navigation epoch, free of the truth.
struct Epoch {
    Fix fix;
    Observations observations{};        ///< empty for models that measure nothing
    std::vector<Subframe> subframes{};  ///< received since the epoch before, when the settings ask for them
    FrontEnd front_end{};
    std::optional<RelativePosition> relative{};  ///< to the base antenna of a pair
    /// What a compass beside the receiver says of its vehicle, from true north; nothing where the path tells no
    /// attitude.
    std::optional<Angle> compass_heading{};
};

}  // namespace skyloop::inline world
