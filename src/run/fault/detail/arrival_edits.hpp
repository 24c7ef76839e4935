/// What several faults do to the signals of a satellite.
#pragma once

#include <optional>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

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
                     "s from the start until the receiver's own detector indicates spoofing; not given: never");
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

}  // namespace skyloop
