/// Faults of the signals in small runs, with the order of a simulation: effects, arrivals, measurement, observations,
/// solution, epoch.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "run/fault/fault_kind.hpp"
#include "support/model_sky.hpp"
#include "support/modern_run.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/sky/observe_sky.hpp"

namespace skyloop::test {

using FaultValues = std::map<std::string, ParameterValue, std::less<>>;

/// What a scenario that asks for this fault gets: its edits, or one sentence.
inline Result<Fault> asked_signal_fault(std::string_view name, const FaultValues& values, std::uint64_t seed = 1) {
    const FaultKind* kind = find_fault_kind(name);
    if (kind == nullptr) return fail(ErrorCode::usage, "no such fault: " + std::string(name));
    const CheckedParameters checked = check_parameters(kind->parameters, values);
    if (!checked.mistakes.empty())
        return fail(ErrorCode::usage, checked.mistakes[0].name + " " + checked.mistakes[0].sentence);
    return kind->make(checked.parameters, {seed, std::string(name)});
}

inline Fault signal_fault(std::string_view name, const FaultValues& values = {}, std::uint64_t seed = 1) {
    Result<Fault> fault = asked_signal_fault(name, values, seed);
    if (!fault) throw std::runtime_error(fault.error().message);
    return std::move(*fault);
}

/// The sentence with which the parameters are refused; empty when they are not.
inline std::string refusal_of(std::string_view name, const FaultValues& values) {
    const Result<Fault> fault = asked_signal_fault(name, values);
    if (fault) return "";
    EXPECT_EQ(fault.error().code, ErrorCode::usage);
    return fault.error().message;
}

inline const GpsTime signal_fault_start = to_gps_time(2300, 200000);

/// A fault of the run, when it works, s after the start, and for how long it grows, s.
struct TimedFault {
    Fault fault;
    double from = 0, to = 1e9, ramp_in = 0;
};

/// A receiver of the modern profile with faults.
class FaultyRun {
public:
    explicit FaultyRun(std::unique_ptr<Trajectory> trajectory, bool errors = true, std::uint64_t seed = 1)
        : settings_(settings_with(errors)),
          trajectory_(std::move(trajectory)),
          measurement_(settings_.measurement, seed),
          navigation_(settings_.navigation, {&systems_}) {
        auto made = modern_effects(settings_.propagation, context_of(settings_, systems_, seed));
        EXPECT_TRUE(made);
        if (made) effects_ = std::move(*made);
    }

    void add(Fault fault, double from, double to = 1e9, double ramp_in = 0) {
        faults_.push_back({std::move(fault), from, to, ramp_in});
    }
    ReceiverSettings& settings() { return receiver_; }

    /// The epoch so many seconds after the start; they ascend.
    Trace epoch(double since_start) {
        Trace trace;
        const GpsTime now = advanced(signal_fault_start, Seconds(since_start));
        trace.truth = trajectory_->at(now);
        trace.sky = observe_sky(trace.truth, systems_);
        trace.arrivals = free_space(trace.sky);
        trace.arrivals.antenna_speed = trace.truth.velocity.length();
        for (const auto& effect : effects_)
            effect->apply(trace.arrivals, trace.sky, trace.truth);
        edit(&Fault::arrivals, trace.arrivals, trace, since_start);
        Measurement measured = measurement_.measure(trace.arrivals, now, receiver_);
        trace.measurement = std::move(measured.terms);
        trace.epoch.observations = std::move(measured.observations);
        lost_cycles_.follow(trace.epoch.observations);
        edit(&Fault::observations, trace.epoch.observations, trace, since_start);
        lost_cycles_.apply(trace.epoch.observations, now);
        trace.epoch.fix = navigation_.solve(trace.epoch.observations, receiver_);
        for (const Arrival& arrival : trace.arrivals.satellites)
            if (arrival.cn0)
                trace.epoch.front_end.interference =
                    std::max(trace.epoch.front_end.interference, arrival.interference_loss);
        edit(&Fault::epoch, trace.epoch, trace, since_start);
        return trace;
    }
    /// Epochs of every second up to this one, which is returned.
    Trace until(double since_start) {
        Trace last;
        for (; next_ <= since_start; ++next_)
            last = epoch(next_);
        return last;
    }

private:
    static ModernSettings settings_with(bool errors) {
        ModernSettings settings = ModernSettings::of(ModernPreset::consumer);
        settings.errors = errors;
        return effective(settings);
    }
    template <class Value>
    void edit(Edit<Value> Fault::*which, Value& value, const Trace& trace, double since_start) {
        for (TimedFault& timed : faults_) {
            if (since_start < timed.from || since_start >= timed.to || !(timed.fault.*which)) continue;
            FaultMoment moment{trace.truth.time, Seconds(since_start - timed.from), 1, &trace.truth, &trace.sky,
                               &lost_cycles_};
            if (moment.since_start.value() < timed.ramp_in) {
                moment.strength = moment.since_start.value() / timed.ramp_in;
                moment.strength_rate = 1 / timed.ramp_in;
            }
            (timed.fault.*which)(value, moment);
        }
    }

    ModernSettings settings_;
    FourSystems systems_;
    std::unique_ptr<Trajectory> trajectory_;
    std::vector<std::unique_ptr<PropagationEffect>> effects_;
    MeasurementEngine measurement_;
    NavigationEngine navigation_;
    ReceiverSettings receiver_;
    std::vector<TimedFault> faults_;
    LostCycles lost_cycles_;
    double next_ = 0;
};

inline Geodetic fault_test_place() { return Geodetic::degrees(46.4774, 30.7326, 50); }

inline FaultyRun faulty_run_at_rest(bool errors = true) {
    return FaultyRun(std::make_unique<FixedPoint>(fault_test_place()), errors);
}

/// Reported less true position: east, north, up, m.
inline Eigen::Vector3d fix_error_enu(const Trace& trace) {
    return LocalFrame(trace.truth.geodetic).to_enu(to_ecef(trace.epoch.fix.position) - trace.truth.position).vector();
}

inline const SatelliteStatus* status_of(const Trace& trace, SatelliteId id) {
    for (const SatelliteStatus& status : trace.epoch.fix.satellites)
        if (status.id == id) return &status;
    return nullptr;
}

/// Ten satellites as free space lets them arrive, with three signals and C/N0 of 45 dB-Hz each.
struct ArrivalBench {
    SkyView sky = sky_of(ten_spots());
    TruthState truth = truth_at(fault_test_place(), signal_fault_start);
    Arrivals arrivals;

    ArrivalBench() {
        for (SatelliteInView& satellite : sky.satellites)
            for (const Signal signal : emulated_signals(Constellation::gps))
                satellite.signals.push_back({signal, carrier_frequency(signal), Seconds(0)});
        arrivals = free_space(sky);
        for (Arrival& arrival : arrivals.satellites)
            arrival.cn0 = DbHz(45);
    }
    /// @return the arrivals after the edit
    Arrivals after(const Fault& fault, double since_start = 0, double strength = 1) const {
        Arrivals edited = arrivals;
        fault.arrivals(edited,
                       {advanced(truth.time, Seconds(since_start)), Seconds(since_start), strength, &truth, &sky});
        return edited;
    }
};

/// How many satellites still arrive.
inline int arriving(const Arrivals& arrivals) {
    return static_cast<int>(std::count_if(arrivals.satellites.begin(), arrivals.satellites.end(),
                                          [](const Arrival& a) { return a.paths > 0; }));
}

}  // namespace skyloop::test
