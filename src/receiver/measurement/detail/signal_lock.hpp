/// Whether a channel has found its signal, and how well it holds it.
/// The count of a carrier's cycles: what it starts from and how it breaks.
#pragma once

#include <optional>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/measurement/measurement_parameters.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline receiver {

/// What a channel has before it at one instant.
struct SignalSight {
    std::optional<DbHz> cn0;               ///< nothing: the signal does not arrive
    StartKind knowledge = StartKind::hot;  ///< with which it is searched for
    bool searchable = true;                ///< a second signal waits for the first
    bool phase_trackable = true;           ///< not torn by scintillation
};

/// Search, code lock, phase lock, half cycle resolved, loss and reacquisition of one signal (MODELS.md 7.9).
///
/// State: since when each of them holds. Time passes only by the instants it is told.
class SignalLock {
public:
    /// @param pilot the signal has no data bits: its half cycle is known with the phase
    /// @param searches random numbers for the time of each search
    SignalLock(bool pilot, RandomStream searches) : pilot_(pilot), searches_(searches) {}

    void advance(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now);
    /// Forgets the signal, as a restart of the receiver does.
    void forget();

    [[nodiscard]] bool code_locked() const { return code_since_.has_value(); }
    /// While code_locked().
    [[nodiscard]] Seconds code_locked_for(GpsTime now) const { return difference(now, *code_since_); }
    [[nodiscard]] bool phase_locked() const { return phase_since_.has_value(); }
    [[nodiscard]] bool half_cycle_resolved() const { return half_cycle_resolved_; }

private:
    void search(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now);
    void hold_code(const AcquisitionParameters& parameters, DbHz cn0, GpsTime now);
    void hold_phase(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now);
    void lose(GpsTime now);
    Seconds search_time(const AcquisitionParameters& parameters, StartKind knowledge, DbHz cn0, GpsTime now);

    bool pilot_;
    RandomStream searches_;
    std::optional<GpsTime> found_at_, weak_since_, lost_at_;
    std::optional<GpsTime> code_since_, pull_in_since_, phase_since_;
    bool half_cycle_resolved_ = false;
};

/// How often a carrier loop slips by itself, 1/s: 2 B erfc(π/(2√2 σ)), the probability that a Gaussian phase error σ
/// lies beyond the ±90° of a Costas loop, once for each independent error. Nothing below 0.2 rad (10⁻¹² per hour).
/// @param jitter σ of the phase, 1 σ
double slips_per_second(const CarrierLoop& loop, Angle jitter);

/// The whole and half cycles between phase and range.
///
/// State: the count, and the random numbers of its starts and of its slips.
class CycleCount {
public:
    CycleCount(RandomStream starts, RandomStream slips) : starts_(starts), slips_(slips) {}

    /// A new lock, at a whole number of cycles. @param half_unknown a half cycle may be among them
    void start(bool half_unknown);
    /// Lets a slip happen or not: one or two cycles, or halves of them while the half cycle is not resolved.
    /// @param expected number of slips in the time that passed
    bool slip(double expected, bool half_cycle_resolved);
    /// Takes a half cycle out when the data bits have shown it. Tells whether there was one.
    bool resolve_half_cycle();
    [[nodiscard]] double cycles() const { return cycles_; }

private:
    RandomStream starts_, slips_;
    double cycles_ = 0;
};

}  // namespace skyloop::inline receiver
