/// Where a run's state hangs for other threads to read.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "run/emulator/station.hpp"
#include "run/emulator/status_snapshot.hpp"
#include "run/fault/run_observer.hpp"

namespace skyloop::inline run {

/// What the board asks for when it makes a snapshot, by the loop's thread. Those that are empty are not asked.
struct StatusSources {
    std::function<PaceStatus()> pace{};
    /// 0 … 1 of an occurrence by the fault's name, at an instant; also of one that fades after its end.
    std::function<double(std::string_view fault, int occurrence, GpsTime now)> strength{};
    std::function<std::vector<VerdictStatus>()> verdicts{};
    std::function<std::optional<CasterStatus>()> caster{};
    std::function<std::int64_t()> clock{};  ///< ns that never go back; nothing: the steady clock
};

/// What does not change during a run.
struct StatusSetup {
    std::string title;  ///< of the scenario
    GpsTime start{};
    std::optional<GpsTime> end{};
    std::vector<TimelineBar> timeline{};  ///< what is known of it before the run
    bool every_epoch = false;             ///< is looked at: the run waits for a clock or a leader anyway
};

/// Collects what displays show of a run, and publishes it as immutable snapshots: at most ten a second while somebody
/// watches, has asked or commanded in the last seconds or after an event, one a second otherwise, of real time; and one
/// for who asks, as soon as the loop comes round.
///
/// The loop's thread never waits here: when a reader is just taking the last snapshot, the next one comes later.
/// Between two snapshots an epoch costs a look at a clock, a message its copy and its count. State: the last messages
/// and events, how many messages of each name came, what is under way, and each receiver at its last epoch that was
/// looked at.
class StatusBoard : public RunObserver {
public:
    /// @param stations of the run, which outlive the board; null: nothing is known of receivers but their epochs
    StatusBoard(StatusSetup setup, const std::vector<Station>* stations, StatusSources sources = {});

    void on_epoch(const EpochSeen& seen) override;
    void on_message(const MessageSeen& seen) override;
    [[nodiscard]] bool wants_messages() const override { return true; }
    void on_fault(const FaultSeen& seen) override;
    void on_command(const CommandSeen& seen) override;
    void on_belief(const BeliefSeen& seen) override;
    /// To be called by the loop each time it comes round, in a pause too: publishes what is due or asked for.
    void look(GpsTime now);
    /// The same at once, due or not: at the end of the run.
    void publish_now(GpsTime now);

    /// The last snapshot; never null. By any thread.
    [[nodiscard]] std::shared_ptr<const StatusSnapshot> latest() const;
    /// Asks for a snapshot that has everything that the loop was told before this call: the first whose `answers` is
    /// not below the number given back. By any thread.
    [[nodiscard]] std::uint64_t ask() const { return asks_.fetch_add(1) + 1; }
    /// Somebody begins or ceases to watch. By any thread.
    void watch() const { watchers_.fetch_add(1, std::memory_order_relaxed); }
    void unwatch() const { watchers_.fetch_sub(1, std::memory_order_relaxed); }
    [[nodiscard]] int watchers() const { return watchers_.load(std::memory_order_relaxed); }

    static constexpr std::size_t most_dialogue_lines = 512, most_events = 256, most_live_bars = 128;
    /// Names of messages that are counted: clients choose theirs, and without a bound could fill the memory.
    static constexpr std::size_t most_message_counts = 2048;

private:
    struct Belief {
        std::size_t station = 0, wire = 0;
        bool trusts = false;
        std::string reason;
    };
    [[nodiscard]] std::int64_t clock() const;
    [[nodiscard]] std::int64_t interval(std::int64_t clock_ns) const;
    [[nodiscard]] bool is_wanted(const EpochSeen& seen, std::int64_t clock_ns) const;
    [[nodiscard]] ReceiverStatus& receiver(std::size_t station);
    void take_epoch(const EpochSeen& seen, bool silent, ReceiverStatus& status) const;
    void take_report(const EpochSeen& seen, ReceiverStatus& status) const;
    void take_wires(std::size_t station, ReceiverStatus& status) const;
    void count_message(const DialogueLine& line);
    void add_event(GpsTime now, std::string what, std::string text);
    TimelineBar& bar_of(const FaultSeen& seen);
    bool publish(GpsTime now, std::int64_t clock_ns);

    StatusSetup setup_;
    const std::vector<Station>* stations_;
    StatusSources sources_;
    std::vector<ReceiverStatus> receivers_;
    std::vector<std::int64_t> taken_at_;  // of each receiver, by the clock
    SilenceWatch silence_;
    std::vector<TimelineBar> bars_;
    std::vector<Belief> beliefs_;
    std::deque<std::shared_ptr<const DialogueLine>> dialogue_;
    std::deque<std::shared_ptr<const EventLine>> events_;
    std::vector<MessageCount> messages_;  // ascending, as message_key() orders them
    std::uint64_t dialogue_count_ = 0, event_count_ = 0, snapshot_count_ = 0;
    std::int64_t published_at_ = 0;
    std::int64_t followed_until_ = 0;  // by the clock, by who has asked or commanded
    bool news_ = false;                // an event that no snapshot has yet
    bool stepping_ = false;            // the last command was a step, which ends at an epoch that is wanted
    // Asked is answered by the look after the next: what the loop was told before has been done by then.
    std::uint64_t heard_asks_ = 0, answered_asks_ = 0;
    mutable std::atomic<std::uint64_t> asks_{0};
    mutable std::atomic<int> watchers_{0};
    mutable std::mutex mutex_;  // of latest_; the loop only tries it
    std::shared_ptr<const StatusSnapshot> latest_;
};

}  // namespace skyloop::inline run
