/// Every number of the navigation engine.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop::inline receiver {

/// What the receiver takes off the pseudoranges for the ionosphere.
enum class IonosphereCorrection {
    none,
    broadcast,  ///< each system's own coefficients: Klobuchar's of GPS and BeiDou, NTCM-G of Galileo; GPS's for the
                ///< rest
    klobuchar,  ///< GPS's coefficients for all, scaled to each carrier
};
/// And for the troposphere.
enum class TroposphereCorrection {
    none,
    saastamoinen,  ///< standard atmosphere, mapped by 1/sin e
    niell,         ///< the same zenith delays, mapped by Niell's functions
};

struct CorrectionParameters {
    IonosphereCorrection ionosphere = IonosphereCorrection::broadcast;
    TroposphereCorrection troposphere = TroposphereCorrection::niell;
    double relative_humidity = 0.5;   ///< that the receiver assumes
    bool default_ionosphere = false;  ///< where nothing is broadcast, default_klobuchar_coefficients()
    /// Of two carriers, where both are tracked, instead of a model. A signal whose group delay is not broadcast counts
    /// as one without, as emulated satellites send it: else no satellite of a receiver of L1 and L5 could be combined.
    bool ionosphere_free = false;
    /// Or the ionosphere that two carriers show, averaged for so long and weighed against the model; 0: not measured.
    Seconds ionosphere_memory{0};
};

/// Variance of a pseudorange: s0² + s1²/sin² e + the code loop's own variance (MODELS.md 7.13), and what the receiver
/// expects of a system's orbits and clocks beyond those of GPS.
struct WeightParameters {
    Metres floor{0.9};      ///< s0
    Metres at_zenith{0.9};  ///< s1
    Metres beidou_orbits{0.6};
    Metres glonass_orbits{1.5};
    MetresPerSecond range_rate{0.02};  ///< of a range rate, beside what the loop itself knows
};

/// Which of the tracked satellites are used: those that are as strong as `from`, and not weaker by more than `within`
/// than the fourth strongest; once used, until they are weaker than that by `hysteresis`. While there is a fix a new
/// one waits for `after`.
struct UseParameters {
    DbHz from{0};
    Decibels within{100};
    Decibels hysteresis{3};
    Seconds after{0};
};

/// The receiver's filter over the solutions of single epochs.
enum class FilterKind {
    none,      ///< every epoch stands alone
    smoothed,  ///< constant velocity, driven by position and Doppler velocity
};
struct FilterParameters {
    FilterKind kind = FilterKind::smoothed;
    Seconds position_memory{15};      ///< how long single positions are remembered at rest
    Seconds code_smoothing{0};        ///< of the code by the carrier (Hatch), before the solution; 0: none
    Seconds velocity_memory{0};       ///< of the reported velocity, in motion
    Seconds velocity_rest_memory{0};  ///< the same at rest
    Seconds coasting{2};              ///< how long a lost fix is carried on, as dead reckoning
    MetresPerSecond hold_below{0};    ///< below it the position is held, whatever the user has set
    Metres static_hold_radius{10};    ///< out of which a held position is let go
};

/// Who is believed.
struct IntegrityParameters {
    bool enabled = true;
    double false_alarm = 1e-5;  ///< of the chi-square test over the residuals
    int most_exclusions = 3;
};

/// Reported accuracies: what noise by weights and residuals, times the scales, and wrong corrections do to the
/// solution.
struct AccuracyParameters {
    double position_scale = 1;
    double velocity_scale = 1;
    double ionosphere_share = 0.38;   ///< σ of what the correction of the ionosphere is off by, of it, for all alike
    double grid_share = 0.1;          ///< the same of what SBAS tells of the ionosphere
    double ionosphere_tilt = 0.15;    ///< the same towards north and towards east, for a pierce point 9° away
    double troposphere_share = 0.02;  ///< σ of what the correction of the troposphere is off by, of it, for all alike
    /// Delays that are there and that the receiver is told not to correct: the whole of each is expected, 1 σ.
    bool whole_ionosphere = false, whole_troposphere = false;
};

/// Corrections from outside that the receiver uses, in the order of CorrectionState. Here they are a regime of the
/// measurements: whoever asks for one makes the measurements as good as it says. Corrections that a client hands in are
/// another way to the same solutions: they come with the measurements (ReceiverSettings::corrections) and prevail.
enum class DifferentialKind { none, sbas, rtk_float, rtk_fixed };
struct DifferentialParameters {
    DifferentialKind kind = DifferentialKind::none;
    double sbas_left = 0.1;            ///< of signal-in-space error and ionosphere, by SBAS
    double sbas_scale = 0.5;           ///< of the noise in the reported position accuracies
    Metres float_accuracy{0.3};        ///< reported, horizontal, up to an HDOP of 1; times the HDOP above it
    Metres fixed_accuracy{0.014};      ///< the same with integer ambiguities
    double vertical_proportion = 1.5;  ///< vertical over horizontal, of the two above, up to a VDOP of as much
};

/// How carrier phases are solved against those of a reference station. Deviations are of one end, 1 σ; what grows with
/// the baseline is that of differences between both ends.
struct CarrierParameters {
    Metres code_floor{0.6}, code_at_zenith{0.8};  ///< of a code: √(floor² + (at_zenith/sin e)²), more below 40 dBHz
    Seconds code_memory{45};                      ///< for which errors of a code last
    Seconds code_averaging{15};                   ///< by a loop, until half of what it will tell is told
    Metres phase_noise{0.001};                    ///< of a phase, new with each epoch
    Metres phase_echo_at_zenith{0.003};           ///< what echoes do to a phase, over sin e
    Seconds phase_memory{60};                     ///< for which that lasts
    MetresPerSecond per_age{0.0015};              ///< of both, for each second that the reference's data are old
    double ionosphere_per_length = 1e-6;          ///< at L1, slant
    Metres ionosphere_most{1};
    Seconds ionosphere_memory{900};
    double wet_per_length = 1e-6, wet_per_height = 5e-5;  ///< at the zenith
    Metres wet_most{0.05};
    Seconds wet_memory{7200};
    Angle integers_from = Angle::degrees(12);  ///< elevation of satellites whose ambiguities are fixed
    Seconds settled_after{1};                  ///< of tracking at both ends, an ambiguity may be fixed
    double least_gap = 20;                     ///< of IntegerCandidates::gap()
    double least_success = 0.4;                ///< of IntegerCandidates::success
    Metres most_when_fixed{0.1};               ///< deviation of a place in space that whole ambiguities give
    Seconds hold_after{5};                     ///< since they were fixed without a break, ambiguities are held
    Seconds memory{30};                        ///< of an ambiguity whose signal is missed
    int most_misfits = 3;             ///< epochs in which most phases contradict what is held, until all begins anew
    double told_per_length = 1.8e-6;  ///< of the reported accuracies over the DOP, beside the filter's
    Metres told_floor{0.008};         ///< the same
};

/// What the receiver must hear of the satellites' data.
struct DataParameters {
    DbHz decoding_cn0{25};            ///< from which bits are read
    Seconds almanac_collection{750};  ///< after a cold start: 25 pages of 30 s (IS-GPS-200, 20.3.3.5.1.2)
};

struct NavigationParameters {
    CorrectionParameters corrections;
    WeightParameters weights;
    UseParameters use;
    FilterParameters filter;
    IntegrityParameters integrity;
    AccuracyParameters accuracy;
    DifferentialParameters differential;
    CarrierParameters carrier;
    DataParameters data;
    /// Of tracking, until a satellite's record has been received. GPS sends it in 18 s of each 30 s (subframes 1 to 3,
    /// IS-GPS-200 20.3.2 and 20.3.3); of what lies between, this has the first fix when receivers have theirs
    /// (RECEIVER.md 4.8).
    Seconds ephemeris_collection{21};
    /// Where the antenna stands, when it was surveyed: with the stationary model time alone is solved.
    std::optional<Geodetic> fixed_position;
};

}  // namespace skyloop::inline receiver
