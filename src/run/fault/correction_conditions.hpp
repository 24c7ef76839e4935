/// What becomes of corrections on a wire at one instant, as plain data.
#pragma once

#include <memory>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline run {

/// Coordinates of points by another frame of reference than the satellites' (ITRF).
class TerrestrialFrame;

/// Metres at the place that a base station tells.
struct PlaceOffset {
    double east_m = 0, north_m = 0, up_m = 0;

    [[nodiscard]] bool operator==(const PlaceOffset&) const = default;
};

/// RTCM 3 messages with right checksums are changed or missing; all else passes. Observations are MSM4 to 7, 1002,
/// 1004, 1010 and 1012; places are 1005, 1006 and 4072.0.
struct CorrectionConditions {
    double loss = 0;                                    ///< of each message, 0 … 1
    Seconds delay{0};                                   ///< of each message, besides that of all bytes
    Seconds least_period{0};                            ///< observations of epochs that follow sooner are missing
    bool frozen = false;                                ///< observations stay those of the first whole epoch
    bool without_glonass_biases = false;                ///< 1230 is missing
    std::vector<PlaceOffset> displaced{};               ///< the place is told by their sum
    std::shared_ptr<const TerrestrialFrame> told_in{};  ///< the place is told by this frame; null: by ITRF
    Metres code_multipath;                              ///< of every pseudorange, 1 σ
    Metres phase_multipath;                             ///< of every carrier phase, 1 σ

    [[nodiscard]] bool operator==(const CorrectionConditions&) const = default;
};

}  // namespace skyloop::inline run
