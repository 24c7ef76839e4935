#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "detail/false_place.hpp"
#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline run {

RangeAndRate light_time_range(const SatelliteInView& satellite, const AntennaMotion& antenna) {
    const Eigen::Vector3d& sent_from = satellite.position_at_transmission.vector();
    const Eigen::Vector3d& sent_with = satellite.velocity_at_transmission.vector();
    constexpr int rounds = 5;  // each leaves a hundred-thousandth of the error
    double travel = satellite.travel_time.value();
    Eigen::Vector3d place = sent_from;
    for (int i = 0; i < rounds; ++i) {
        const double earlier = travel - satellite.travel_time.value();
        place = turned_by(Eigen::Vector3d(sent_from - earlier * sent_with), travel);
        travel = (place - antenna.position.vector()).norm() / speed_of_light;
    }
    const Eigen::Vector3d line = place - antenna.position.vector();
    const Eigen::Vector3d direction = line.normalized();
    const Eigen::Vector3d velocity = turned_by(sent_with, travel);
    const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(place.y(), -place.x(), 0);
    const double own = direction.dot(velocity - antenna.velocity.vector());
    return {Metres(line.norm()), MetresPerSecond(own / (1 + direction.dot(velocity - turn) / speed_of_light))};
}

RangeAndRate false_range(const SatelliteInView& satellite, const AntennaMotion& told, const TruthState& truth) {
    const RangeAndRate there = light_time_range(satellite, told);
    const RangeAndRate here = light_time_range(satellite, {truth.position, truth.velocity});
    return {there.range - here.range, there.rate - here.rate};
}

Metres SmoothWay::after(Seconds time) const {
    const double whole = distance.value(), a = acceleration, t = time.value();
    if (!(whole > 0) || t <= 0) return Metres(0);
    const double v = std::min(speed.value(), std::sqrt(whole * a));
    const double speeding = v / a, steady = whole / v - speeding, end = steady + 2 * speeding;
    if (t >= end) return distance;
    if (t < speeding) return Metres(a * t * t / 2);
    if (t < speeding + steady) return Metres(v * speeding / 2 + v * (t - speeding));
    return Metres(whole - a * (end - t) * (end - t) / 2);
}

MetresPerSecond RateOfChange::of(SatelliteId satellite, Metres value, GpsTime now) {
    const auto [place, is_new] = last_.try_emplace(satellite, Last{value, now});
    const double passed = difference(now, place->second.at).value();
    if (is_new || passed <= 0) return MetresPerSecond(0);
    const MetresPerSecond rate((value - place->second.value).value() / passed);
    place->second = {value, now};
    return rate;
}

namespace {

constexpr double pull_off_acceleration = 0.5;  // m/s², which a receiver's filter follows
constexpr double metres_per_microsecond = speed_of_light * 1e-6;
constexpr double metres_per_nanosecond = speed_of_light * 1e-9;

// A false signal is tracked in place of the true one: it comes straight from the spoofer, and stronger.
void capture(Arrival& arrival, Decibels advantage) {
    if (arrival.cn0) arrival.cn0 = *arrival.cn0 + DbHz((advantage + arrival.reflection_loss).value());
    arrival.power_offset += advantage;
    arrival.reflection_loss = Decibels(0);
    arrival.line_of_sight = true;
    arrival.paths = 1;
    arrival.reflections = 0;
    arrival.excess_path = Metres(0);
    arrival.excess_rate = MetresPerSecond(0);
    arrival.echoes.clear();
}

// What the false signals tell at one instant.
struct FalseStory {
    AntennaMotion antenna;
    RangeAndRate clock;  // of all ranges alike
};

// What grows with the strength of a fault changes along its ramps, too: phase and Doppler have to agree.
RangeAndRate along_ramps(const RangeAndRate& full, const FaultMoment& moment) {
    return {full.range * moment.strength,
            full.rate * moment.strength + MetresPerSecond(full.range.value() * moment.strength_rate)};
}

void tell(Arrivals& arrivals, const FaultMoment& moment, const SignalSelector& selector, const FalseStory& story,
          Decibels advantage) {
    for (std::size_t i = 0; i < arrivals.satellites.size(); ++i) {
        Arrival& arrival = arrivals.satellites[i];
        if (arrival.paths == 0 || !selector.takes(arrival)) continue;
        const RangeAndRate added = false_range(moment.sky->satellites[i], story.antenna, *moment.truth);
        arrival.false_range += added.range + story.clock.range;
        arrival.false_range_rate += added.rate + story.clock.rate;
        capture(arrival, advantage);
    }
}

constexpr ParameterSpec advantage_parameter =
    number_parameter("power_advantage_db", 3, 0, 40, "dB of the false signals over the true ones");
constexpr std::string_view indications[] = {"indicated", "several"};

// Drags the receiver away from the truth, or to a place.
//
// State: how far it is to go, since the first epoch, and where the last one stood.
class Takeover {
public:
    static Result<Takeover> read(const Parameters& parameters);

    void operator()(Arrivals& arrivals, const FaultMoment& moment) {
        if (!knows_the_sky(moment, arrivals)) return;
        const Eigen::Vector3d goal = goal_from(*moment.truth);
        if (!way_) way_ = SmoothWay{Metres(goal.norm()), pull_off_, pull_off_acceleration};
        const Seconds pulling = moment.since_start - aligned_;
        const double whole = way_->distance.value();
        const double part = whole > 0 ? way_->after(pulling).value() / whole : 0;
        const Eigen::Vector3d offset = goal * (part * moment.strength);
        const double drifted = drift_ * std::max(pulling.value(), 0.0);  // at full strength
        const double drifts = pulling.value() > 0 ? drift_ : 0;
        FalseStory story{{moment.truth->position + Displacement<Ecef>(offset), moment.truth->velocity}, {}};
        story.clock = along_ramps({Metres(drifted), MetresPerSecond(drifts)}, moment);
        const double passed = last_ ? difference(moment.now, last_at_).value() : 0;
        if (passed > 0)
            story.antenna.velocity = Velocity<Ecef>(moment.truth->velocity.vector() + (offset - *last_) / passed);
        last_ = offset;
        last_at_ = moment.now;
        tell(arrivals, moment, selector_, story, advantage_ * moment.strength);
    }

private:
    // From the antenna to where it shall believe to be, ECEF.
    [[nodiscard]] Eigen::Vector3d goal_from(const TruthState& truth) const {
        if (to_) return (to_->seen_from(truth) - truth.position).vector();
        return LocalFrame(truth.geodetic).to_ecef(Displacement<Enu>(offset_enu_)).vector();
    }

    SignalSelector selector_;
    std::optional<ToldPlace> to_;
    Eigen::Vector3d offset_enu_ = Eigen::Vector3d::Zero();
    MetresPerSecond pull_off_;
    Seconds aligned_;
    double drift_ = 0;  // m/s
    Decibels advantage_;
    std::optional<SmoothWay> way_;
    std::optional<Eigen::Vector3d> last_;  // offset
    GpsTime last_at_;
};

Result<Takeover> Takeover::read(const Parameters& parameters) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    auto to = ToldPlace::read(parameters, "to");
    if (!to) return fail(to.error());
    const std::vector<double> offset = parameters.numbers("offset_m");
    const auto drift = parameters.optional_number("time_drift_ns_per_s");
    if (*to && !offset.empty()) return fail(ErrorCode::usage, "both to and offset_m are given; expected one of them");
    if (!*to && offset.empty() && !drift)
        return fail(ErrorCode::usage, "nothing is to be taken over; expected to, offset_m or time_drift_ns_per_s");
    Takeover takeover;
    takeover.selector_ = std::move(*selector);
    takeover.to_ = *to;
    if (offset.size() == 3) takeover.offset_enu_ = Eigen::Vector3d(offset[1], offset[0], -offset[2]);
    takeover.pull_off_ = MetresPerSecond(parameters.number("pull_off_mps"));
    takeover.aligned_ = Seconds(parameters.number("aligned_s"));
    takeover.drift_ = drift.value_or(0) * metres_per_nanosecond;
    takeover.advantage_ = Decibels(parameters.number("power_advantage_db"));
    return takeover;
}

Result<Fault> make_takeover(const Parameters& parameters, const FaultContext&) {
    auto takeover = Takeover::read(parameters);
    if (!takeover) return fail(takeover.error());
    Fault fault;
    fault.arrivals = std::move(*takeover);
    fault.epoch = detected_after(parameters);
    return fault;
}

Result<Fault> make_meaconing(const Parameters& parameters, const FaultContext&) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    auto place = ToldPlace::read(parameters, "rebroadcast_at");
    if (!place) return fail(place.error());
    const Metres delay(parameters.number("delay_us") * metres_per_microsecond);
    const Decibels advantage(parameters.number("power_advantage_db"));
    Fault fault;
    fault.arrivals = [selector = std::move(*selector), place = *place, delay, advantage](Arrivals& arrivals,
                                                                                         const FaultMoment& moment) {
        if (!knows_the_sky(moment, arrivals)) return;
        const TruthState& truth = *moment.truth;
        FalseStory story{{truth.position, truth.velocity}, {}};
        RangeAndRate late{delay, {}};
        // What is heard is the sky of the rebroadcaster's antenna, which stands; the way from it adds to all alike.
        if (place) {
            const Displacement<Ecef> way = place->seen_from(truth) - truth.position;
            story.antenna = {
                truth.position + way * moment.strength,
                Velocity<Ecef>((1 - moment.strength) * truth.velocity.vector() + moment.strength_rate * way.vector())};
            late.range += way.length();
            // It grows as the receiver goes away from the repeater.
            late.rate =
                MetresPerSecond(way.length() > Metres(0) ? -truth.velocity.vector().dot(way.vector().normalized()) : 0);
        }
        story.clock = along_ramps(late, moment);
        tell(arrivals, moment, selector, story, advantage * moment.strength);
    };
    fault.epoch = detected_after(parameters);
    return fault;
}

Result<Fault> make_spoof_satellite(const Parameters& parameters, const FaultContext&) {
    auto chosen = ChosenSatellites::read(parameters);
    if (!chosen) return fail(chosen.error());
    const auto step = parameters.optional_number("step_m"), ramp = parameters.optional_number("ramp_mps");
    if (!step && !ramp) return fail(ErrorCode::usage, "no range is told; expected step_m, ramp_mps or both");
    const Decibels advantage(parameters.number("power_advantage_db"));
    Fault fault;
    fault.arrivals = [chosen = std::move(*chosen), step = step.value_or(0), ramp = ramp.value_or(0), advantage](
                         Arrivals& arrivals, const FaultMoment& moment) mutable {
        chosen.choose(arrivals);
        const RangeAndRate added =
            along_ramps({Metres(step + ramp * moment.since_start.value()), MetresPerSecond(ramp)}, moment);
        for (Arrival& arrival : arrivals.satellites) {
            if (arrival.paths == 0 || !chosen.has(arrival.id)) continue;
            arrival.false_range += added.range;
            arrival.false_range_rate += added.rate;
            capture(arrival, advantage * moment.strength);
        }
    };
    fault.epoch = detected_after(parameters);
    return fault;
}

Result<Fault> make_spoof_flapping(const Parameters& parameters, const FaultContext&) {
    const double period = parameters.number("period_s"), duty = parameters.number("duty");
    const SpoofingIndication indication =
        parameters.text("indication") == "several" ? SpoofingIndication::several : SpoofingIndication::indicated;
    return fault_of<&Fault::epoch>([period, duty, indication](Epoch& epoch, const FaultMoment& moment) {
        const double phase = moment.since_start.value() / period;
        if (phase - std::floor(phase) < duty) epoch.front_end.spoofing = indication;
    });
}

constexpr auto spoofing_kinds = std::to_array<FaultKind>({
    {"spoof_takeover",
     "False signals begin in step with the true ones, are tracked in their place, and draw position and "
     "time away smoothly, all ranges consistent.",
     "A coordinated spoofer, as the University of Texas showed on a drone in 2012 and a yacht in 2013.",
     ParameterList{
         place_parameter("to", "where the receiver shall believe to be in the end: degrees, metres"),
         numbers_parameter("offset_m", 3, -1e5, 1e5, "in its place, m from the truth: north, east, down"),
         number_parameter("pull_off_mps", 2, 0.01, 1000, "m/s at which the position is drawn away, at most"),
         number_parameter("aligned_s", 10, 0, 1e5, "s for which the false signals stay in step with the true ones"),
         number_parameter("time_drift_ns_per_s", no_standard, -1e4, 1e4, "ns of time drawn away each second"),
         advantage_parameter, detected_after_parameter} +
         satellite_selector,
     make_takeover, of_measurements},
    {"meaconing",
     "The receiver hears the sky of another antenna, delayed: it finds itself at that place, and its clock "
     "is late.",
     "A rebroadcast of real signals: repeaters in hangars and depots left on, or on purpose.",
     ParameterList{
         place_parameter("rebroadcast_at", "of the antenna whose sky is rebroadcast; not given: beside the receiver"),
         number_parameter("delay_us", 1, 0, 10000, "µs of the repeater, beside the way through the air"),
         advantage_parameter, detected_after_parameter} +
         satellite_selector,
     make_meaconing, of_measurements},
    {"spoof_satellite",
     "The range of one satellite, or a few, is false by a step, a ramp or both; the others are true.",
     "A clumsy or partial spoofer, a signal simulator that leaks; what receiver autonomous integrity "
     "monitoring is for.",
     ParameterList{number_parameter("step_m", no_standard, -1e6, 1e6, "m that the range is too long"),
                   number_parameter("ramp_mps", no_standard, -1000, 1000, "m/s by which that grows"),
                   advantage_parameter, detected_after_parameter} +
         chosen_satellites,
     make_spoof_satellite, of_measurements},
    FaultKind{"spoof_flapping",
              "The receiver's spoofing indication comes and goes while nothing is wrong with the signals.",
              "A detector at its threshold near reflecting roofs or a repeater (PX4 #21244).",
              {number_parameter("period_s", 4, 0.05, 3600, "s from one indication to the next"),
               number_parameter("duty", 0.5, 0.001, 0.999, "of the period, for which it indicates"),
               word_parameter("indication", "indicated", indications, "what it says")},
              make_spoof_flapping,
              !of_measurements,
              !with_strength}
        .that_needs(spoofing_report),
});

}  // namespace

std::vector<FaultKind> spoofing_fault_kinds() { return all_kinds_of(FaultLayer::signals, {spoofing_kinds}); }

}  // namespace skyloop::inline run
