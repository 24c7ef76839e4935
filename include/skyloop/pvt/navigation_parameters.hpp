/// Every number of the navigation engine.
#pragma once

#include "skyloop/base/units.hpp"

namespace skyloop {

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
    double relative_humidity = 0.5;  ///< that the receiver assumes
};

/// Variance of a pseudorange: s0² + s1²/sin² e + the code loop's own variance (MODELS.md 7.13).
struct WeightParameters {
    Metres floor{0.9};      ///< s0
    Metres at_zenith{0.9};  ///< s1
};

/// The receiver's filter over the solutions of single epochs.
enum class FilterKind {
    none,      ///< every epoch stands alone
    smoothed,  ///< constant velocity, driven by position and Doppler velocity
};
struct FilterParameters {
    FilterKind kind = FilterKind::smoothed;
    Seconds position_memory{15};  ///< how long single positions are remembered at rest
    Seconds code_smoothing{0};    ///< of the code by the carrier (Hatch), before the solution; 0: none
    Seconds coasting{2};          ///< how long a lost fix is carried on, as dead reckoning
};

/// Who is believed.
struct IntegrityParameters {
    bool enabled = true;
    double false_alarm = 1e-5;  ///< of the chi-square test over the residuals
    int most_exclusions = 3;
};

/// Reported accuracies: the formal covariance times these.
struct AccuracyParameters {
    double position_scale = 1;
    double velocity_scale = 1;
};

struct NavigationParameters {
    CorrectionParameters corrections;
    WeightParameters weights;
    FilterParameters filter;
    IntegrityParameters integrity;
    AccuracyParameters accuracy;
    Seconds ephemeris_collection{30};  ///< of tracking, until a satellite's record has been received
};

}  // namespace skyloop
