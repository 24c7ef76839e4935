#include "receiver/pvt/integrity.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace skyloop {
namespace {

constexpr int most_terms = 1000;
constexpr double negligible = 1e-16;

// Lower function by its series, upper function by its continued fraction; both less the common factor.
double gamma_series(double a, double x) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < most_terms && term > sum * negligible; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum;
}

double gamma_fraction(double a, double x) {
    constexpr double tiny = 1e-300;
    double b = x + 1 - a;
    double c = 1 / tiny;
    double d = 1 / b;
    double h = d;
    for (int n = 1; n < most_terms; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = an * d + b;
        if (std::abs(d) < tiny) d = tiny;
        c = b + an / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1 / d;
        h *= d * c;
        if (std::abs(d * c - 1) < negligible * 10) break;
    }
    return h;
}

// The equation with the largest normalised residual, of those that a residual can accuse.
std::optional<std::size_t> most_suspect(const SinglePoint& solution) {
    std::optional<std::size_t> worst;
    double largest = 0;
    for (std::size_t i = 0; i < solution.ranges.size(); ++i) {
        const RangeOutcome& r = solution.ranges[i];
        const double left = r.variance - r.cofactor;
        // A range that alone carries an unknown fits whatever it says.
        if (!r.used || left < 1e-6 * r.variance) continue;
        const double normalised = r.residual.value() * r.residual.value() / left;
        if (normalised > largest) {
            largest = normalised;
            worst = i;
        }
    }
    return worst;
}

}  // namespace

double upper_incomplete_gamma(double a, double x) {
    if (x <= 0) return 1;
    int sign = 1;  // positive for all a above 0; std::lgamma() would leave it in a variable that all threads share
    const double factor = std::exp(a * std::log(x) - x - ::lgamma_r(a, &sign));
    return x < a + 1 ? 1 - factor * gamma_series(a, x) : factor * gamma_fraction(a, x);
}

double chi_square_threshold(int degrees, double probability) {
    const double a = degrees / 2.0;
    double low = 0;
    double high = degrees + 10;
    while (upper_incomplete_gamma(a, high / 2) > probability && high < 1e6)
        high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
        const double middle = (low + high) / 2;
        (upper_incomplete_gamma(a, middle / 2) > probability ? low : high) = middle;
    }
    return (low + high) / 2;
}

IntegrityMonitor::IntegrityMonitor(const IntegrityParameters& parameters) : parameters_(parameters) {}

double IntegrityMonitor::threshold(int degrees) {
    const auto wanted = static_cast<std::size_t>(degrees);
    while (thresholds_.size() <= wanted) {
        const int next = static_cast<int>(thresholds_.size());
        thresholds_.push_back(next == 0 ? 0 : chi_square_threshold(next, parameters_.false_alarm));
    }
    return thresholds_[wanted];
}

std::optional<CheckedSolution> IntegrityMonitor::solve(std::span<RangeEquation> equations,
                                                       const SinglePointSetup& setup) {
    std::optional<SinglePoint> solution = solve_single_point(equations, setup);
    if (!solution) return std::nullopt;
    CheckedSolution checked{std::move(*solution), {}, true};
    if (!parameters_.enabled) return checked;
    SinglePointSetup again = setup;
    const auto fits = [this](const SinglePoint& s) {
        return s.redundancy < 1 || s.statistic <= threshold(s.redundancy);
    };
    for (int n = 0; n < parameters_.most_exclusions && !fits(checked.solution); ++n) {
        // One degree of freedom tells that something is wrong, not what.
        if (checked.solution.redundancy < 2) break;
        const std::optional<std::size_t> suspect = most_suspect(checked.solution);
        if (!suspect) break;
        equations[*suspect].excluded = true;
        again.start = checked.solution.position;
        std::optional<SinglePoint> without = solve_single_point(equations, again);
        if (!without) {
            equations[*suspect].excluded = false;
            break;
        }
        checked.excluded.push_back(equations[*suspect].satellite);
        checked.solution = std::move(*without);
    }
    checked.consistent = fits(checked.solution);
    return checked;
}

}  // namespace skyloop
