/// Whether a channel has found its signal, and how well it holds it.
#pragma once

#include <optional>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/measurement/measurement_parameters.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop {

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
    [[nodiscard]] bool phase_locked() const { return phase_since_.has_value(); }
    [[nodiscard]] bool half_cycle_resolved() const { return half_cycle_resolved_; }

private:
    void search(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now);
    void hold_code(const AcquisitionParameters& parameters, DbHz cn0, GpsTime now);
    void hold_phase(const AcquisitionParameters& parameters, const SignalSight& sight, GpsTime now);
    void lose(GpsTime now);
    Seconds search_time(const AcquisitionParameters& parameters, const SignalSight& sight);

    bool pilot_;
    RandomStream searches_;
    std::optional<GpsTime> found_at_, weak_since_, lost_at_;
    std::optional<GpsTime> code_since_, pull_in_since_, phase_since_;
    bool half_cycle_resolved_ = false;
};

}  // namespace skyloop
