/// The one loop that joins world, receivers and wires.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "run/emulator/director.hpp"
#include "run/emulator/live_feeds.hpp"
#include "run/emulator/station.hpp"
#include "run/emulator/timing.hpp"

namespace skyloop::inline run {

/// The state of a run after an epoch of one receiver, for progress displays.
struct Status {
    GpsTime now;
    const Trace* trace = nullptr;  ///< valid during the call
    Nanoseconds lateness{0};
    std::size_t station = 0;  ///< whose epoch it is
};

/// Receivers on one vehicle, streaming to their wires on one clock.
class Emulator {
public:
    struct Parts {
        std::vector<Station> stations;  ///< at least one
        std::unique_ptr<Pacer> pacer;
        Director director{Director::Parts{}};  ///< without anything: what the vehicle does is all that happens
        std::unique_ptr<LiveFeeds> feeds{};    ///< who flies the vehicles; null: nobody from outside
    };
    Emulator(Parts parts, GpsTime start);

    /// Called after each epoch.
    void on_status(std::function<void(const Status&)> callback) { status_ = std::move(callback); }
    /// Who leads the run from here on; before it begins.
    void replace_director(Director director) { parts_.director = std::move(director); }
    /// Tells an observer what happens; it outlives the run.
    void add_observer(RunObserver* observer) { parts_.director.add_observer(observer); }
    /// Called after each instant, and again and again while time stands still, beside those that are called already.
    void on_look(std::function<void(GpsTime)> callback) { looks_.push_back(std::move(callback)); }
    /// Once nothing can refuse this run any more: makes the files of the recordings, in the place of those of a former
    /// run, and lets the wires make room. Fails with `outside`.
    Result<void> begin();
    /// Waits until each wire has a client, or until `stop` is true; time begins then, and no byte is lost before.
    void await_clients(const std::atomic<bool>& stop);
    /// Waits until each vehicle that has no place yet is told one, or until `stop` is true; time begins then.
    /// @param meanwhile called again and again, for what there is to report
    void await_feeds(const std::atomic<bool>& stop, const std::function<void()>& meanwhile = {});
    /// Runs to `end`, or until `stop` is true, or until a recording fails; advance_to() and finish().
    void run_until(GpsTime end, const std::atomic<bool>& stop);
    /// Whether what is due at the very instant of the end of a stretch belongs to it.
    enum class LastInstant { left, included };
    /// Goes on to `time`, or until the run is stopped(), `stop` is true or a recording fails. Faults and commands of
    /// the present instant come first. Stretches may be as short as one likes: together they are one run.
    void advance_to(GpsTime time, const std::atomic<bool>& stop, LastInstant last = LastInstant::left);
    /// Writes what is left to write. Nothing comes after it.
    void finish();
    /// When something happens next that the stations and the director know of: an epoch, a fault, a look at a wire.
    [[nodiscard]] GpsTime next_event() const { return next_instant(GpsTime::max()); }
    /// A command has ended the run.
    [[nodiscard]] bool stopped() const { return parts_.director.stopped(); }

    [[nodiscard]] const std::vector<Station>& stations() const { return parts_.stations; }
    [[nodiscard]] std::vector<Station>& stations() { return parts_.stations; }
    /// Of the first receiver.
    [[nodiscard]] const Station& first() const { return parts_.stations.front(); }
    [[nodiscard]] const RunCounts& counts() const { return first().counts(); }
    [[nodiscard]] const firmware::Receiver& receiver() const { return first().receiver(); }
    [[nodiscard]] const std::vector<Wire>& wires() const { return first().wires(); }
    [[nodiscard]] const Simulation& simulation() const { return first().simulation(); }
    [[nodiscard]] Recorder* recorder() { return parts_.stations.front().recorder(); }
    [[nodiscard]] GpsTime now() const { return now_; }
    [[nodiscard]] bool paused() const { return parts_.pacer->paused(); }
    [[nodiscard]] const Pacer& pacer() const { return *parts_.pacer; }
    [[nodiscard]] const Director& director() const { return parts_.director; }
    /// Null: nobody flies the vehicles from outside.
    [[nodiscard]] LiveFeeds* feeds() { return parts_.feeds.get(); }
    [[nodiscard]] const LiveFeeds* feeds() const { return parts_.feeds.get(); }

private:
    Result<void> begin_recordings();
    [[nodiscard]] GpsTime next_instant(GpsTime end) const;
    [[nodiscard]] bool all_connected();
    void carry_out(const LoopTime& time);
    [[nodiscard]] std::optional<std::size_t> heard_from(const Station& station) const;
    void take_in(const LoopTime& time);
    void stand_by();
    void direct_stations();
    void direct();
    void hear_feeds();
    [[nodiscard]] bool may_go_to(GpsTime next);
    [[nodiscard]] std::uint64_t bytes_out() const;
    [[nodiscard]] bool goes_on(GpsTime end, LastInstant last) const;
    void run_epochs(Nanoseconds lateness);
    void look() const;
    [[nodiscard]] bool recording_failed() const;

    Parts parts_;
    GpsTime now_;
    std::vector<Dialogue> dialogues_;           // one a station
    std::vector<std::optional<Trace>> traces_;  // of the present instant, one a station
    std::function<void(const Status&)> status_;
    std::vector<std::function<void(GpsTime)>> looks_;
};

/// In the order of the stations.
std::vector<std::string> receiver_names(const Emulator& emulator);

/// What programs find in their environment that expectations ask: SKYLOOP_PORT, the path of the first wire or its
/// address. Empty: there is none.
std::vector<std::string> probe_environment(const Emulator& emulator);

}  // namespace skyloop::inline run
