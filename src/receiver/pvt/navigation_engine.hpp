/// What a receiver makes of its measurements.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/transmitter.hpp"
#include "world/flow/epoch.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// What the receiver has from the satellites and from its maker. All of it outlives the engine.
struct NavigationKnowledge {
    const NavigationSource* broadcast = nullptr;  ///< the records that the satellites send
    const Geoid* geoid = nullptr;                 ///< may be absent
    LeapSeconds leap_seconds = LeapSeconds::announced();
    TransmitterSource* transmitters = nullptr;  ///< orbits and clocks in place of those of the records; may be absent
    /// Where it was when it was last on, which a start knows that is not cold; nothing: it has never been on.
    std::optional<Position<Ecef>> last_place{};
    double geoid_step_deg = 0;  ///< grid of the reported heights above the sea (Geoid::undulation())
};

/// Solves position, velocity and time, watches the residuals, and smooths.
///
/// State: the filter, which records and which messages of SBAS have been received, and since when each satellite is
/// tracked.
class NavigationEngine {
public:
    NavigationEngine(const NavigationParameters& parameters, const NavigationKnowledge& knowledge);
    ~NavigationEngine();
    NavigationEngine(NavigationEngine&&) noexcept;
    NavigationEngine& operator=(NavigationEngine&&) noexcept;

    /// Messages that were received since the epoch before, of which those of SBAS are used.
    void hear(std::span<const Subframe> messages, const ReceiverSettings& settings);
    /// The fix of one epoch; epochs come in ascending time.
    Fix solve(const Observations& observations, const ReceiverSettings& settings);
    /// Whether the last fix has a velocity that was measured: without Dopplers it is told as 0.
    [[nodiscard]] bool velocity_known() const;
    /// The vector from the base of a moving pair at the last epoch, by what both measured then.
    /// @param observations of that epoch @return nothing without a position of both, or too few common signals
    std::optional<RelativePosition> relate(const Observations& observations, const ReferenceStation& base);
    /// What the last vector of the pair makes of a fix, for ten seconds.
    [[nodiscard]] std::optional<FixType> pair_type() const;
    /// From the reference station of the corrections to this receiver, by carrier phases, as it is told at the last
    /// epoch: of a moving one at the instant of its last epoch. Nothing where there is no new one.
    [[nodiscard]] const std::optional<RelativePosition>& relative() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace skyloop::inline receiver
