/// The kinds of each layer, which fault_kinds() puts in a row.
/// Faults that make one edit, in a word.
/// What several faults do to the signals of a satellite.
#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

/// The kinds of these tables, one table after the other, all of one layer.
inline std::vector<FaultKind> all_kinds_of(FaultLayer layer, std::initializer_list<std::span<const FaultKind>> tables) {
    std::vector<FaultKind> all;
    for (const auto table : tables)
        all.insert(all.end(), table.begin(), table.end());
    for (FaultKind& kind : all)
        kind.layer = layer;
    return all;
}

/// The same kinds, as those that are there or are not.
template <std::size_t n>
constexpr std::array<FaultKind, n> without_strength(std::array<FaultKind, n> kinds) {
    for (FaultKind& kind : kinds)
        kind.has_strength = false;
    return kinds;
}

extern const FaultKind jamming_fault;                 ///< by J/S, or by where the jammer stands and how strong it is
extern const FaultKind multipath_burst_fault;         ///< echoes that come and go
extern const FaultKind surroundings_fault;            ///< what stands around the antenna
std::vector<FaultKind> reception_fault_kinds();       ///< outage, antenna, interference
std::vector<FaultKind> spoofing_fault_kinds();        ///< false signals
std::vector<FaultKind> satellite_fault_kinds();       ///< clocks, records, the air
std::vector<FaultKind> range_fault_kinds();           ///< measurements that are wrong in the receiver
std::vector<FaultKind> authentication_fault_kinds();  ///< Galileo's OSNMA
std::vector<FaultKind> position_fault_kinds();        ///< of the solution
std::vector<FaultKind> report_fault_kinds();          ///< of what is reported while the receiver itself knows better
std::vector<FaultKind> time_fault_kinds();            ///< of the solution
std::vector<FaultKind> receiver_fault_kinds();
std::vector<FaultKind> wire_fault_kinds();
std::vector<FaultKind> correction_fault_kinds();
std::vector<FaultKind> can_receiver_fault_kinds();  ///< of a node of a CAN bus
std::vector<FaultKind> can_wire_fault_kinds();      ///< of its bus

/// A fault of one edit: fault_of<&Fault::epoch>(…). An edit of epochs is of what the receiver believes, its coasting
/// and limits among it; of one of reports the receiver itself knows nothing.
template <auto edit, class Change>
Fault fault_of(Change change) {
    Fault fault;
    fault.*edit = std::move(change);
    return fault;
}

/// The first that it was given. State: that.
template <class T>
class First {
public:
    const T& of(const T& value) {
        if (!first_) first_ = value;
        return *first_;
    }

private:
    std::optional<T> first_;
};

/// A place that lies off another one: metres at its height, which set out east and north and follow the ellipsoid, and
/// metres up. A tangent plane would be 8 m above the ground after 10 km.
inline Geodetic displaced(const Geodetic& from, double east_m, double north_m, double up_m) {
    const Metres height = from.height.above_ellipsoid;
    const double wider = 1 + height.value() / curvature_radii(from.latitude).prime_vertical;
    const GeodesicPoint to =
        geodesic_direct(from, Angle::radians(std::atan2(east_m, north_m)), Metres(std::hypot(east_m, north_m) / wider));
    return {to.latitude, to.longitude, {height + Metres(up_m)}};
}

/// A velocity over ground with what follows from it: speed, and the course of a vehicle that moves.
inline void put_velocity(Fix& fix, const VelocityNed& velocity) {
    fix.velocity = velocity;
    fix.speed = MetresPerSecond(std::hypot(velocity.north, velocity.east));
    const double course = Angle::radians(std::atan2(velocity.east, velocity.north)).deg();
    if (fix.speed.value() > 0) fix.course = Angle::degrees(course < 0 ? course + 360 : course);
}

/// Nothing of the satellite reaches the receiver.
void silence(Arrival& arrival);

/// C/N0 below which a receiver loses a signal (MODELS.md 7.9): a satellite that a fault brings below it is lost to
/// sensor models, too.
inline constexpr DbHz weakest_tracked{22};

/// Takes `loss_of(signal)` (a SignalArrival; returns Decibels) off the C/N0 of each of its signals.
/// @return the loss of the first one, which the caller writes down under its cause
template <class LossOf>
Decibels weaken(Arrival& arrival, LossOf&& loss_of) {
    const Decibels first = loss_of(arrival.signals.empty() ? SignalArrival{} : arrival.signals[0]);
    for (std::size_t i = 1; i < arrival.signals.size(); ++i)
        arrival.signals[i].relative_power += first - loss_of(arrival.signals[i]);
    if (!arrival.cn0) return first;
    arrival.cn0 = *arrival.cn0 - DbHz(first.value());
    if (first > Decibels(0) && *arrival.cn0 < weakest_tracked) arrival.cut_off = true;
    return first;
}

/// The moment tells where the antenna and its satellites are, in the order of the arrivals.
inline bool knows_the_sky(const FaultMoment& moment, const Arrivals& arrivals) {
    return moment.truth != nullptr && moment.sky != nullptr &&
           moment.sky->satellites.size() == arrivals.satellites.size();
}

/// Seconds from the beginning of a fault until the receiver's own detector says that it is deceived.
inline constexpr ParameterSpec detected_after_parameter =
    number_parameter("detected_after_s", no_standard, 0, 1e6,
                     "s from the start until the receiver's own detector indicates spoofing; not given: never")
        .that_needs(spoofing_report);
/// The edit that makes the detector say so; none when the parameter was not given.
Edit<Epoch> detected_after(const Parameters& parameters);

/// A place as a parameter tells it, its height that of the antenna where none is told.
class ToldPlace {
public:
    /// Nothing when the parameter was not given; fails with `usage` for a place that cannot be.
    static Result<std::optional<ToldPlace>> read(const Parameters& parameters, std::string_view name);
    [[nodiscard]] Position<Ecef> seen_from(const TruthState& truth) const;

private:
    Geodetic place_;
    bool has_height_ = false;
};

}  // namespace skyloop::inline run
