/// One channel of the receiver: one signal of one satellite.
#pragma once

#include <cstdint>
#include <optional>

#include "loop_noise.hpp"
#include "receiver/measurement/correlator_multipath.hpp"
#include "signal_lock.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/measurement_terms.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline receiver {

/// What all channels share at one instant.
struct ChannelEpoch {
    const MeasurementParameters& parameters;
    GpsTime now;
    Seconds since_last;  ///< epoch; 0 at the first
    bool moving = false;
    NoiseSteps steps;  ///< over since_last
    Metres clock_bias;
    MetresPerSecond clock_drift;
    StartKind knowledge = StartKind::hot;
};

/// A signal and the satellite that it comes from.
struct ChannelInput {
    const Arrival& arrival;
    const SignalArrival& signal;
    bool searchable = true;  ///< a second signal waits for the first
    bool aided = false;      ///< its first signal is locked
};

/// Tracks one signal and measures it.
///
/// State: its lock, its count of cycles, the errors of its loops.
class SignalChannel {
public:
    SignalChannel(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite, Signal signal);

    [[nodiscard]] SatelliteId satellite() const { return satellite_; }
    [[nodiscard]] Signal signal() const { return signal_; }
    [[nodiscard]] bool locked() const { return lock_.code_locked(); }
    [[nodiscard]] bool visited_at(GpsTime time) const { return visited_ == time; }

    /// Lets the channel find, hold or lose its signal.
    void track(const ChannelInput& input, const ChannelEpoch& epoch);
    /// The signal does not arrive, or is no longer wanted.
    void miss(const ChannelEpoch& epoch);
    /// A restart of the receiver.
    void forget();
    /// What is measured while locked(), and what is wrong with it. After track() of the same instant.
    [[nodiscard]] Observation observation(const ChannelInput& input, const ChannelEpoch& epoch) const;
    [[nodiscard]] const SignalTerms& terms() const { return terms_; }

private:
    void follow_cycles(const ChannelInput& input, const ChannelEpoch& epoch, bool had_phase);
    /// How long the carrier has aided the code loop.
    Seconds aided_for(DbHz cn0, const ChannelEpoch& epoch);
    void hear_echoes(const ChannelInput& input, const ChannelEpoch& epoch);
    [[nodiscard]] bool path_changed(const ChannelInput& input, const ChannelEpoch& epoch) const;
    void draw_errors(const ChannelInput& input, const ChannelEpoch& epoch);

    SatelliteId satellite_;
    Signal signal_;
    SignalTraits traits_;
    CodeLoop code_loop_;
    SignalLock lock_;
    CycleCount count_;
    SignalProcesses processes_;
    AmplitudeFading fading_;

    std::optional<GpsTime> visited_;
    GpsTime processed_;  // until when the processes have run
    bool new_ = true;
    GpsTime unaided_at_;  // when the carrier last did not aid the code loop
    LoopDeviations deviations_;
    SignalTerms terms_;
    GpsTime counting_since_;
    bool ever_counted_ = false;
    bool half_cycle_resolved_ = false;
    bool slipped_ = false;
    Decibels faded_;              // by scintillation, at this epoch
    CorrelatorMultipath echoes_;  // of this epoch, where a scene tells them
    // Of the epoch before: which ray was tracked, what its path had in excess of the geometric one, and how far its
    // carrier was off.
    bool line_of_sight_ = true;
    Metres added_path_, phase_multipath_;
};

}  // namespace skyloop::inline receiver
