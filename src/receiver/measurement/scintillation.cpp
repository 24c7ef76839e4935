#include "receiver/measurement/scintillation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace skyloop {
namespace {

// What the fading of the amplitude leaves of C/N0, and of T·C/N0 in the squaring loss.
struct FadedSignal {
    double tracked;
    double squared;
};

FadedSignal faded(CarrierToNoise cn0, double s4) {
    assert(s4 >= 0 && s4 < strongest_scintillation);
    return {cn0.ratio() * (1 - s4 * s4), cn0.ratio() * (1 - 2 * s4 * s4)};
}

}  // namespace

double nakagami_m(double s4) { return 1 / (s4 * s4); }

double scintillating_power(double s4, double in_phase, double quadrature) {
    if (!(s4 > 0)) return 1;
    const double m = nakagami_m(std::min(s4, 1.0)), root = std::sqrt(m * m - m);
    const double k = root / (m - root);
    const double steady = std::sqrt(k / (k + 1)), scattered = std::sqrt(1 / (2 * (k + 1)));
    const double along = steady + scattered * in_phase, across = scattered * quadrature;
    return along * along + across * across;
}

double scintillating_code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0, double s4) {
    const FadedSignal signal = faded(cn0, s4);
    const double squaring = 1 + 1 / (loop.integration.value() * signal.squared);
    return std::sqrt(loop.bandwidth.value() * loop.spacing_chips * squaring / (2 * signal.tracked));
}

Angle scintillating_phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double s4) {
    const FadedSignal signal = faded(cn0, s4);
    const double squaring = 1 + 1 / (2 * loop.integration.value() * signal.squared);
    return Angle::radians(std::sqrt(loop.bandwidth.value() * squaring / signal.tracked));
}

}  // namespace skyloop
