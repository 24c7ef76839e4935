/// The loop's side of a feed: clocks and paths of its vehicles.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "feed_hearer.hpp"
#include "run/feed/truth_feed.hpp"

namespace skyloop::inline run {

/// Puts what a feed's thread has heard into paths, in its order. All of it belongs to the loop's thread.
class FeedPaths {
public:
    FeedPaths(const FeedSettings& settings, FeedDesk& desk);

    std::shared_ptr<LivePath> path(const std::string& vehicle) { return path(vehicle, path_settings_); }
    std::shared_ptr<LivePath> path(const std::string& vehicle, const LivePathSettings& settings);
    /// Follow: the run starts once every path has a sample, with the newest of each.
    void wait_for_all() { waits_ = true; }
    void begin(GpsTime start, std::int64_t steady_ns);
    void set_run(GpsTime now, std::int64_t steady_ns);

    /// Takes what waits, at most 4096 items. Nothing before begin(). @param now_ns the steady clock
    std::vector<Command> take(std::int64_t now_ns);
    [[nodiscard]] bool any_left() const { return next_ < taken_.size(); }
    [[nodiscard]] std::optional<GpsTime> horizon() const;
    /// Steps up to the horizon that have not been given yet.
    std::vector<FeedStep> steps_done();
    /// Of these, those that ask for what was done long ago.
    std::vector<FeedStep> steps_done_before() { return take_steps(answered_); }
    /// Steps that wait while the run cannot begin.
    std::vector<FeedStep> skip_steps();
    /// Some have not been given yet.
    [[nodiscard]] bool any_step() const { return !steps_.empty(); }

    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] bool paused() const { return paused_; }
    [[nodiscard]] const SourceClock& clock() const { return clock_; }

private:
    struct Vehicle {
        std::shared_ptr<LivePath> path;
        std::uint64_t restarts = 0;  // of the clock, that the path has been told
        std::uint64_t jumps = 0;     // of the path, that the user has been told
        std::int64_t heard_ns = 0;   // nothing so far: 0
        bool silent = false;         // has been told
    };
    struct Untimed {
        SourceClock clock;
        std::optional<TruthSample> last;
    };
    struct PendingStep {
        FeedStep step;
        GpsTime time;
    };

    [[nodiscard]] bool step_waits() const;
    void keep_newest(std::vector<FeedItem>& items) const;
    void take_item(FeedItem& item, std::vector<Command>& commands, std::int64_t now_ns);
    void take_end(std::int64_t now_ns);
    void take_sample(TruthSample& sample);
    void take_unwanted(const TruthSample& sample);
    void place(TruthSample& sample);
    [[nodiscard]] bool is_wanted(const std::string& vehicle) const;
    [[nodiscard]] bool all_have_begun() const;
    void take_step(const FeedStep& step);
    std::vector<FeedStep> take_steps(std::optional<GpsTime> until);
    SourceClock::Stamp stamp(const TruthSample& sample);
    void note(const SourceClock::Stamp& stamp, std::int64_t now_ns);
    void look(std::int64_t now_ns);
    void look_at_steps(std::int64_t heard_ns);
    void look_at_rate(std::int64_t now_ns);
    void add(Vehicle& vehicle, const std::string& name, GpsTime time, TruthSample& sample);

    LivePathSettings path_settings_;
    ClockMode mode_;
    FeedDesk& desk_;
    SourceClock clock_;
    std::map<std::string, Untimed> untimed_;   // vehicles that speak without a time
    std::map<std::string, Vehicle> vehicles_;  // that somebody wants
    std::shared_ptr<LivePath> any_;            // of the first that is spoken of
    std::optional<std::string> first_;
    std::string spoken_of_;                  // the vehicle of the newest sample
    std::optional<std::int64_t> turned_ns_;  // when it was another before
    std::optional<std::int64_t> ends_ns_;    // when a goodbye counts, unless a sample comes before
    std::vector<TruthSample> begun_with_;    // the newest of each vehicle, until all that are waited for are heard
    bool begun_ = false, fresh_ = false, waits_ = false;
    GpsTime start_;
    std::int64_t start_ns_ = 0;
    std::vector<FeedItem> taken_;
    std::size_t next_ = 0;
    std::uint64_t restarts_ = 0;
    std::optional<GpsTime> first_sample_, newest_sample_, newest_step_, answered_;
    std::deque<PendingStep> steps_;
    std::int64_t first_sample_ns_ = 0;  // when first_sample_ came
    bool ended_ = false, paused_ = false, other_told_ = false;
    bool steps_missed_ = false;  // has been told
    std::int64_t looked_ns_ = 0;
    std::optional<std::int64_t> first_timed_ns_;  // when the first sample with a time came
    int odd_looks_ = 0;                           // one after the other that saw a rate that is not 1
    bool rate_told_ = false;
};

}  // namespace skyloop::inline run
