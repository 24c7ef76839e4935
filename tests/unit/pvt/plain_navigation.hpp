/// A navigation engine over the synthetic sky, for tests.
#pragma once

#include "receiver/pvt/navigation_engine.hpp"
#include "synthetic_sky.hpp"

namespace skyloop::test {

inline const Geodetic antenna = Geodetic::degrees(46.5, 30.7, 60);

inline NavigationParameters plain(FilterKind filter) {
    NavigationParameters parameters;
    parameters.corrections.ionosphere = IonosphereCorrection::none;
    parameters.corrections.troposphere = TroposphereCorrection::none;
    parameters.filter.kind = filter;
    return parameters;
}

// The receiver `seconds` later.
inline TrueReceiver later(TrueReceiver receiver, double seconds) {
    receiver.position = receiver.position_at(seconds);
    receiver.time = advanced(receiver.time, Seconds(seconds));
    receiver.clock_bias_m += seconds * receiver.clock_drift_mps;
    return receiver;
}

inline double error_of(const Fix& fix, const TrueReceiver& receiver) {
    return (to_ecef(fix.position).vector() - receiver.position).norm();
}

}  // namespace skyloop::test
