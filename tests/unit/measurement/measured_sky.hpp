/// Arrivals whose numbers are simple, and a receiver that measures them.
#pragma once

#include <initializer_list>
#include <optional>

#include "receiver/measurement/measurement_engine.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::test {

inline const GpsTime measured_start = to_gps_time(2300, 345600.0);

/// A satellite at 45° with its first signal at `cn0`, at rest, in free space.
inline Arrival plain_arrival(SatelliteId id, double cn0 = 45) {
    Arrival arrival;
    arrival.id = id;
    arrival.direction = {Angle::degrees(120), Angle::degrees(45)};
    arrival.range = Metres(22'345'678.9012);
    for (const Signal signal : emulated_signals(id.constellation))
        arrival.signals.push_back({signal, carrier_frequency(signal), Seconds(0), Decibels(0)});
    arrival.cn0 = DbHz(cn0);
    return arrival;
}

inline constexpr SatelliteId g07{Constellation::gps, 7};
inline constexpr SatelliteId g12{Constellation::gps, 12};
inline constexpr SatelliteId e03{Constellation::galileo, 3};

inline Arrivals plain_arrivals(std::initializer_list<SatelliteId> ids, double cn0 = 45) {
    Arrivals arrivals;
    for (const SatelliteId id : ids)
        arrivals.satellites.push_back(plain_arrival(id, cn0));
    return arrivals;
}

/// No error of the receiver's own.
inline MeasurementParameters without_errors() {
    MeasurementParameters parameters;
    for (ErrorTerm* term : {&parameters.code_noise, &parameters.phase_noise, &parameters.doppler_noise,
                            &parameters.multipath, &parameters.receiver_clock, &parameters.cycle_slips})
        term->enabled = false;
    return parameters;
}

/// All emulated signals of GPS and Galileo.
inline ReceiverSettings all_signals() {
    ReceiverSettings settings;
    for (const Constellation c : {Constellation::gps, Constellation::galileo})
        for (const Signal signal : emulated_signals(c))
            settings.signals.insert({c, signal});
    return settings;
}

inline const Observation* observation_of(const Measurement& measured, SatelliteId satellite, Signal signal) {
    for (const Observation& o : measured.observations.signals)
        if (o.satellite == satellite && o.signal == signal) return &o;
    return nullptr;
}

/// An engine with epochs at a steady rate.
class MeasuredRun {
public:
    explicit MeasuredRun(const MeasurementParameters& parameters, double period = 1, std::uint64_t seed = 1)
        : engine_(parameters, seed), period_(to_nanoseconds(Seconds(period))) {}

    Measurement epoch(const Arrivals& arrivals) { return engine_.measure(arrivals, next(), settings); }
    /// The last epoch of `count`.
    Measurement epochs(const Arrivals& arrivals, int count) {
        Measurement last;
        for (int i = 0; i < count; ++i)
            last = epoch(arrivals);
        return last;
    }
    /// Seconds until the satellite's signal is measured, from the next epoch on; nothing within 200 s.
    std::optional<double> seconds_until_tracked(const Arrivals& arrivals, SatelliteId id, Signal signal = Signal::l1) {
        const GpsTime from = time_;
        while (difference(time_, from).value() < 200) {
            const GpsTime now = time_;
            if (observation_of(epoch(arrivals), id, signal)) return difference(now, from).value();
        }
        return std::nullopt;
    }
    [[nodiscard]] GpsTime next_time() const { return time_; }

    ReceiverSettings settings;

private:
    GpsTime next() {
        const GpsTime now = time_;
        time_ += period_;
        return now;
    }
    MeasurementEngine engine_;
    Nanoseconds period_;
    GpsTime time_ = measured_start;
};

}  // namespace skyloop::test
