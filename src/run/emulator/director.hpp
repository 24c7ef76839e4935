/// Faults and commands of a run, at their times.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/emulator/command_queue.hpp"
#include "run/fault/active_faults.hpp"
#include "run/fault/run_observer.hpp"
#include "run/fault/timeline.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

class Pacer;
class Station;

/// Carries out a scenario's timeline and what is asked for while the run goes on.
///
/// State: the timeline, live faults among it, and what observers have been told.
class Director {
public:
    struct Parts {
        std::vector<FaultEntry> faults;
        std::vector<CommandEntry> commands;
        GpsTime start{};
        std::uint64_t seed = 1;
        double speed = 1;              ///< simulated seconds per second, of a live run
        CommandQueue* live = nullptr;  ///< may be absent; outlives the director
        std::string keeps_speed{};     ///< why no command changes the speed; empty: one may
    };
    explicit Director(Parts parts);

    /// Told what happens; outlives the director.
    void add_observer(RunObserver* observer) { observers_.push_back(observer); }
    /// Asks for something at the next advance(); by the loop's thread.
    void ask(Command command) { asked_.push_back(std::move(command)); }
    /// Does what is due by `now`. @param pacer is told of pauses and speeds
    void advance(GpsTime now, std::vector<Station>& stations, Pacer& pacer);
    /// When something is known to happen next.
    [[nodiscard]] std::optional<GpsTime> next_event() const;
    /// Shows an epoch, after the firmware has seen it.
    void show(const EpochSeen& seen);
    void show(const MessageSeen& seen);
    void show(const BeliefSeen& seen);
    /// True when somebody watches the messages on the wires: an observer or a trigger.
    [[nodiscard]] bool wants_messages() const;
    /// Simulated seconds per second of a live run.
    [[nodiscard]] double speed() const { return speed_ * pace_; }
    /// How strong an occurrence of a fault is: 0 … 1 along its ramps, 0 when it is not at work; of several receivers
    /// the strongest.
    [[nodiscard]] double strength(std::string_view fault, int occurrence, GpsTime now,
                                  const std::vector<Station>& stations) const;
    /// A command asked for the end of the run.
    [[nodiscard]] bool stopped() const { return stopped_; }

private:
    // An entry of the timeline is one of both.
    struct Act {
        std::optional<FaultEntry> fault;
        std::optional<Command> command;
        std::string asked{};  // the name that a live fault was asked for by
    };
    // Where something is done, and when.
    struct Scene {
        GpsTime now;
        std::vector<Station>& stations;
        Pacer& pacer;
    };
    void follow(const TimelineEvent& event, const Scene& scene);
    void begin_fault(const TimelineEvent& event, Station& station);
    void carry_out(const Command& command, std::string_view name, const Scene& scene);
    [[nodiscard]] std::string ignored_because(const Command& command) const;
    static firmware::ReceiverEvent receiver_event(const Command& command);
    [[nodiscard]] std::vector<std::size_t> faults_to_stop(const std::string& name) const;
    void start_or_stop(const Command& command, const Scene& scene);
    void begin_new_fault(const Command& command, const Scene& scene);
    void set_pace(const Command& command, const Scene& scene);
    void release(bool heard, const Scene& scene);

    Parts parts_;
    Timeline timeline_;
    std::vector<Act> acts_;  // of each entry
    std::vector<RunObserver*> observers_;
    std::vector<Command> asked_;
    bool hears_ = false;  // a trigger waits for a client's message
    bool stopped_ = false;
    bool paused_ = false, waits_ = false;  // by whoever asked for it, and for a live source
    double speed_ = 1, pace_ = 1;          // the run's own, and what faults make of it
    std::optional<GpsTime> pause_at_;      // the end of a step
};

/// It begins a fault that no entry of the scenario describes.
bool begins_new_fault(const Command& command);
/// "jamming", where that name is taken "jamming 2", and so on: what a new fault is called.
std::string free_name(const std::string& wanted, const std::function<bool(const std::string&)>& is_taken);

}  // namespace skyloop::inline run
