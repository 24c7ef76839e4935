#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline run {
namespace {

// Of a signal of nominal power in an isotropic antenna: −157 dBW over N0 of −204.6 dBW/Hz, less 2.5 dB of
// implementation loss (MODELS.md 7.7).
constexpr DbHz nominal_cn0{45.1};
// By which a jammer that is ramped grows, evenly in dB.
constexpr double ramp_range = 60;
// A loop integrates for so long at least, and an estimate of C/N0 remembers no longer, s.
constexpr double shortest_average = 0.02, longest_average = 1;
// The carriers of all systems lie between these, Hz: the band that a sweep covers.
constexpr double sweep_from = 1166e6, sweep_to = 1611e6;

// All that is told of a jammer.
struct Jammer {
    SignalSelector selector;
    JammerKind kind = JammerKind::matched;
    std::optional<double> j_to_s;    // dB
    std::optional<ToldPlace> place;  // or where it stands,
    double eirp = 0;                 // dBW
    std::optional<double> sweep;     // s for one pass over the band
    double sweep_duty = 0.2;         // of a pass, for which it hits a carrier
    double pulse_duty = 1;
    std::optional<double> pulse;  // s from one pulse to the next; absent: the average of them
};

// The time that an epoch stands for, s since the start of the fault: what a jammer does in it is averaged, as loops and
// estimates of C/N0 average it.
struct JammedTime {
    double from = 0, to = 0;
};

// Of what comes once in each period and is on for the first `duty` of it, the share of that time for which it is on.
double share_on(const JammedTime& time, double period, double duty, double phase) {
    const auto on_until = [&](double t) {  // periods' worth
        const double passed = t / period + phase, whole = std::floor(passed);
        return whole * duty + std::min(passed - whole, duty);
    };
    return std::clamp((on_until(time.to) - on_until(time.from)) * period / (time.to - time.from), 0.0, 1.0);
}

double sweep_share(const Jammer& jammer, Hertz carrier, const JammedTime& time) {
    if (!jammer.sweep) return 1;
    const double there = (carrier.value() - sweep_from) / (sweep_to - sweep_from);
    return share_on(time, *jammer.sweep, jammer.sweep_duty, jammer.sweep_duty / 2 - there);
}

double pulse_share(const Jammer& jammer, const JammedTime& time) {
    return jammer.pulse ? share_on(time, *jammer.pulse, jammer.pulse_duty, 0) : jammer.pulse_duty;
}

// An instant of the jammer.
struct JammedEpoch {
    const FaultMoment& moment;
    JammedTime time;
};

// J over a signal of nominal power, dB, while the jammer is on.
double jammer_to_nominal(const Jammer& jammer, Hertz carrier, const FaultMoment& moment) {
    const double ratio = jammer.j_to_s.value_or(0) - ramp_range * (1 - moment.strength);
    if (!jammer.place) return ratio;
    const double distance = (jammer.place->seen_from(*moment.truth) - moment.truth->position).length().value();
    const double waves = std::max(distance, 1.0) * carrier.value() / speed_of_light;
    return ratio + jammer.eirp - 20 * std::log10(4 * std::numbers::pi * waves) - nominal_signal_power.value();
}

// What the jammer takes on top of `before`, which others have taken: it raises the noise floor for every satellite
// alike, and a signal of nominal power stands for them all.
Decibels jammer_loss(const Jammer& jammer, Hertz carrier, const JammedEpoch& epoch, Decibels before) {
    const double share = sweep_share(jammer, carrier, epoch.time) * pulse_share(jammer, epoch.time);
    if (epoch.moment.strength <= 0 || share <= 0) return Decibels(0);
    const DbHz clear = nominal_cn0 - DbHz(before.value());
    const Decibels ratio(jammer_to_nominal(jammer, carrier, epoch.moment) + 10 * std::log10(share));
    return Decibels((clear - cn0_under_interference(clear, ratio, {rejection_quality(jammer.kind)})).value());
}

// The time from an epoch to the next, which is taken to come as soon as this one has come after the one before.
class EpochClock {
public:
    JammedTime next(Seconds since_start) {
        const double now = since_start.value();
        const double period = last_ ? std::clamp(now - *last_, shortest_average, longest_average) : longest_average;
        last_ = now;
        return {now, now + period};
    }

private:
    std::optional<double> last_;
};

// The largest rise of the noise floor, in the band of L1 and in that of L2 and L5.
struct NoiseRise {
    Decibels upper, lower;
};

NoiseRise jam(Arrivals& arrivals, const Jammer& jammer, const JammedEpoch& epoch) {
    constexpr Hertz between_bands(1.4e9);
    NoiseRise most;
    for (Arrival& arrival : arrivals.satellites) {
        if (!jammer.selector.takes(arrival)) continue;
        const Decibels before = arrival.interference_loss;
        arrival.interference_loss += weaken(arrival, [&](const SignalArrival& signal) {
            if (!jammer.selector.takes(signal.signal)) return Decibels(0);
            const Hertz carrier = signal.carrier.value() > 0 ? signal.carrier : Hertz(carrier_frequency_l1);
            const Decibels loss = jammer_loss(jammer, carrier, epoch, before);
            Decibels& band = carrier < between_bands ? most.lower : most.upper;
            band = std::max(band, before + loss);
            return loss;
        });
        // Sensor models know one signal, which stands for all.
        if (arrival.signals.empty() && jammer.selector.takes(Signal::l2)) most.lower = most.upper;
    }
    return most;
}

std::optional<Error> read_source(const Parameters& parameters, Jammer& jammer) {
    auto place = ToldPlace::read(parameters, "jammer_at");
    if (!place) return place.error();
    jammer.place = *place;
    jammer.j_to_s = parameters.optional_number("j_to_s_db");
    const auto eirp = parameters.optional_number("eirp_dbw");
    if (jammer.j_to_s && jammer.place)
        return Error{ErrorCode::usage, "both j_to_s_db and jammer_at are given; expected one of them"};
    if (!jammer.j_to_s && !jammer.place)
        return Error{ErrorCode::usage, "no jammer is told; expected j_to_s_db, or jammer_at and eirp_dbw"};
    if (jammer.place.has_value() != eirp.has_value())
        return Error{ErrorCode::usage, eirp ? "eirp_dbw is given without jammer_at; expected both, or j_to_s_db"
                                            : "jammer_at is given without eirp_dbw; expected both"};
    jammer.eirp = eirp.value_or(0);
    return std::nullopt;
}

std::optional<Error> read_times(const Parameters& parameters, Jammer& jammer) {
    jammer.sweep = parameters.optional_number("sweep_s");
    const auto sweep_duty = parameters.optional_number("sweep_duty");
    if (sweep_duty && !jammer.sweep)
        return Error{ErrorCode::usage, "sweep_duty is given without sweep_s; expected both"};
    jammer.sweep_duty = sweep_duty.value_or(jammer.sweep_duty);
    jammer.pulse = parameters.optional_number("pulse_s");
    const auto pulse_duty = parameters.optional_number("pulse_duty");
    if (jammer.pulse && !pulse_duty)
        return Error{ErrorCode::usage, "pulse_s is given without pulse_duty; expected both"};
    jammer.pulse_duty = pulse_duty.value_or(1);
    return std::nullopt;
}

Result<Fault> make_jamming(const Parameters& parameters, const FaultContext&) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    Jammer jammer;
    jammer.selector = std::move(*selector);
    const std::string spectrum = parameters.text("spectrum");
    jammer.kind = spectrum == "narrow" ? JammerKind::narrow_band
                  : spectrum == "wide" ? JammerKind::wide_band
                                       : JammerKind::matched;
    if (const auto error = read_source(parameters, jammer)) return fail(*error);
    if (const auto error = read_times(parameters, jammer)) return fail(*error);
    Fault fault;
    const auto rise = std::make_shared<NoiseRise>();
    fault.arrivals = [jammer, rise, clock = EpochClock()](Arrivals& arrivals, const FaultMoment& moment) mutable {
        *rise = {};
        const JammedTime time = clock.next(moment.since_start);
        if (jammer.place && moment.truth == nullptr) return;
        *rise = jam(arrivals, jammer, {moment, time});
    };
    fault.epoch = [rise](Epoch& epoch, const FaultMoment&) {
        FrontEnd& front = epoch.front_end;
        front.interference = std::max(front.interference, rise->upper);
        front.lower_interference = std::max(front.lower_interference, rise->lower);
    };
    return fault;
}

constexpr std::string_view spectra[] = {"narrow", "matched", "wide"};

constexpr ParameterList jamming_parameters{
    number_parameter("j_to_s_db", no_standard, -20, 150,
                     "dB of the jammer over a signal of nominal power (−157 dBW) at the antenna"),
    place_parameter("jammer_at", "where the jammer stands, in place of j_to_s_db: degrees, metres"),
    number_parameter("eirp_dbw", no_standard, -80, 60, "dBW that a jammer at a place radiates"),
    word_parameter("spectrum", "matched", spectra, "its spectrum against the signals'"),
    number_parameter("sweep_s", no_standard, 1e-3, 3600, "s for one pass from 1166 to 1611 MHz; epochs see the share"),
    number_parameter("sweep_duty", no_standard, 0.001, 1, "of a pass, for which it hits a carrier; 0.2"),
    number_parameter("pulse_duty", no_standard, 1e-4, 1, "of the time, for which it is on"),
    number_parameter("pulse_s", no_standard, 1e-3, 3600,
                     "s from pulse to pulse, of which epochs see the share; not given: the average")};

}  // namespace

constexpr FaultKind jamming_fault{
    "jamming",
    "The noise floor of the selected signals rises: C/N0 falls, then lock is lost, and the receiver's "
    "monitor sees interference.",
    "Personal privacy devices in cars, military jamming near conflicts, a transmitter or a switching "
    "supply on board.",
    jamming_parameters + signal_selector, make_jamming};

}  // namespace skyloop::inline run
