#include "run/emulator/simulation.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline run {
namespace {

void make_modelled_fix(ErrorModel& model, Trace& trace) {
    trace.epoch.fix = model.fix(trace.truth, trace.sky, trace.arrivals);
    trace.error_scale = model.last_scale();
}

// Both ascend by time, then satellite.
std::vector<Subframe> joined(std::vector<Subframe> subframes, std::vector<Subframe> messages) {
    const auto key = [](const Subframe& s) { return std::tuple(s.end, s.satellite, s.signal); };
    std::vector<Subframe> all;
    std::ranges::merge(std::move(subframes), std::move(messages), std::back_inserter(all), {}, key, key);
    return all;
}

// Of a receiver that is stopped: not even dead reckoning.
void withhold(Fix& fix) {
    Fix nothing;
    nothing.time = fix.time;
    nothing.leap_seconds = fix.leap_seconds;
    fix = std::move(nothing);
}

// The interference of the link budget raises the noise floor for all signals alike, however strong they are; of what it
// takes from codes of different rates the largest is told. Faults tell their own, by band.
FrontEnd front_end(const Arrivals& arrivals) {
    FrontEnd seen;
    for (const Arrival& arrival : arrivals.satellites)
        if (arrival.cn0) seen.interference = std::max(seen.interference, arrival.interference_loss);
    seen.lower_interference = seen.interference;
    return seen;
}

}  // namespace

Simulation::Simulation(Parts parts) : parts_(std::move(parts)), observer_(parts_.precise.get()) {
    if (parts_.osnma) subframes_.authenticate(parts_.osnma);
}

void Simulation::make_fix(MeasuringReceiver& receiver, Trace& trace, const ReceiverSettings& settings,
                          ActiveFaults* faults) {
    const Arrivals nothing;
    const Arrivals& heard = settings.navigating ? trace.arrivals : nothing;
    Epoch& epoch = trace.epoch;
    Measurement measured = receiver.measurement.measure(heard, trace.truth.time, settings);
    trace.measurement = std::move(measured.terms);
    epoch.observations = std::move(measured.observations);
    if (faults != nullptr) faults->edit_observations(trace);
    std::vector<Subframe> messages;
    if (parts_.sbas) messages = sbas_reception_.receive(epoch.observations, *parts_.sbas, trace.truth.time);
    receiver.navigation.hear(messages, settings);
    epoch.fix = receiver.navigation.solve(epoch.observations, settings);
    epoch.relative = receiver.navigation.relative();
    if (settings.subframes)
        epoch.subframes =
            joined(subframes_.receive(epoch.observations, *parts_.navigation, trace.truth.time), std::move(messages));
}

SkyView Simulation::view(const TruthState& truth) const {
    return observe_sky(truth, *parts_.navigation, parts_.precise.get());
}

Trace Simulation::run(GpsTime time, const ReceiverSettings& settings, ActiveFaults* faults) {
    Trace trace;
    trace.measures = measures();
    trace.truth = parts_.trajectory->at(time);
    trace.sky = observer_.observe(trace.truth, *parts_.navigation);
    trace.arrivals = free_space(trace.sky);
    trace.arrivals.antenna_speed = trace.truth.velocity.length();
    for (const auto& effect : parts_.effects)
        effect->apply(trace.arrivals, trace.sky, trace.truth);
    const FrontEnd front = front_end(trace.arrivals);
    if (faults != nullptr) faults->edit_arrivals(trace);
    if (auto* receiver = std::get_if<MeasuringReceiver>(&parts_.fix_maker))
        make_fix(*receiver, trace, settings, faults);
    else
        make_modelled_fix(*std::get<std::unique_ptr<ErrorModel>>(parts_.fix_maker), trace);
    if (!settings.navigating) withhold(trace.epoch.fix);
    trace.epoch.front_end = front;
    if (trace.truth.orientation) trace.epoch.compass_heading = trace.truth.orientation->attitude.yaw();
    if (faults != nullptr) faults->edit_epoch(trace);
    return trace;
}

void Simulation::relate(Trace& rover, const Trace* base) {
    auto* receiver = std::get_if<MeasuringReceiver>(&parts_.fix_maker);
    if (receiver == nullptr || !rover.epoch.fix.has_position()) return;
    if (base != nullptr) {
        ReferenceStation station;
        if (base->epoch.fix.has_position()) station.position = to_ecef(base->epoch.fix.position);
        station.moves = true;
        station.glonass_biases_known = true;
        station.epoch = {base->epoch.observations.receive_time, base->epoch.observations.signals};
        rover.epoch.relative = receiver->navigation.relate(rover.epoch.observations, station);
    }
    rover.epoch.fix.type = receiver->navigation.pair_type().value_or(rover.epoch.fix.type);
}

}  // namespace skyloop::inline run
