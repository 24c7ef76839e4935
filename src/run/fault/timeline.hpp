/// When the entries of a scenario begin and end.
/// What is known of a timeline before the run.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline run {

/// A state of the run that makes something begin; all that is given must hold at once, at an epoch of the first
/// receiver, or when the client's message comes.
struct Trigger {
    std::optional<Metres> height_above, height_below;  ///< of the antenna above the ellipsoid
    std::optional<MetresPerSecond> speed_above;        ///< over the ground
    std::vector<std::array<double, 2>> inside{};  ///< a polygon of latitudes and longitudes, degrees; empty: anywhere
    std::optional<Seconds> fix_for{};             ///< so long without a gap
    std::string client_sends{};                   ///< a client's message by is_message_named(); empty: none
    std::string vehicle_mode{};                   ///< "AUTO": by is_mavlink_mode(); empty: any
    std::optional<std::uint32_t> custom_mode{};   ///< the vehicle's mode as HEARTBEAT's number
    std::optional<bool> armed{};                  ///< the vehicle is armed, or is not

    /// It asks for something that the vehicle's autopilot has to tell.
    [[nodiscard]] bool needs_vehicle() const { return !vehicle_mode.empty() || custom_mode || armed; }
};

/// What is known of the vehicle, as the HEARTBEAT of its autopilot tells it.
struct VehicleState {
    std::string mode{};                          ///< mavlink_mode_name(); empty: not known
    std::optional<std::uint32_t> custom_mode{};  ///< nothing: not known
    std::optional<bool> armed{};
    bool operator==(const VehicleState&) const = default;
};

/// What a command does to other entries when it comes, as start_fault and stop_fault do.
struct TimelineOrder {
    std::string fault{};              ///< the name of those that it is about; empty: all
    bool begins = true;               ///< or ends
    std::optional<Seconds> length{};  ///< of what begins; nothing: the entry's own
};

/// One entry of the timeline, a fault or a command, by its times.
struct TimelineEntry {
    std::string name;
    std::optional<GpsTime> at_time{};                       ///< in place of `at`
    std::optional<Seconds> at{};                            ///< after the start of the run, or of `after`
    std::optional<std::array<double, 2>> between{};         ///< s: drawn within these bounds in place of `at`
    std::string after{};                                    ///< another entry, from whose beginning times count
    bool after_end = false;                                 ///< … from whose end
    std::optional<Trigger> when{};                          ///< times count from when this holds
    bool again = false;                                     ///< a trigger acts each time it comes true, not once
    std::optional<Seconds> every{};                         ///< begins anew after this
    std::optional<int> times{};                             ///< by itself, in all; nothing: for ever
    std::optional<Seconds> length{};                        ///< nothing: to the end of the run; of a command zero
    std::optional<std::array<double, 2>> length_between{};  ///< s
    Seconds ramp_in{0}, ramp_out{0};                        ///< within its length at the beginning; after it at the end
    bool once = false;                                      ///< a command: begins and does not last
    bool by_hand = false;                                   ///< begins only by begin()
    std::optional<TimelineOrder> order{};                   ///< of a command; whoever leads the timeline obeys it
};

/// What triggers look at, at an epoch of the first receiver.
struct TriggerView {
    std::optional<Geodetic> place{};  ///< of the antenna
    MetresPerSecond speed{0};         ///< over the ground
    bool has_fix = false;
};

/// One begins, one ends.
struct TimelineEvent {
    std::size_t entry = 0;
    int occurrence = 1;  ///< counted as they begin, those asked for by hand among them
    bool begins = true;
    GpsTime time{};
    bool by_hand = false;             ///< asked for while the run went on
    std::optional<Seconds> length{};  ///< of this one, where it is not the entry's
};

/// Resolves entries to events.
///
/// Times are drawn from streams of their own, named by entry and number, so that they do not depend on each other: a
/// beginning's by how many were planned before it, a length by the occurrence.
/// State: what is under way and what is to come.
class Timeline {
public:
    /// @param entries whose `after` name each other without a circle
    Timeline(std::vector<TimelineEntry> entries, GpsTime start, std::uint64_t seed);

    /// What begins and ends by `now`, in the order of time; at the same instant what ends comes first, then by entry.
    /// What is under way when its time to begin has come ends there, and begins anew.
    std::vector<TimelineEvent> advance(GpsTime now);
    /// Shows the run to the triggers, at an epoch; what they make begin begins behind it, with the next advance().
    void look(GpsTime now, const TriggerView& view);
    /// The same for a client's message, by its name.
    void hear(GpsTime now, std::string_view client_message);
    /// The vehicle's state from now on; triggers see it at the next look().
    void tell(VehicleState vehicle) { vehicle_ = std::move(vehicle); }
    /// As it was told last.
    [[nodiscard]] const VehicleState& vehicle() const { return vehicle_; }
    /// The next instant at which something is known to happen.
    [[nodiscard]] std::optional<GpsTime> next_event() const;
    /// Adds an entry that begins by begin() alone. @return its place
    std::size_t add(TimelineEntry entry);
    /// Lets an entry begin now; false when it is under way. @param length nothing: the entry's own
    bool begin(std::size_t entry, GpsTime now, std::optional<Seconds> length = std::nullopt);
    /// Ends an entry now, as if its time were over, also one that begin() lets begin with the next advance(); false
    /// when it is neither.
    bool end(std::size_t entry, GpsTime now);
    /// There is something that end() would end.
    [[nodiscard]] bool can_end(std::size_t entry) const;
    [[nodiscard]] bool is_under_way(std::size_t entry) const { return !states_[entry].under_way.empty(); }
    [[nodiscard]] const std::vector<TimelineEntry>& entries() const { return entries_; }

private:
    struct EntryState {
        int drawn = 0;  // beginnings that were planned, by which their times are drawn
        int begun = 0;  // occurrences that have begun, whoever asked for them
        int begun_by_itself = 0;
        std::set<int> under_way{};
        bool triggered = false;  // its trigger has acted
        bool held = false;       // … held at the last look
    };
    void plan_from(std::size_t entry, GpsTime origin);
    void plan(std::size_t entry, GpsTime begin, bool by_hand = false, std::optional<Seconds> length = std::nullopt);
    void plan_end(const TimelineEvent& begin);
    void insert(const TimelineEvent& event);
    void follow(const TimelineEvent& event);
    void act(std::size_t entry, GpsTime now);
    [[nodiscard]] std::optional<Seconds> length_of(const TimelineEvent& event) const;
    [[nodiscard]] bool holds(const Trigger& trigger, GpsTime now) const;
    [[nodiscard]] bool vehicle_holds(const Trigger& trigger) const;

    std::vector<TimelineEntry> entries_;
    std::uint64_t seed_;
    std::vector<TimelineEvent> planned_;  // ascending
    std::vector<EntryState> states_;      // of each entry
    TriggerView last_view_;
    std::optional<GpsTime> looked_;
    VehicleState vehicle_;
    std::optional<GpsTime> fix_since_;
};

/// When a run begins and ends, and what its times are drawn by.
struct TimelineSpan {
    GpsTime start{}, end{};
    std::uint64_t seed = 1;
};

/// What begins and ends by the end of the run, in the order of time, where no trigger acts and nobody steers; the
/// commands that start and stop faults are obeyed. @param most events; what comes after as many is left out
std::vector<TimelineEvent> planned_events(const std::vector<TimelineEntry>& entries, const TimelineSpan& run,
                                          std::size_t most);
/// For each entry: whether its events depend on what the run will bring, through triggers, what it comes after or the
/// commands that start or stop it.
std::vector<bool> hang_on_the_run(const std::vector<TimelineEntry>& entries);
/// Lines for people: what is known of each entry before the run, in the order of time.
std::vector<std::string> timeline_text(const std::vector<TimelineEntry>& entries, const TimelineSpan& run);

}  // namespace skyloop::inline run
