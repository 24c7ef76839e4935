/// The receiver's channels: from what arrives to what is measured.
#pragma once

#include <cstdint>
#include <memory>

#include "receiver/measurement/measurement_parameters.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/measurement_terms.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline receiver {

/// What was measured, and what was wrong with it.
struct Measurement {
    Observations observations;
    MeasurementTerms terms;
};

/// Tracks every signal of every satellite that arrives and that the settings name.
///
/// State: the clock, and of each signal its channel, its loops' errors and its count of cycles. The random numbers of
/// one signal do not depend on which others arrive.
class MeasurementEngine {
public:
    /// @param seed of the run
    MeasurementEngine(const MeasurementParameters& parameters, std::uint64_t seed);
    ~MeasurementEngine();
    MeasurementEngine(MeasurementEngine&&) noexcept;
    MeasurementEngine& operator=(MeasurementEngine&&) noexcept;

    /// The measurements of one instant; instants come in ascending order.
    ///
    /// P = ρ + c(dt_r − dt_s) + c·group delay + signal-in-space error + I_f + T + excess path + false range + multipath
    /// + noise with I_f = I (f1/f)². The phase L = (the same with −I_f, without the group delay, and with the carrier's
    /// own multipath and noise)/λ + an integer of its own for each lock. D = −(f/c)(range rates + c(drift_r − drift_s))
    /// + noise, without the slow rates of the atmosphere (MODELS.md section 7). P and L hold the exact bias of the
    /// clock; the receive time shows it to the nanosecond.
    ///
    /// The phase error is the phase_noise of the terms and `phase_ratio` times their multipath. A change between line
    /// of sight and reflection breaks the count of cycles, and so does a jump of the range that its rate does not tell.
    /// With a hot start every signal above its threshold is there at the first epoch. Terms that are switched off leave
    /// exactly 0.
    /// @param arrivals ascending by satellite, with C/N0; a satellite without paths or C/N0 does not arrive
    /// @param time true instant of the measurement
    Measurement measure(const Arrivals& arrivals, GpsTime time, const ReceiverSettings& settings);

private:
    class Channels;
    std::unique_ptr<Channels> channels_;
};

}  // namespace skyloop::inline receiver
