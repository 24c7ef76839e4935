/// The satellites as the receiver lists them.
/// The records that a receiver has received.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// A receiver's memory of what the satellites send. As a source of orbits it gives what it knows.
///
/// State: of each satellite the record that was received, and since when its data has been heard without a break.
class ReceivedRecords : public NavigationSource {
public:
    /// @param sent what the satellites send; outlives this
    ReceivedRecords(const NavigationSource& sent, const NavigationParameters& parameters);

    /// Forgets what a start of this kind forgets. Before the first one it knew everything.
    void restart(StartKind kind, GpsTime time);
    /// Listens to the satellites of one epoch. A satellite's record is known once its data has been heard for
    /// ephemeris_collection; from then on a new one is taken up as soon as it is sent, while the satellite is heard.
    /// @param time true time as well as the receiver can tell
    void listen(const Observations& observations, GpsTime time);
    /// The receiver knows what time it is: it has not started cold, or has received a record since.
    [[nodiscard]] bool time_known() const { return time_known_; }
    [[nodiscard]] bool almanac_known(GpsTime time) const;
    /// The received record; nothing once it is older than its kind lasts.
    [[nodiscard]] const Ephemeris* record(SatelliteId satellite, GpsTime time) const;

    [[nodiscard]] std::vector<SatelliteId> satellites() const override;
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return sent_.ionosphere(); }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return sent_.span(); }
    [[nodiscard]] std::string description() const override { return sent_.description(); }

private:
    struct Memory {
        std::optional<Ephemeris> record;
        std::optional<GpsTime> heard_since;
        bool is_current = false;  // the record is the one that is sent
    };
    const NavigationSource& sent_;
    Seconds collection_;
    DataParameters data_;
    std::map<SatelliteId, Memory> satellites_;
    bool time_known_ = true;
    bool all_known_ = true;  // before the first start, and until the first epoch if that is a hot one
    bool almanac_kept_ = true;
    std::optional<GpsTime> almanac_since_;  // of a cold start: heard from then on
};

/// What the list is made of.
struct ReportInput {
    const Observations& observations;
    GpsTime time;
    std::optional<Position<Ecef>> position{};           ///< of the receiver, as far as it knows
    std::span<const RangeEquation> equations{};         ///< of this epoch
    const std::vector<RangeOutcome>* ranges = nullptr;  ///< what became of them, in the same order
};

/// Lists every satellite that is tracked, and those above the horizon that the receiver knows by record or almanac.
///
/// State: the satellites that may stand above the horizon, looked up at every half minute of GPS time.
class SatelliteReport {
public:
    /// @param sent what the almanac knows  @param received what the receiver does; both outlive this
    SatelliteReport(const NavigationSource& sent, const ReceivedRecords& received) : sent_(sent), received_(received) {}
    /// Ascending. A tracked satellite of unknown orbit stands at azimuth and elevation 0.
    std::vector<SatelliteStatus> list(const ReportInput& input);
    void reset() { looked_up_.reset(); }

private:
    struct Candidate {
        SatelliteId id;
        Ephemeris record;  // carried to the instant of the last look
    };
    void look_up(GpsTime time, const Position<Ecef>& position);
    void add_tracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const;
    void add_untracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const;

    const NavigationSource& sent_;
    const ReceivedRecords& received_;
    std::optional<GpsTime> looked_up_;
    std::vector<Candidate> candidates_;  // ascending
};

}  // namespace skyloop::inline receiver
