/// Observations as RTCM 3 multiple signal messages of kind 4 and 7 (RTCM 10403.3, 3.5.16).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop {

/// One signal of one satellite.
struct Rtcm3MsmCell {
    int satellite = 1;                       ///< DF394: 1 … 64
    int signal = 2;                          ///< DF395: 1 … 32
    double range_m = 0;                      ///< pseudorange
    std::optional<double> phase_range_m;     ///< carrier phase times its wavelength, growing with the range
    std::optional<double> phase_range_rate;  ///< m/s, positive when the range grows
    double wavelength_m = 0.19;
    double lock_s = 0;  ///< without a break of the phase
    bool half_cycle_unknown = false;
    double cno_dbhz = 0;
    int satellite_info = 0;  ///< DF419: of GLONASS the channel + 7; else 0
};

/// All that one message of a system tells.
struct Rtcm3MsmObservations {
    int number = 1077;                ///< of kind 4 or 7
    int station = 0;                  ///< DF003
    std::uint32_t epoch = 0;          ///< as Rtcm3MsmHeader::epoch
    bool more = false;                ///< more messages of the same epoch follow
    std::vector<Rtcm3MsmCell> cells;  ///< in any order
};

/// The frame. Phases that are further from the pseudorange than the fields reach are told whole kilometres of cycles
/// nearer, which only moves their unknown number of cycles. Satellites that would make more than 64 cells are left out,
/// those of the highest numbers first. Empty for other kinds and for no cells at all.
Bytes encode(const Rtcm3MsmObservations& observations);

}  // namespace skyloop
