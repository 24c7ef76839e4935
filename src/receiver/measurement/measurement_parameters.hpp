/// Every number of the measurement engine.
#pragma once

#include <array>
#include <optional>

#include "base/core/random.hpp"
#include "receiver/measurement/receiver_clock.hpp"
#include "receiver/measurement/tracking_jitter.hpp"
#include "world/gnss/satellite.hpp"

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
    Seconds reacquisition{1};           ///< of a signal that was lost, at the longest
    double reacquisition_growth{0.02};  ///< s of that search for each second that it was away, up to 300 s
    Seconds hot_search{0};  ///< of a hot start, and of a satellite's second signals when its first is locked
    Seconds warm_search{6};
    Seconds cold_search{12};
    Seconds settled_after{60};  ///< the first signal of a start: from then on everything is known, whatever its kind
    DbHz phase_threshold{26};   ///< C/N0 from which the carrier's phase is locked
    DbHz phase_loss_threshold{24};  ///< below it, it is lost
    Seconds pull_in{1};             ///< of code lock, until the phase is locked
    Seconds half_cycle_after{6};    ///< of phase lock, until the half cycle of a signal with data bits is resolved
};

/// Code multipath where no scene tells: a Gauss-Markov process per signal with σ = m0 + m1 exp(−e/10°) (MODELS.md
/// 7.10). The signals of one satellite are independent.
struct StatisticalMultipath {
    Metres floor{0.5};         ///< m0
    Metres at_horizon{1.0};    ///< m1
    Seconds static_time{120};  ///< correlation time at rest
    Seconds horizon_time{0};   ///< what comes to it at the horizon, times exp(−e/10°)
    Seconds moving_time{5};    ///< above 1 m/s
    /// Of the carrier's error to the code's. L1 − L2 of phases, less a parabola over 280 s, leaves 2.7 mm of a ZED-F9T
    /// and 1.0 mm of a mosaic-X5 at 45 dBHz; with this 2.5 and 1.1 mm (docs/fidelity.md).
    double phase_ratio = 0.003;
};

/// What the receiver's own filters delay, constant, of both signals of a satellite alike.
struct ReceiverBiases {
    std::array<Metres, constellation_names.size()> systems{};  ///< of the code, by Constellation, against GPS
    /// For each number of the channel of GLONASS, of the code and of the carrier's phase. Receivers have up to metres
    /// of the one and centimetres of the other (L. Wanninger (2012), Carrier-phase inter-frequency biases of GLONASS
    /// receivers, Journal of Geodesy 86, 139-148).
    Metres glonass_channel_code{0}, glonass_channel_phase{0};
};

/// A receiver's front end, loops and oscillator.
struct MeasurementParameters {
    CodeLoop code_loop;            ///< for signals of 1.023 Mchip/s; the chip rate of others follows in proportion
    DbHz aiding_threshold{-100};   ///< C/N0 from which the carrier aids the code loop
    Hertz unaided_bandwidth{0.5};  ///< of the code loop below it
    CarrierLoop phase_loop{Hertz(15), Seconds(0.02)};
    CarrierLoop frequency_loop{Hertz(5), Seconds(0.02)};
    ReceiverClockParameters clock;
    AcquisitionParameters acquisition;
    StatisticalMultipath multipath_model;
    double multipath_share = 1;      ///< of it, that its correlators leave
    Seconds multipath_smoothing{0};  ///< of it, by a code loop that the carrier aids
    Seconds doppler_window{
        0.1};                ///< of the carrier, whose change over it is the Doppler; 0: that of the frequency loop
    Decibels cn0_offset{0};  ///< of the reported C/N0
    /// Of what it says of its ranges' deviation, beside the code loop; nothing: what the correlators leave of m0.
    std::optional<Metres> range_deviation_floor{};
    Metres range_deviation_weak{0};   ///< and this of a signal of 30 dB-Hz, tenfold for each 10 dB less
    Decibels cn0_resolution{1};       ///< of the reported C/N0; 0: none
    Seconds scintillation_time{0.8};  ///< correlation time of scintillating phase (MODELS.md 7.11)
    double slips_per_hour = 0;        ///< of each tracked carrier in good conditions; more come with weak signals
    ReceiverBiases biases{};

    ErrorTerm code_noise, phase_noise, doppler_noise, multipath, receiver_clock, cycle_slips;
    ErrorTerm receiver_biases;
    ErrorTerm scintillation;  ///< its dice alone: how strong it is, what arrives says
};

}  // namespace skyloop::inline receiver
