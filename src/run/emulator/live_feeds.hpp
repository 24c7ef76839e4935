/// The live sources of truth of a run.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "run/fault/run_observer.hpp"
#include "run/feed/truth_feed.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// How old the newest sample of a source was at the epochs of a run: what had to be extrapolated.
struct SampleAge {
    std::uint64_t epochs = 0;
    double sum_ms = 0, largest_ms = 0;
    void add(Nanoseconds age);
};

/// What a source has to say at the end of a run.
struct FeedReport {
    std::string description;  ///< "udp-json:127.0.0.1:29990"
    std::string clock;        ///< "realtime", "follow" or "lock_step"
    FeedCounts counts;
    LivePathCounts paths;        ///< of all its vehicles
    std::optional<double> rate;  ///< seconds of the source in a second of ours
    SampleAge age;
};

/// All sources of a run, opened, and what becomes of the run when one falls silent. Receivers that name the same source
/// share it. At most one source leads the run's time.
///
/// State: when each source was last heard, and whether it is lost.
class LiveFeeds : public RunObserver {
public:
    /// Opens every source that the scenario names and puts its paths into the settings. Null: it names none.
    /// Fails with `usage` for what contradicts itself, with `outside` for what cannot be opened.
    static Result<std::unique_ptr<LiveFeeds>> open(Scenario& scenario, const Geoid* geoid);
    ~LiveFeeds() override;
    LiveFeeds(const LiveFeeds&) = delete;
    LiveFeeds& operator=(const LiveFeeds&) = delete;

    /// Looks at what open() would: the vehicles stand where they are until their sources speak. Fails with `usage`.
    static Result<void> check(Scenario& scenario);

    /// The run starts. @param due_ns the steady clock at that instant; nothing: a source leads
    void begin(GpsTime start, std::optional<std::int64_t> due_ns);
    /// Takes what has come, never waits. @param due_ns the steady clock's reading at which `now` is due
    /// @return what is to be done: what sources ask for, and what follows from their silence
    std::vector<Command> pump(GpsTime now, std::optional<std::int64_t> due_ns);

    /// A source leads the run's time.
    [[nodiscard]] bool leads() const { return leader_ != nullptr; }
    /// Why the run has no speed of its own: "the live source leads the run's time".
    [[nodiscard]] std::string_view keeps_speed() const;
    /// How far the run may go now; nothing: not at all yet.
    [[nodiscard]] std::optional<GpsTime> horizon() const;
    /// The run has done all up to the horizon: answers the leader, and waits a little while for it.
    /// @param bytes_out that the receivers have put out since the run began
    void rest(std::uint64_t bytes_out);
    /// Every source that a place waits for has spoken.
    [[nodiscard]] bool all_heard() const;
    /// What a source has asked for and nothing comes of is told to people: it was checked before anybody knew the run.
    void on_command(const CommandSeen& seen) override;
    /// Notes how old the truth of an epoch is.
    void note_epoch(GpsTime now);

    /// "waiting for udp-json:127.0.0.1:29990"; empty: nobody is waited for.
    [[nodiscard]] std::string waits_for() const;
    std::vector<std::string> take_news();
    [[nodiscard]] std::vector<FeedReport> reports() const;
    /// "udp-json:127.0.0.1:29990", of each.
    [[nodiscard]] std::vector<std::string> descriptions() const;

private:
    struct Source;
    LiveFeeds();
    Result<Source*> source_of(const LiveSettings& settings, const Geoid* geoid);
    bool halts(Source& source);
    void report_no_place(Source& source);
    [[nodiscard]] bool is_waited_for() const;
    void look_for_silence(Source& source, std::vector<Command>& commands);
    static void end_outage(Source& source, GpsTime now, std::vector<Command>& commands);

    std::vector<std::unique_ptr<Source>> sources_;
    std::vector<std::string> receivers_;  // whom a source may ask something of
    TruthFeed* leader_ = nullptr;
    std::optional<GpsTime> answered_;
    std::uint64_t bytes_told_ = 0;
    std::vector<std::string> news_;
};

}  // namespace skyloop::inline run
