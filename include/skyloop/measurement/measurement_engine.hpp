/// The receiver's channels: from what arrives to what is measured.
#pragma once

#include <cstdint>
#include <memory>

#include "skyloop/flow/arrivals.hpp"
#include "skyloop/flow/measurement_terms.hpp"
#include "skyloop/flow/observations.hpp"
#include "skyloop/flow/receiver_settings.hpp"
#include "skyloop/measurement/measurement_parameters.hpp"

namespace skyloop {

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
    /// P = ρ + c(dt_r − dt_s) + c·group delay + signal-in-space error + I_f + T + excess path + multipath + noise;
    /// the carrier's phase has −I_f, no group delay, and an ambiguity of its own; D = −(f/c)·dP/dt (MODELS.md section
    /// 7).
    /// @param time true instant of the measurement
    Measurement measure(const Arrivals& arrivals, GpsTime time, const ReceiverSettings& settings);

private:
    class Channels;
    std::unique_ptr<Channels> channels_;
};

}  // namespace skyloop
