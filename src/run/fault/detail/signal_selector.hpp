/// Which satellites and signals a fault is for.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/core/result.hpp"
#include "run/fault/fault_kind.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

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

/// `constellations`, `satellites` and the sector and band of the sky; with `signals` where a fault knows them apart.
std::vector<ParameterSpec> selector_parameters(bool signals);
/// What these parameters say; fails with `usage` where they contradict each other.
Result<SignalSelector> read_selector(const Parameters& parameters);

/// `satellites`, and the number that is taken when none is named.
std::vector<ParameterSpec> chosen_satellite_parameters();

/// Satellites that are named, or else the highest ones when the fault begins: a scenario need not know which are up.
///
/// State: the choice, once it has been made.
class ChosenSatellites {
public:
    /// From the parameters of chosen_satellite_parameters().
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

/// The tables of two kinds of parameters in a row.
std::vector<ParameterSpec> joined(std::vector<ParameterSpec> first, std::vector<ParameterSpec> second);

}  // namespace skyloop
