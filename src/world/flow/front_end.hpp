/// What a receiver's monitors tell of its antenna and of the band.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

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

}  // namespace skyloop
