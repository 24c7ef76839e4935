/// RTCM 3 of a receiver of the run, as a base station sends it that stands where the antenna truly is.
#pragma once

#include "run/output/epoch_messages.hpp"

namespace skyloop::inline run {

/// 1006, 1008, 1033 and, with GLONASS, 1230 every `every_s`; multiple signal messages of each epoch with observations;
/// records of the satellites that are observed every `ephemerides_s`. All of them at the first epoch, too. Nothing of
/// epochs of which the receiver says nothing, or knows no time. The antenna is none that anybody has calibrated, and
/// the receiver is skyloop.
EpochWriter make_rtcm_writer(const OutputSettings& settings, const WriterSources& sources);

}  // namespace skyloop::inline run
