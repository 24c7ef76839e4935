/// Which satellites and signals a fault is for.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "fault_catalogue.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline run {

/// Satellites and signals; where nothing is told, all of them.
struct SignalSelector {
    std::vector<Constellation> constellations{};
    std::vector<Signal> signals{};
    std::vector<SatelliteId> satellites{};
    std::optional<std::array<Angle, 2>> azimuth{};  ///< clockwise from the first to the second
    std::array<Angle, 2> elevation{Angle::degrees(-90), Angle::degrees(90)};

    [[nodiscard]] bool takes(const Arrival& arrival) const;
    [[nodiscard]] bool takes(Signal signal) const;
    /// It names signals, and so may take some of a satellite and leave the others.
    [[nodiscard]] bool by_signal() const { return !signals.empty(); }
};

// What a receiver does not track as the run starts; each as IdleValue. Of sensor models it tracks what there is.
std::string why_untracked_system(const UsedReceiver& receiver, std::string_view name);
std::string why_untracked_satellite(const UsedReceiver& receiver, std::string_view name);
std::string why_untracked_signal(const UsedReceiver& receiver, std::string_view name);

inline constexpr ParameterSpec constellations_parameter =
    words_parameter("constellations", constellation_names, "systems that are hit; none given: all")
        .judged_by(why_untracked_system);
inline constexpr ParameterSpec satellites_parameter =
    texts_parameter("satellites", "satellites that are hit, as G07; none given: all")
        .judged_by(why_untracked_satellite);
inline constexpr ParameterSpec signals_parameter =
    words_parameter("signals", signal_names, "carriers that are hit; none given: all of a satellite")
        .judged_by(why_untracked_signal);
/// Satellites, and the sector and band of the sky.
inline constexpr ParameterList satellite_selector{
    constellations_parameter,
    satellites_parameter,
    number_parameter("azimuth_from_deg", no_standard, -360, 360,
                     "degrees clockwise from north, where a sector of the sky begins"),
    number_parameter("azimuth_to_deg", no_standard, -360, 360, "degrees, where the sector ends, clockwise"),
    number_parameter("elevation_from_deg", no_standard, -90, 90, "degrees, lower edge of a band of the sky"),
    number_parameter("elevation_to_deg", no_standard, -90, 90, "degrees, upper edge of the band")};
/// The same, of faults that know signals apart.
inline constexpr ParameterList signal_selector = satellite_selector + ParameterList{signals_parameter};
/// What these parameters say; fails with `usage` where they contradict each other.
Result<SignalSelector> read_selector(const Parameters& parameters);

/// A fault of the arrivals that its parameters select.
/// @param edit of one of them: (Arrival&, const SignalSelector&, const FaultMoment&)
template <class EditOne>
Result<Fault> fault_of_selected(const Parameters& parameters, EditOne edit) {
    auto selector = read_selector(parameters);
    if (!selector) return fail(selector.error());
    return fault_of<&Fault::arrivals>(
        [selector = std::move(*selector), edit = std::move(edit)](Arrivals& arrivals, const FaultMoment& moment) {
            for (Arrival& arrival : arrivals.satellites)
                if (selector.takes(arrival)) edit(arrival, selector, moment);
        });
}

/// Satellites by name, and the number that is taken when none is named.
inline constexpr ParameterList chosen_satellites{
    texts_parameter("satellites", "satellites that are hit, as G07; none given: the highest ones at the start")
        .judged_by(why_untracked_satellite),
    whole_number_parameter("satellite_count", no_standard, 1, 200, "how many of the highest ones; 1 when not given")};

/// Satellites that are named, or else the highest ones when the fault begins: a scenario need not know which are up.
///
/// State: the choice, once it has been made.
class ChosenSatellites {
public:
    /// From the parameters `chosen_satellites`.
    static Result<ChosenSatellites> read(const Parameters& parameters);
    /// Chooses from those that arrive.
    void choose(const Arrivals& arrivals);
    /// Chooses from those that are measured, by where they stand.
    void choose(const Observations& observations, const SkyView* sky);
    [[nodiscard]] bool has(SatelliteId satellite) const;

private:
    struct Candidate {
        SatelliteId id;
        Angle elevation;
    };
    void take_highest(std::vector<Candidate> candidates);

    std::vector<SatelliteId> satellites_;
    std::size_t count_ = 1;
    bool chosen_ = false;
};

}  // namespace skyloop::inline run
