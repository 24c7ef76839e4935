#include "receiver/measurement/correlator_multipath.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

// A triangle of correlation of height `weight` around `delay`.
struct CorrelationPeak {
    double weight;
    double delay;
};

double correlation(double x) { return std::max(0.0, 1 - std::abs(x)); }

// Early minus late at the code phase x: zero where the loop settles.
double discriminator(const std::vector<CorrelationPeak>& peaks, double spacing, double x) {
    double sum = 0;
    for (const CorrelationPeak& peak : peaks)
        sum += peak.weight * (correlation(x - spacing / 2 - peak.delay) - correlation(x + spacing / 2 - peak.delay));
    return sum;
}

constexpr double vanishing = 1e-14;  // rounding of a sum of triangles

}  // namespace

double multipath_code_error_chips(std::span<const SignalEcho> echoes, double spacing_chips) {
    std::vector<CorrelationPeak> peaks{{1, 0}};
    for (const SignalEcho& echo : echoes)
        peaks.push_back({echo.amplitude * std::cos(echo.phase.rad()), echo.delay_chips});

    // Between the corners of its triangles the discriminator is a straight line: its roots are exact.
    std::vector<double> corners;
    for (const CorrelationPeak& peak : peaks)
        for (const double side : {-0.5, 0.5})
            for (const double corner : {-1.0, 0.0, 1.0})
                corners.push_back(peak.delay + side * spacing_chips + corner);
    std::sort(corners.begin(), corners.end());

    double nearest = corners.front();
    const auto consider = [&](double root) {
        if (std::abs(root) < std::abs(nearest)) nearest = root;
    };
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const double left = corners[i - 1], right = corners[i];
        const double at_left = discriminator(peaks, spacing_chips, left);
        const double at_right = discriminator(peaks, spacing_chips, right);
        const bool left_zero = std::abs(at_left) < vanishing, right_zero = std::abs(at_right) < vanishing;
        if (left_zero && right_zero)
            consider(std::clamp(0.0, left, right));
        else if (left_zero)
            consider(left);
        else if (right_zero)
            consider(right);
        else if ((at_left < 0) != (at_right < 0))
            consider(left + (right - left) * at_left / (at_left - at_right));
    }
    return nearest;
}

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

}  // namespace skyloop::inline receiver
