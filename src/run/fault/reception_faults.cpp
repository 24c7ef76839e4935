#include <algorithm>
#include <cmath>

#include "detail/arrival_edits.hpp"
#include "detail/catalogue_parts.hpp"
#include "detail/signal_selector.hpp"

namespace skyloop {
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
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    Fault fault;
    fault.arrivals = [selector = std::move(*selector)](Arrivals& arrivals, const FaultMoment& moment) {
        for (Arrival& arrival : arrivals.satellites) {
            if (!selector.takes(arrival)) continue;
            if (moment.strength < 1)
                attenuate(arrival, selector, attenuation_before_silence * moment.strength);
            else if (selector.by_signal())
                silence_signals(arrival, selector);
            else
                silence(arrival);
        }
    };
    return fault;
}

Result<Fault> make_cn0_drop(const Parameters& parameters, const FaultContext&) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    const Decibels loss(parameters.number("attenuation_db"));
    Fault fault;
    fault.arrivals = [selector = std::move(*selector), loss](Arrivals& arrivals, const FaultMoment& moment) {
        for (Arrival& arrival : arrivals.satellites)
            if (selector.takes(arrival)) attenuate(arrival, selector, loss * moment.strength);
    };
    return fault;
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
    return all_kinds_of(FaultLayer::signals, {reception_kinds, {&jamming_fault, 1}, {&multipath_burst_fault, 1}});
}

}  // namespace skyloop
