/// Every number of the measurement engine.
#pragma once

#include "base/core/random.hpp"
#include "receiver/measurement/receiver_clock.hpp"
#include "receiver/measurement/tracking_jitter.hpp"

namespace skyloop::inline receiver {

/// When signals are found, kept and lost (MODELS.md 7.9).
///
/// A search needs its threshold of C/N0 all along. It takes between 0.15 and all of its time: half of the rest by
/// strength (50 dB-Hz at once, the threshold last), half by chance, so that satellites appear one after another.
struct AcquisitionParameters {
    DbHz cold_threshold{33};  ///< C/N0 that a search needs when nothing is known
    DbHz warm_threshold{28};  ///< when time, place and almanac are; of hot starts and reacquisition too
    DbHz loss_threshold{22};  ///< below it for `loss_after`, lock is lost; at once when the signal no longer arrives
    Seconds loss_after{0.5};
    Seconds reacquisition{1};  ///< of a signal lost within `reacquisition_memory`; at least, of one lost before
    Seconds reacquisition_memory{60};
    Seconds hot_search{0};  ///< of a hot start, and of a satellite's second signals when its first is locked
    Seconds warm_search{6};
    Seconds cold_search{12};
    Seconds settled_after{60};      ///< a start: from then on everything is known, whatever its kind
    DbHz phase_threshold{26};       ///< C/N0 from which the carrier's phase is locked
    DbHz phase_loss_threshold{24};  ///< below it, it is lost
    Seconds pull_in{1};             ///< of code lock, until the phase is locked
    Seconds half_cycle_after{6};    ///< of phase lock, until the half cycle of a signal with data bits is resolved
};

/// Code multipath where no scene tells: a Gauss-Markov process per signal with σ = m0 + m1 exp(−e/10°) (MODELS.md
/// 7.10). The signals of one satellite are independent.
struct StatisticalMultipath {
    Metres floor{0.5};          ///< m0
    Metres at_horizon{1.0};     ///< m1
    Seconds static_time{120};   ///< correlation time at rest
    Seconds moving_time{5};     ///< above 1 m/s
    double phase_ratio = 0.01;  ///< of the carrier's error to the code's
};

/// A receiver's front end, loops and oscillator.
struct MeasurementParameters {
    CodeLoop code_loop;  ///< for signals of 1.023 Mchip/s; the chip rate of others follows in proportion
    CarrierLoop phase_loop{Hertz(15), Seconds(0.02)};
    CarrierLoop frequency_loop{Hertz(5), Seconds(0.02)};
    ReceiverClockParameters clock;
    AcquisitionParameters acquisition;
    StatisticalMultipath multipath_model;
    Decibels cn0_resolution{1};       ///< of the reported C/N0; 0: none
    Seconds scintillation_time{0.8};  ///< correlation time of scintillating phase (MODELS.md 7.11)
    double slips_per_hour = 0;        ///< of each tracked carrier in good conditions; more come with weak signals

    ErrorTerm code_noise, phase_noise, doppler_noise, multipath, receiver_clock, cycle_slips;
    ErrorTerm scintillation;  ///< its dice alone: how strong it is, what arrives says
};

}  // namespace skyloop::inline receiver
