#include "receiver/measurement/multipath_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace skyloop {
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

}  // namespace skyloop
