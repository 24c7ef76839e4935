/// Every number of the measurement engine.
#pragma once

#include "skyloop/base/error_term.hpp"
#include "skyloop/measurement/receiver_clock.hpp"
#include "skyloop/measurement/tracking_jitter.hpp"

namespace skyloop {

/// When signals are found, kept and lost (MODELS.md 7.9).
struct AcquisitionParameters {
    DbHz cold_threshold{33};  ///< C/N0 that a search needs when nothing is known
    DbHz warm_threshold{28};  ///< when time, place and almanac are
    DbHz loss_threshold{22};  ///< below it for `loss_after`, lock is lost
    Seconds loss_after{0.5};
    Seconds reacquisition{1};  ///< of a signal that was tracked within the last minute
    Seconds hot_search{0.5};   ///< until the first lock of a hot start; one satellite after another, seeded
    Seconds warm_search{6};
    Seconds cold_search{12};
    DbHz phase_threshold{26};     ///< C/N0 from which the carrier's phase is locked
    Seconds half_cycle_after{6};  ///< of phase lock, until the half cycle is resolved (a frame's preamble)
};

/// Code multipath where no scene tells: a Gauss-Markov process per signal with σ = m0 + m1 exp(−e/10°) (MODELS.md
/// 7.10).
struct StatisticalMultipath {
    Metres floor{0.5};         ///< m0
    Metres at_horizon{1.0};    ///< m1
    Seconds static_time{120};  ///< correlation time at rest
    Seconds moving_time{5};    ///< above 1 m/s
};

/// A receiver's front end, loops and oscillator.
struct MeasurementParameters {
    CodeLoop code_loop;
    CarrierLoop phase_loop{Hertz(15), Seconds(0.02)};
    CarrierLoop frequency_loop{Hertz(5), Seconds(0.02)};
    ReceiverClockParameters clock;
    AcquisitionParameters acquisition;
    StatisticalMultipath multipath_model;
    Decibels cn0_resolution{1};  ///< of the reported C/N0; 0: none
    double slips_per_hour = 0;   ///< of each tracked carrier in good conditions; more come with weak signals

    ErrorTerm code_noise, phase_noise, doppler_noise, multipath, receiver_clock, cycle_slips;
};

}  // namespace skyloop
