/// Observations of one epoch as messages of RTCM 3, for whoever sends corrections.
#pragma once

#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/units.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::firmware {

/// What they are made from.
struct RtcmEpoch {
    const Observations& observations;
    int leap_seconds = 18;           ///< GPST − UTC, s
    MetresPerSecond clock_drift{0};  ///< of the receiver's clock, which the rates leave as the ranges leave its error
    int station = 0;                 ///< DF003
};

/// Whether there is anything to tell of a system: a signal with a range.
bool has_msm_signals(const RtcmEpoch& epoch, Constellation constellation);
/// The observations of a system, in as many messages as it takes where 64 cells do not hold them; all but the last say
/// that more follow.
/// @param number 1074 to 1137, of a kind 4 … 7
/// @param more of the epoch follow after these
std::vector<Bytes> msm_frames(const RtcmEpoch& epoch, int number, bool more);

/// The observations of GPS or GLONASS on L1, or L1 and L2, as they were told before. Empty without any.
/// @param number 1001 to 1004 or 1009 to 1012
Bytes legacy_frame(const RtcmEpoch& epoch, int number, bool more);

}  // namespace skyloop::firmware
