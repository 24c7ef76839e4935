/// RTCM 3 of a receiver of the run, as a base station sends it that stands where the antenna truly is.
/// The messages of a base station.
#pragma once

#include <string>
#include <vector>

#include "base/geo/frames.hpp"
#include "firmware/messages/rtcm_observations.hpp"
#include "run/output/epoch_messages.hpp"

namespace skyloop::inline run {

/// Who sends.
struct BaseStation {
    std::uint16_t number = 0;  ///< DF003, 0 … 4095
    Position<Ecef> antenna;    ///< the reference point, and the antenna's: its height is 0
    std::string version;       ///< of skyloop, as the receiver's firmware
    bool glonass = false;      ///< it observes it
    bool computed = false;     ///< it is no real station: DF141
};
/// 1006, 1008 and 1033, and with GLONASS 1230: aligned, with biases of 0. The antenna is none that anybody has
/// calibrated, and the receiver is skyloop.
std::vector<Bytes> station_frames(const BaseStation& station);
/// Multiple signal messages of all systems with observations; the last one says that no more follow.
/// @param kind of the messages, 4 … 7
std::vector<Bytes> observation_frames(const firmware::RtcmEpoch& epoch, int kind);

/// 1006, 1008, 1033 and, with GLONASS, 1230 every `every_s`; multiple signal messages of each epoch with observations;
/// records of the satellites that are observed every `ephemerides_s`. All of them at the first epoch, too. Nothing of
/// epochs of which the receiver says nothing, or knows no time. The antenna is none that anybody has calibrated, and
/// the receiver is skyloop.
EpochWriter make_rtcm_writer(const OutputSettings& settings, const WriterSources& sources);

}  // namespace skyloop::inline run
