#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "detail/fault_catalogue.hpp"
#include "detail/signal_selector.hpp"
#include "run/fault/fault_kind.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline run {

void LostCycles::follow(const Observations& observations) {
    std::map<Key, Count> kept;
    for (const Observation& o : observations.signals) {
        if (counts_.empty() || !o.carrier_phase || o.slipped) continue;
        const auto found = counts_.find({o.satellite, o.signal});
        if (found == counts_.end()) continue;
        kept.insert(*found);
    }
    counts_ = std::move(kept);
}

void LostCycles::slip(const Observation& observation, GpsTime now, double cycles, bool noticed) {
    Count& count = counts_[{observation.satellite, observation.signal}];
    count.cycles += cycles;
    if (noticed) count.noticed = now;
}

void LostCycles::apply(Observations& observations, GpsTime now) {
    if (counts_.empty()) return;
    for (Observation& o : observations.signals) {
        const auto found = counts_.find({o.satellite, o.signal});
        if (found == counts_.end() || !o.carrier_phase) continue;
        const Count& count = found->second;
        *o.carrier_phase += count.cycles;
        if (count.noticed) o.lock_time = std::min(o.lock_time, difference(now, *count.noticed));
    }
}

namespace {

void lengthen(Observation& o, Metres by, MeasurementTerms* terms) {
    *o.pseudorange += by;
    if (terms == nullptr) return;
    for (SignalTerms& t : terms->signals)
        if (t.satellite == o.satellite && t.signal == o.signal) t.false_code += by;
}

// @param offset m at full strength, by the time since the start
template <class Offset>
Result<Fault> offset_pseudoranges(const Parameters& parameters, Offset offset) {
    auto chosen = ChosenSatellites::read(parameters);
    if (!chosen) return fail(chosen.error());
    return fault_of<&Fault::observations>(
        [chosen = std::move(*chosen), offset](Observations& observations, const FaultMoment& moment) mutable {
            chosen.choose(observations, moment.sky);
            for (Observation& o : observations.signals)
                if (o.pseudorange && chosen.has(o.satellite))
                    lengthen(o, Metres(moment.strength * offset(moment.since_start.value())), moment.terms);
        });
}

Result<Fault> make_pseudorange_step(const Parameters& parameters, const FaultContext&) {
    const double step = parameters.number("step_m");
    return offset_pseudoranges(parameters, [step](double) { return step; });
}

Result<Fault> make_pseudorange_ramp(const Parameters& parameters, const FaultContext&) {
    const double ramp = parameters.number("ramp_mps");
    return offset_pseudoranges(parameters, [ramp](double t) { return ramp * t; });
}

// Breaks the counts of cycles again and again; what they have lost is kept by the receiver, whose counts they are.
//
// State: of each signal the random numbers that say when.
class CycleSlips {
public:
    CycleSlips(const Parameters& parameters, FaultContext context, SignalSelector selector)
        : context_(std::move(context)),
          selector_(std::move(selector)),
          per_second_(parameters.number("slips_per_minute") / 60),
          most_(parameters.number("most_cycles")),
          flagged_(parameters.flag("flagged")) {}

    void operator()(Observations& observations, const FaultMoment& moment) {
        if (moment.lost_cycles == nullptr) return;
        const double passed = last_ ? difference(moment.now, *last_).value() : 0;
        last_ = moment.now;
        const double chance = 1 - std::exp(-per_second_ * moment.strength * passed);
        for (Observation& o : observations.signals) {
            if (!o.carrier_phase || !selector_.takes(o.signal) || !takes(o.satellite)) continue;
            RandomStream& numbers = numbers_of(o);
            if (numbers.uniform() < chance) {
                const double size = 1 + std::floor(numbers.uniform() * most_);
                moment.lost_cycles->slip(o, moment.now, numbers.uniform() < 0.5 ? -size : size, flagged_);
                o.slipped = o.slipped || flagged_;
            }
        }
    }

private:
    [[nodiscard]] bool takes(SatelliteId satellite) const {
        Arrival arrival;
        arrival.id = satellite;
        return selector_.takes(arrival);
    }
    RandomStream& numbers_of(const Observation& o) {
        const std::pair key{o.satellite, o.signal};
        const auto found = numbers_.find(key);
        if (found != numbers_.end()) return found->second;
        const std::string name = to_string(o.satellite) + "." + std::to_string(static_cast<int>(o.signal));
        return numbers_.emplace(key, context_.stream(name)).first->second;
    }

    FaultContext context_;
    SignalSelector selector_;
    double per_second_, most_;
    bool flagged_;
    std::optional<GpsTime> last_;
    std::map<std::pair<SatelliteId, Signal>, RandomStream> numbers_;
};

Result<Fault> make_cycle_slips(const Parameters& parameters, const FaultContext& context) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    return fault_of<&Fault::observations>(CycleSlips(parameters, context, std::move(*selector)));
}

// Off the path that is true: what is measured changes by the way along each line of sight, the solution with it.
Result<Fault> make_antenna_moved(const Parameters& parameters, const FaultContext&) {
    const Eigen::Vector3d way(parameters.number("east_m"), parameters.number("north_m"), parameters.number("up_m"));
    return fault_of<&Fault::observations>([way](Observations& observations, const FaultMoment& moment) {
        if (moment.sky == nullptr) return;
        std::map<SatelliteId, double> nearer_m;
        for (const SatelliteInView& s : moment.sky->satellites) {
            const double a = s.azimuth.rad(), e = s.elevation.rad();
            const Eigen::Vector3d sight(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
            nearer_m[s.id] = sight.dot(way);
        }
        for (Observation& o : observations.signals) {
            const auto found = nearer_m.find(o.satellite);
            if (found == nearer_m.end()) continue;
            const double cycles = found->second * o.carrier.value() / speed_of_light;
            if (o.pseudorange) lengthen(o, Metres(-found->second * moment.strength), moment.terms);
            if (o.carrier_phase) *o.carrier_phase -= cycles * moment.strength;
            if (o.doppler) *o.doppler += Hertz(cycles * moment.strength_rate);
        }
    });
}

constexpr ParameterSpec way_parameter(std::string_view name, double standard) {
    return number_parameter(name, standard, -1e4, 1e4, "distance from the path of the run, m");
}

constexpr auto range_kinds = std::to_array<FaultKind>({
    {"pseudorange_step", "Pseudoranges of some satellites are off by a constant; phase and Doppler shift are sound.",
     "A channel that has locked to a side peak or a cross-correlation, a bad correction.",
     ParameterList{needed_number("step_m", -1e7, 1e7, "m that the pseudorange is too long")} + chosen_satellites,
     make_pseudorange_step, of_measurements},
    {"pseudorange_ramp", "Pseudoranges of some satellites drift away; phase and Doppler shift are sound.",
     "Code that leaves the carrier in an ionospheric front, a code loop that is drawn off by an echo.",
     ParameterList{needed_number("ramp_mps", -1000, 1000, "m/s by which the pseudorange grows too long")} +
         chosen_satellites,
     make_pseudorange_ramp, of_measurements},
    {"cycle_slips",
     "Carrier phases lose or win whole cycles at random, which breaks fixed ambiguities. The end of the fault "
     "gives nothing back: a count stays off until its signal is tracked anew.",
     "Vibration, shocks and foliage that the carrier loop does not bear, scintillation.",
     {number_parameter("slips_per_minute", 6, 0, 6000, "of each signal, on average"),
      number_parameter("most_cycles", 10, 1, 1e6, "that one slip loses or wins"),
      flag_parameter("flagged", true, "the receiver notices its slips and says so"), constellations_parameter,
      satellites_parameter, signals_parameter},
     make_cycle_slips,
     of_measurements},
    {"antenna_moved",
     "The antenna is away from its true path. Of a base, whose coordinates in its messages stay, it is an unannounced "
     "jump: a rover's solution jumps as far the other way at once and stays fixed, since nothing in the data "
     "contradicts it.",
     "A tripod that is knocked over or set up again beside its mark, a mast that bends.",
     {way_parameter("east_m", 10), way_parameter("north_m", 0), way_parameter("up_m", 0)},
     make_antenna_moved,
     of_measurements},
});

}  // namespace

std::vector<FaultKind> range_fault_kinds() { return all_kinds_of(FaultLayer::signals, {range_kinds}); }

}  // namespace skyloop::inline run
