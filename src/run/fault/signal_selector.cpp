#include "detail/signal_selector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "run/fault/fault_kind.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

template <class T>
bool contains(const std::vector<T>& list, const T& item) {
    return std::find(list.begin(), list.end(), item) != list.end();
}

Result<std::vector<SatelliteId>> read_satellites(const Parameters& parameters) {
    std::vector<SatelliteId> satellites;
    for (const std::string& text : parameters.texts("satellites")) {
        const auto satellite = parse_satellite(text);
        if (!satellite)
            return fail(ErrorCode::usage,
                        fmt::format("satellites has '{}'; expected a system's letter and two digits, as G07", text));
        if (const auto mistake = satellite_mistake(*satellite))
            return fail(ErrorCode::usage, "satellites: " + *mistake);
        satellites.push_back(*satellite);
    }
    return satellites;
}

std::optional<Error> read_sky(const Parameters& parameters, SignalSelector& selector) {
    const auto from = parameters.optional_number("azimuth_from_deg"), to = parameters.optional_number("azimuth_to_deg");
    if (from.has_value() != to.has_value())
        return Error{ErrorCode::usage, "a sector has one end; expected both azimuth_from_deg and azimuth_to_deg"};
    // Once round is told by numbers that lie 360 apart; other numbers of one direction are no sector.
    const bool all_round = from && std::abs(*from - *to) == 360;
    if (from && !all_round && std::remainder(*from - *to, 360.0) == 0)
        return Error{ErrorCode::usage,
                     fmt::format("the sector begins and ends at {:g}°; expected two directions", *from)};
    if (from && !all_round) selector.azimuth = {Angle::degrees(*from), Angle::degrees(*to)};
    const double low = parameters.optional_number("elevation_from_deg").value_or(-90);
    const double high = parameters.optional_number("elevation_to_deg").value_or(90);
    if (low > high)
        return Error{ErrorCode::usage, fmt::format("elevation_from_deg is {:g}, above elevation_to_deg, which is {:g}; "
                                                   "expected the lower one first",
                                                   low, high)};
    selector.elevation = {Angle::degrees(low), Angle::degrees(high)};
    return std::nullopt;
}

// Clockwise from `from` to `direction`, 0 … 2π.
double turn_from(Angle from, Angle direction) {
    const double turn = std::fmod((direction - from).rad(), 2 * std::numbers::pi);
    return turn < 0 ? turn + 2 * std::numbers::pi : turn;
}

}  // namespace

bool SignalSelector::takes(const Arrival& arrival) const {
    if (!constellations.empty() && !contains(constellations, arrival.id.constellation)) return false;
    if (!satellites.empty() && !contains(satellites, arrival.id)) return false;
    if (arrival.direction.elevation < elevation[0] || arrival.direction.elevation > elevation[1]) return false;
    return !azimuth || turn_from((*azimuth)[0], arrival.direction.azimuth) <= turn_from((*azimuth)[0], (*azimuth)[1]);
}

bool SignalSelector::takes(Signal signal) const { return signals.empty() || contains(signals, signal); }

Result<SignalSelector> read_selector(const Parameters& parameters) {
    SignalSelector selector;
    for (const std::string& name : parameters.texts("constellations"))
        if (const auto constellation = constellation_from_name(name)) selector.constellations.push_back(*constellation);
    for (const std::string& word : parameters.texts("signals")) {
        const auto found = std::find(signal_names.begin(), signal_names.end(), word);
        if (found != signal_names.end()) selector.signals.push_back(static_cast<Signal>(found - signal_names.begin()));
    }
    auto satellites = read_satellites(parameters);
    if (!satellites) return fail(satellites.error());
    selector.satellites = std::move(*satellites);
    for (const SatelliteId satellite : selector.satellites)
        if (!selector.constellations.empty() && !contains(selector.constellations, satellite.constellation))
            return fail(ErrorCode::usage,
                        fmt::format("satellite {} is of {}, which constellations leaves out; expected satellites of "
                                    "the named systems",
                                    to_string(satellite), constellation_title(satellite.constellation)));
    if (const auto error = read_sky(parameters, selector)) return fail(*error);
    return selector;
}

bool is_for(const Parameters& parameters, SatelliteId satellite, Signal signal) {
    const auto selector = read_selector(parameters);
    if (!selector) return true;  // refused elsewhere
    Arrival arrival;
    arrival.id = satellite;
    if (selector->azimuth) arrival.direction.azimuth = (*selector->azimuth)[0];
    arrival.direction.elevation = selector->elevation[0];
    return selector->takes(arrival) && selector->takes(signal);
}

Result<ChosenSatellites> ChosenSatellites::read(const Parameters& parameters) {
    auto named = read_satellites(parameters);
    if (!named) return fail(named.error());
    const auto count = parameters.optional_number("satellite_count");
    if (count && !named->empty())
        return fail(ErrorCode::usage, "both satellites and satellite_count are given; expected one of them");
    ChosenSatellites chosen;
    chosen.chosen_ = !named->empty();
    chosen.satellites_ = std::move(*named);
    chosen.count_ = static_cast<std::size_t>(count.value_or(1));
    return chosen;
}

void ChosenSatellites::take_highest(std::vector<Candidate> candidates) {
    if (candidates.empty()) return;
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.elevation > b.elevation; });
    candidates.resize(std::min(candidates.size(), count_));
    for (const Candidate& candidate : candidates)
        satellites_.push_back(candidate.id);
    chosen_ = true;
}

void ChosenSatellites::choose(const Arrivals& arrivals) {
    if (chosen_) return;
    std::vector<Candidate> candidates;
    for (const Arrival& arrival : arrivals.satellites)
        if (arrival.paths > 0) candidates.push_back({arrival.id, arrival.direction.elevation});
    take_highest(std::move(candidates));
}

void ChosenSatellites::choose(const Observations& observations, const SkyView* sky) {
    if (chosen_ || sky == nullptr) return;
    std::vector<Candidate> candidates;
    for (const SatelliteInView& satellite : sky->satellites)
        if (std::any_of(observations.signals.begin(), observations.signals.end(),
                        [&](const Observation& o) { return o.satellite == satellite.id; }))
            candidates.push_back({satellite.id, satellite.elevation});
    take_highest(std::move(candidates));
}

namespace {

bool tracks(const UsedReceiver& receiver, std::optional<Constellation> system, std::optional<Signal> signal) {
    const auto& tracked = receiver.settings.signals;
    if (!receiver.measures || tracked.empty()) return true;
    return std::any_of(tracked.begin(), tracked.end(), [&](const SystemSignal& one) {
        return (!system || one.constellation == *system) && (!signal || one.signal == *signal);
    });
}

std::string untracked(bool tracked, std::string_view name) {
    return tracked ? std::string() : fmt::format("does not track {} as the run starts", name);
}

}  // namespace

std::string why_untracked_system(const UsedReceiver& receiver, std::string_view name) {
    return untracked(tracks(receiver, constellation_from_name(name), {}), name);
}

std::string why_untracked_satellite(const UsedReceiver& receiver, std::string_view name) {
    const auto satellite = parse_satellite(name);
    return untracked(!satellite || tracks(receiver, satellite->constellation, {}), name);
}

std::string why_untracked_signal(const UsedReceiver& receiver, std::string_view name) {
    const auto* const found = std::find(signal_names.begin(), signal_names.end(), name);
    if (found == signal_names.end()) return {};
    return untracked(tracks(receiver, {}, static_cast<Signal>(found - signal_names.begin())), name);
}

bool ChosenSatellites::has(SatelliteId satellite) const { return contains(satellites_, satellite); }

}  // namespace skyloop::inline run
