/// The faults of one receiver that are under way.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

/// When an occurrence works, and how it comes and goes.
struct FaultSpan {
    std::size_t entry = 0;  ///< of the timeline
    int occurrence = 1;
    GpsTime begin{};
    Seconds ramp_in{0}, ramp_out{0};
};

/// Applies what is under way, in the order in which it began.
///
/// State: the occurrences with theirs, and the cycles that they have cost. An occurrence that has ended works on while
/// its ramp out lasts; of two of the same entry the stronger works alone.
class ActiveFaults {
public:
    void begin(Fault fault, const FaultSpan& span);
    /// Ends an occurrence; it fades from then on.
    void end(std::size_t entry, int occurrence, GpsTime now);
    /// Drops what has faded by `now`, and gives what happens to the receiver: of those that began or ended since the
    /// last call.
    std::vector<firmware::ReceiverEvent> settle(GpsTime now);
    /// When the next one has faded; nothing: none is fading.
    [[nodiscard]] std::optional<GpsTime> next_faded() const;
    /// Of one occurrence: 0 … 1 along its ramps; 0 when it is not at work.
    [[nodiscard]] double strength(std::size_t entry, int occurrence, GpsTime now) const;
    /// Nothing is under way, and nothing left of what was.
    [[nodiscard]] bool empty() const { return running_.empty() && lost_cycles_.empty(); }

    /// What an epoch is edited with; `trace` tells what is true, and its time.
    void edit_arrivals(Trace& trace);
    void edit_observations(Trace& trace);
    void edit_epoch(Trace& trace);
    void edit_report(firmware::NavigationState& state, const Trace& trace);
    /// What is wrong at an instant.
    [[nodiscard]] firmware::FirmwareFaults firmware(GpsTime now) const;
    [[nodiscard]] WireConditions wire(GpsTime now) const;
    [[nodiscard]] PaceConditions pace(GpsTime now) const;

private:
    struct Running {
        Fault fault;
        FaultSpan span;
        std::optional<GpsTime> end;
    };
    void give_speed_back(const Fault& over, std::size_t place);
    [[nodiscard]] bool yields(const Running& running, GpsTime now) const;
    [[nodiscard]] static FaultMoment moment(const Running& running, GpsTime now);
    template <class Value>
    void apply(Edit<Value> Fault::*edit, Value& value, const Trace& trace, MeasurementTerms* terms = nullptr);
    template <class Value>
    [[nodiscard]] Value collected(Edit<Value> Fault::*edit, GpsTime now) const;

    std::vector<Running> running_;
    LostCycles lost_cycles_;
    std::vector<firmware::ReceiverEvent> events_;
};

}  // namespace skyloop::inline run
