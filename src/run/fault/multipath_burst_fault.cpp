#include <cmath>
#include <numbers>

#include "detail/catalogue_parts.hpp"
#include "detail/signal_selector.hpp"

namespace skyloop {
namespace {

constexpr double fastest_echo = 0.5;  // m/s by which an echo's excess changes: that of a reflector one drives along
constexpr int most_reflections = 2;

struct MultipathBurst {
    SignalSelector selector;
    FaultContext context;
    double share = 0.5;
    double excess = 60;  // m at most
    double amplitude = 0.7;
    double change = 5;  // s for which an echo lasts
};

// The echo of one satellite for one span of time; depends on nothing but their names.
std::optional<Echo> draw_echo(const MultipathBurst& burst, const Arrival& arrival, const FaultMoment& moment) {
    const double spans = std::floor(moment.since_start.value() / burst.change);
    RandomStream stream =
        burst.context.stream(to_string(arrival.id) + "." + std::to_string(static_cast<long long>(spans)));
    if (stream.uniform() >= burst.share) return std::nullopt;
    const double within = moment.since_start.value() - spans * burst.change;
    Echo echo;
    echo.from = {Angle::radians(2 * std::numbers::pi * stream.uniform()), Angle::radians(stream.uniform())};
    const double rate = fastest_echo * (2 * stream.uniform() - 1);
    // So far off that it stays behind the direct ray for as long as it lasts.
    const double nearest = fastest_echo * burst.change;
    echo.excess = Metres(nearest + std::max(burst.excess - nearest, 0.0) * stream.uniform() + rate * within);
    echo.excess_rate = MetresPerSecond(rate);
    echo.amplitude = burst.amplitude * (0.5 + 0.5 * stream.uniform()) * moment.strength;
    echo.phase = Angle::radians(2 * std::numbers::pi * stream.uniform());
    echo.reflections = stream.uniform() < 0.7 ? 1 : most_reflections;
    return echo;
}

Result<Fault> make_multipath_burst(const Parameters& parameters, const FaultContext& context) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    MultipathBurst burst{std::move(*selector),           context,
                         parameters.number("share"),     parameters.number("excess_m"),
                         parameters.number("amplitude"), parameters.number("change_s")};
    Fault fault;
    fault.arrivals = [burst = std::move(burst)](Arrivals& arrivals, const FaultMoment& moment) {
        for (Arrival& arrival : arrivals.satellites) {
            if (arrival.paths == 0 || !burst.selector.takes(arrival)) continue;
            const std::optional<Echo> echo = draw_echo(burst, arrival, moment);
            if (!echo || echo->amplitude <= 0) continue;
            arrival.echoes_known = true;
            arrival.echoes.insert(arrival.echoes.begin(), *echo);
            ++arrival.paths;
        }
    };
    return fault;
}

}  // namespace

constexpr FaultKind multipath_burst_fault{
    "multipath_burst",
    "Random satellites get an echo, each for a while: ranges are off by metres, C/N0 swings.",
    "Passing trucks, cranes, glass and metal façades, the metal roof under a landing drone.",
    ParameterList{number_parameter("share", 0.5, 0, 1, "of the satellites that have an echo at a time"),
                  number_parameter("excess_m", 60, 1, 500, "m of the echo's way over the direct one, at most"),
                  number_parameter("amplitude", 0.7, 0, 1, "of the strongest echoes over the direct ray"),
                  number_parameter("change_s", 5, 0.1, 3600, "s for which an echo lasts")} +
        satellite_selector,
    make_multipath_burst,
    of_measurements};

}  // namespace skyloop
