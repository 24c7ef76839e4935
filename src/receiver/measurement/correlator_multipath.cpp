#include "receiver/measurement/correlator_multipath.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "receiver/measurement/multipath_error.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

constexpr std::size_t most_echoes = 12;

// An echo as one signal's correlators see it.
struct HeardEcho {
    double delay_chips;
    Angle phase;
    double in_code, in_phase;  // amplitudes that code and phase loops follow
};

// What a loop of this bandwidth follows of a beat: noise bandwidth B is ω/4 of a first-order loop.
double loop_response(Hertz bandwidth, double beat_hz) {
    const double ratio = std::numbers::pi * beat_hz / (2 * bandwidth.value());
    return 1 / std::sqrt(1 + ratio * ratio);
}

std::vector<HeardEcho> heard_echoes(std::span<const Echo> echoes, const EchoedSignal& signal) {
    const double wavelength = speed_of_light / signal.carrier.value();
    const double chip = signal.code_loop.chip_length().value();
    // From here on an echo meets no correlator any more; the tracked ray's own error is less than half the spacing.
    const double too_late = 1.5 + signal.code_loop.spacing_chips;
    std::vector<HeardEcho> heard;
    for (const Echo& echo : echoes) {
        const double delay = echo.excess.value() / chip;
        if (std::abs(delay) > too_late || heard.size() == most_echoes) continue;
        const double beat = echo.excess_rate.value() / wavelength;
        const double cycles = echo.excess.value() / wavelength;
        const Angle lag = Angle::radians(2 * std::numbers::pi * (cycles - std::floor(cycles))) + echo.phase;
        heard.push_back({delay, lag, echo.amplitude * loop_response(signal.code_loop.bandwidth, beat),
                         echo.amplitude * loop_response(signal.phase_loop.bandwidth, beat)});
    }
    return heard;
}

// BOC(1,1)'s correlation is made of three triangles of half the width: 1 in the middle, −½ half a chip either side.
double code_error_chips(const std::vector<HeardEcho>& heard, const EchoedSignal& signal) {
    constexpr Angle reversed = Angle::degrees(180);
    std::vector<SignalEcho> rays;
    for (const HeardEcho& echo : heard)
        rays.push_back({echo.in_code, echo.delay_chips, echo.phase});
    const double spacing = signal.code_loop.spacing_chips;
    if (!signal.boc) return multipath_code_error_chips(rays, spacing);
    std::vector<SignalEcho> triangles{{0.5, -1, reversed}, {0.5, 1, reversed}};
    for (const SignalEcho& ray : rays) {
        triangles.push_back({ray.amplitude, 2 * ray.delay_chips, ray.phase});
        for (const double side : {-1.0, 1.0})
            triangles.push_back({ray.amplitude / 2, 2 * ray.delay_chips + side, ray.phase + reversed});
    }
    return multipath_code_error_chips(triangles, 2 * spacing) / 2;
}

double correlation_at(double chips, bool boc) {
    const double x = std::abs(chips);
    if (!boc) return std::max(0.0, 1 - x);
    return x < 0.5 ? 1 - 3 * x : std::min(0.0, x - 1);
}

// The correlator at this code phase, against the phase of the tracked ray; positive angles lag.
std::complex<double> composite(const std::vector<HeardEcho>& heard, double HeardEcho::*amplitude, double at, bool boc) {
    std::complex<double> sum = correlation_at(at, boc);
    for (const HeardEcho& echo : heard)
        sum += std::polar(echo.*amplitude * correlation_at(at - echo.delay_chips, boc), echo.phase.rad());
    return sum;
}

}  // namespace

CorrelatorMultipath correlator_multipath(std::span<const Echo> echoes, const EchoedSignal& signal) {
    const std::vector<HeardEcho> heard = heard_echoes(echoes, signal);
    if (heard.empty()) return {};
    const double error = code_error_chips(heard, signal);
    const std::complex<double> carrier = composite(heard, &HeardEcho::in_phase, error, signal.boc);
    const std::complex<double> prompt = composite(heard, &HeardEcho::in_code, error, signal.boc);
    CorrelatorMultipath result;
    result.code = signal.code_loop.chip_length() * error;
    result.phase = Metres(std::arg(carrier) / (2 * std::numbers::pi) * speed_of_light / signal.carrier.value());
    constexpr double faintest = 1e-3;  // rays that cancel leave noise
    result.strength = Decibels(20 * std::log10(std::max(std::abs(prompt), faintest)));
    if (std::abs(prompt) < faintest) return result;
    // Half a chip on either side the slopes of a clean peak are equal: of BOC, a quarter.
    const double side = signal.boc ? 0.25 : 0.5;
    const std::complex<double> skew = composite(heard, &HeardEcho::in_code, error - side, signal.boc) -
                                      composite(heard, &HeardEcho::in_code, error + side, signal.boc);
    result.distortion = (skew / prompt).real() / 2;
    return result;
}

}  // namespace skyloop
