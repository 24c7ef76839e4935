#include "skyloop/fault/active_faults.hpp"

#include <algorithm>
#include <utility>

namespace skyloop {
namespace {

void append(std::vector<firmware::ReceiverEvent>& events, const std::vector<firmware::ReceiverEvent>& more) {
    events.insert(events.end(), more.begin(), more.end());
}

}  // namespace

void ActiveFaults::begin(Fault fault, const FaultSpan& span) {
    append(events_, fault.at_start);
    running_.push_back({std::move(fault), span, std::nullopt});
}

void ActiveFaults::end(std::size_t entry, int occurrence, GpsTime now) {
    for (Running& running : running_)
        if (running.span.entry == entry && running.span.occurrence == occurrence && !running.end) running.end = now;
}

std::vector<firmware::ReceiverEvent> ActiveFaults::settle(GpsTime now) {
    for (auto running = running_.begin(); running != running_.end();) {
        if (!running->end || now < advanced(*running->end, running->span.ramp_out)) {
            ++running;
            continue;
        }
        append(events_, running->fault.at_end);
        running = running_.erase(running);
    }
    return std::exchange(events_, {});
}

std::optional<GpsTime> ActiveFaults::next_faded() const {
    std::optional<GpsTime> next;
    for (const Running& running : running_) {
        if (!running.end) continue;
        const GpsTime faded = advanced(*running.end, running.span.ramp_out);
        if (!next || faded < *next) next = faded;
    }
    return next;
}

double ActiveFaults::strength(std::size_t entry, int occurrence, GpsTime now) const {
    for (const Running& running : running_)
        if (running.span.entry == entry && running.span.occurrence == occurrence) return moment(running, now).strength;
    return 0;
}

// Both ramps are straight; one that ends before it has grown fades from where it is.
FaultMoment ActiveFaults::moment(const Running& running, GpsTime now) {
    const auto grown = [&](GpsTime at) {
        const double ramp = running.span.ramp_in.value();
        return ramp <= 0 ? 1.0 : std::clamp(difference(at, running.span.begin).value() / ramp, 0.0, 1.0);
    };
    FaultMoment moment;
    moment.now = now;
    moment.since_start = difference(now, running.span.begin);
    moment.strength = grown(running.end ? std::min(*running.end, now) : now);
    if (running.end && now > *running.end) {
        const double ramp = running.span.ramp_out.value();
        const double left = ramp <= 0 ? 0.0 : std::clamp(1 - difference(now, *running.end).value() / ramp, 0.0, 1.0);
        moment.strength *= left;
    }
    return moment;
}

template <class Value>
void ActiveFaults::apply(Edit<Value> Fault::*edit, Value& value, const Trace& trace) {
    for (Running& running : running_) {
        if (!(running.fault.*edit)) continue;
        FaultMoment now = moment(running, trace.truth.time);
        now.truth = &trace.truth;
        now.sky = &trace.sky;
        now.lost_cycles = &lost_cycles_;
        (running.fault.*edit)(value, now);
    }
}

template <class Value>
Value ActiveFaults::collected(Edit<Value> Fault::*edit, GpsTime now) const {
    Value value;
    for (const Running& running : running_)
        if (running.fault.*edit) (running.fault.*edit)(value, moment(running, now));
    return value;
}

void ActiveFaults::edit_arrivals(Trace& trace) { apply(&Fault::arrivals, trace.arrivals, trace); }
void ActiveFaults::edit_observations(Trace& trace) {
    Observations& observations = trace.epoch.observations;
    lost_cycles_.follow(observations);
    apply(&Fault::observations, observations, trace);
    lost_cycles_.apply(observations, trace.truth.time);
}
void ActiveFaults::edit_epoch(Trace& trace) { apply(&Fault::epoch, trace.epoch, trace); }
void ActiveFaults::edit_report(firmware::NavigationState& state, const Trace& trace) {
    apply(&Fault::report, state, trace);
}

firmware::FirmwareFaults ActiveFaults::firmware(GpsTime now) const { return collected(&Fault::firmware, now); }
WireConditions ActiveFaults::wire(GpsTime now) const { return collected(&Fault::wire, now); }
PaceConditions ActiveFaults::pace(GpsTime now) const { return collected(&Fault::pace, now); }

}  // namespace skyloop
