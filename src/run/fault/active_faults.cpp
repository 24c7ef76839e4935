#include "run/fault/active_faults.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace skyloop::inline run {
namespace {

void append(std::vector<firmware::ReceiverEvent>& events, const std::vector<firmware::ReceiverEvent>& more) {
    events.insert(events.end(), more.begin(), more.end());
}

// At which a fault has the line run; nothing: it leaves it alone.
std::optional<std::uint32_t> forced_speed(const Fault& fault) {
    for (const firmware::ReceiverEvent& event : fault.at_start)
        if (const auto* forced = std::get_if<firmware::ForceBaud>(&event)) return forced->baud;
    return std::nullopt;
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
        const Fault over = std::move(running->fault);
        running = running_.erase(running);
        if (forced_speed(over))
            give_speed_back(over, static_cast<std::size_t>(running - running_.begin()));
        else
            append(events_, over.at_end);
    }
    return std::exchange(events_, {});
}

// The line runs as the youngest of those that force its speed has it.
// @param place which the fault had among those that are running
void ActiveFaults::give_speed_back(const Fault& over, std::size_t place) {
    for (std::size_t i = running_.size(); i-- > 0;) {
        const auto speed = forced_speed(running_[i].fault);
        if (!speed) continue;
        if (i < place) events_.emplace_back(firmware::ForceBaud{*speed, true});
        return;
    }
    append(events_, over.at_end);
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
        moment.strength_rate = left > 0 ? -moment.strength / ramp : 0;
        moment.strength *= left;
    } else if (moment.strength < 1) {
        moment.strength_rate = 1 / running.span.ramp_in.value();
    }
    return moment;
}

// An occurrence that fades works no more where the next of the same entry is as strong, nor that one before: twice the
// same step would be another one.
bool ActiveFaults::yields(const Running& running, GpsTime now) const {
    const double own = moment(running, now).strength;
    return std::any_of(running_.begin(), running_.end(), [&](const Running& other) {
        if (other.span.entry != running.span.entry || other.span.occurrence == running.span.occurrence) return false;
        const double strength = moment(other, now).strength;
        return strength > own || (strength == own && other.span.occurrence > running.span.occurrence);
    });
}

template <class Value>
void ActiveFaults::apply(Edit<Value> Fault::*edit, Value& value, const Trace& trace, MeasurementTerms* terms) {
    for (Running& running : running_) {
        if (!(running.fault.*edit) || yields(running, trace.truth.time)) continue;
        FaultMoment now = moment(running, trace.truth.time);
        now.truth = &trace.truth;
        now.sky = &trace.sky;
        now.lost_cycles = &lost_cycles_;
        now.terms = terms;
        (running.fault.*edit)(value, now);
    }
}

template <class Value>
Value ActiveFaults::collected(Edit<Value> Fault::*edit, GpsTime now) const {
    Value value;
    for (const Running& running : running_)
        if (running.fault.*edit && !yields(running, now)) (running.fault.*edit)(value, moment(running, now));
    return value;
}

void ActiveFaults::edit_arrivals(Trace& trace) { apply(&Fault::arrivals, trace.arrivals, trace); }
void ActiveFaults::edit_observations(Trace& trace) {
    Observations& observations = trace.epoch.observations;
    lost_cycles_.follow(observations);
    apply(&Fault::observations, observations, trace, &trace.measurement);
    lost_cycles_.apply(observations, trace.truth.time);
}
void ActiveFaults::edit_epoch(Trace& trace) { apply(&Fault::epoch, trace.epoch, trace); }
void ActiveFaults::edit_report(firmware::NavigationState& state, const Trace& trace) {
    apply(&Fault::report, state, trace);
}

firmware::FirmwareFaults ActiveFaults::firmware(GpsTime now) const { return collected(&Fault::firmware, now); }
WireConditions ActiveFaults::wire(GpsTime now) const { return collected(&Fault::wire, now); }
PaceConditions ActiveFaults::pace(GpsTime now) const { return collected(&Fault::pace, now); }

}  // namespace skyloop::inline run
