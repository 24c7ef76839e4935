/// What a reference station tells: where it stands and what it measured.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline world {

/// What a reference station measured at one instant.
struct ReferenceEpoch {
    GpsTime time;                      ///< of reception, as its clock shows it
    std::vector<Observation> signals;  ///< ascending by satellite, then signal; without Doppler shifts
};

/// A reference station as its messages describe it.
struct ReferenceStation {
    int id = 0;                              ///< DF003, 0 … 4095
    std::optional<Position<Ecef>> position;  ///< of its antenna, as told, right or wrong
    bool moves = false;                      ///< it is the base of a moving pair: `position` is of the last epoch
    bool glonass_biases_known = false;       ///< it tells what its GLONASS codes are off by against its phases
    ReferenceEpoch epoch;                    ///< the last one that came whole
};

/// How far a receiver has come with the corrections of a base station.
enum class CorrectionState { none, differential, rtk_float, rtk_fixed };

/// What a receiver may do with the corrections that have come in.
struct Corrections {
    CorrectionState at_most = CorrectionState::none;      ///< best kind of solution, by its ability and its user
    std::shared_ptr<const ReferenceStation> reference{};  ///< null: none has told both place and observations
    Seconds differential_timeout{60};                     ///< age from which they are not used at all
    Seconds float_timeout{60};                            ///< age from which carrier phases are not used
    Seconds fixed_timeout{15};                            ///< age from which ambiguities are not fixed
};

}  // namespace skyloop::inline world
