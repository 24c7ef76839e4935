#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"

namespace skyloop::inline run {
namespace {

constexpr double fastest_echo = 0.5;  // m/s by which an echo's excess changes: that of a reflector one drives along
constexpr int most_reflections = 2;

struct MultipathBurst {
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
    const MultipathBurst burst{context, parameters.number("share"), parameters.number("excess_m"),
                               parameters.number("amplitude"), parameters.number("change_s")};
    return fault_of_selected(parameters, [burst](Arrival& arrival, const SignalSelector&, const FaultMoment& moment) {
        if (arrival.paths == 0) return;
        const std::optional<Echo> echo = draw_echo(burst, arrival, moment);
        if (!echo || echo->amplitude <= 0) return;
        arrival.echoes_known = true;
        arrival.echoes.insert(arrival.echoes.begin(), *echo);
        ++arrival.paths;
    });
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

namespace {

// A fault that takes a satellite away altogether takes so many dB on the way there.
constexpr Decibels attenuation_before_silence{60};

// Of the signals that are selected, none is left.
void silence_signals(Arrival& arrival, const SignalSelector& selector) {
    bool left = false;
    for (SignalArrival& signal : arrival.signals) {
        if (selector.takes(signal.signal)) signal.arrives = false;
        left = left || signal.arrives;
    }
    // Sensor models know the first signal alone.
    if (!arrival.signals.empty() && !arrival.signals[0].arrives) arrival.cut_off = true;
    if (!left) silence(arrival);
}

void attenuate(Arrival& arrival, const SignalSelector& selector, Decibels loss) {
    arrival.power_offset -= weaken(
        arrival, [&](const SignalArrival& signal) { return selector.takes(signal.signal) ? loss : Decibels(0); });
}

Result<Fault> make_outage(const Parameters& parameters, const FaultContext&) {
    return fault_of_selected(parameters,
                             [](Arrival& arrival, const SignalSelector& selector, const FaultMoment& moment) {
                                 if (moment.strength < 1)
                                     attenuate(arrival, selector, attenuation_before_silence * moment.strength);
                                 else if (selector.by_signal())
                                     silence_signals(arrival, selector);
                                 else
                                     silence(arrival);
                             });
}

Result<Fault> make_cn0_drop(const Parameters& parameters, const FaultContext&) {
    const Decibels loss(parameters.number("attenuation_db"));
    return fault_of_selected(parameters,
                             [loss](Arrival& arrival, const SignalSelector& selector, const FaultMoment& moment) {
                                 attenuate(arrival, selector, loss * moment.strength);
                             });
}

template <AntennaStatus status>
Result<Fault> make_antenna_fault(const Parameters& parameters, const FaultContext&) {
    Fault fault;
    fault.arrivals = [loss = parameters.optional_number("attenuation_db")](Arrivals& arrivals,
                                                                           const FaultMoment& moment) {
        for (Arrival& arrival : arrivals.satellites) {
            if (!loss && moment.strength >= 1)
                silence(arrival);
            else
                attenuate(arrival, {}, Decibels(loss.value_or(attenuation_before_silence.value())) * moment.strength);
        }
    };
    fault.epoch = [](Epoch& epoch, const FaultMoment&) { epoch.front_end.antenna = status; };
    return fault;
}

constexpr ParameterSpec coupling_parameter = number_parameter(
    "attenuation_db", no_standard, 0, 100, "dB by which signals still come in weaker; not given: none comes in");

constexpr auto reception_kinds = std::to_array<FaultKind>({
    {"outage", "The selected satellites or signals no longer arrive; ramped, they fade by up to 60 dB first.",
     "Tunnels, hangars, a hand or a battery over the antenna, a system that fails as Galileo did in July "
     "2019.",
     signal_selector, make_outage},
    {"cn0_drop", "The selected signals arrive weaker by some dB.",
     "Water or ice on the antenna, a loose connector, banking that turns it away from a part of the sky, "
     "a noisy camera or video transmitter beside it.",
     ParameterList{needed_number("attenuation_db", 0, 100, "dB that are taken off C/N0")} + signal_selector,
     make_cn0_drop},
    {"antenna_open",
     "No satellite is heard and the antenna's supply is seen to be open.",
     "A cable pulled in a crash, a connector that vibration has undone.",
     {coupling_parameter},
     make_antenna_fault<AntennaStatus::open>},
    {"antenna_short",
     "No satellite is heard and the antenna's supply is seen to be shorted.",
     "A squeezed cable, water in a connector, a wrong antenna.",
     {coupling_parameter},
     make_antenna_fault<AntennaStatus::short_circuit>},
});

}  // namespace

std::vector<FaultKind> reception_fault_kinds() {
    return all_kinds_of(FaultLayer::signals,
                        {reception_kinds, {&jamming_fault, 1}, {&multipath_burst_fault, 1}, {&surroundings_fault, 1}});
}

}  // namespace skyloop::inline run
