/// The clock of a live source, and how it belongs to that of the run.
/// The even rhythm behind the uneven arrivals of a source without a clock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline motion {

/// How long the vehicle took from one statement to the next, by the way and the velocities that it tells itself;
/// nothing where it tells no velocity or hardly moves.
std::optional<Nanoseconds> own_step(const TruthSample& before, const TruthSample& now);

/// Says when statements would have come, had each of them been under way for the same time (FEEDS.md 3.2).
///
/// The first arrivals are laid on an even grid: of all counts of lost statements the likeliest one, for a delay that
/// scatters over less than a period must not pass for a loss. From then on a loop of second order, critically damped,
/// follows them. Where statements tell their own steps, these count what was lost.
///
/// State: the last arrivals, and the rhythm.
class ArrivalRhythm {
public:
    /// Statements come in the order of their arrival. @param step own_step() since the one before
    /// @return when it would have come, ns of the same clock
    std::int64_t evened(std::int64_t received_ns, std::optional<Nanoseconds> step = std::nullopt);
    /// Between two statements; zero while it is not known.
    [[nodiscard]] double period_ns() const { return period_ns_; }

private:
    struct Arrival {
        std::int64_t received_ns = 0;
        double own_ns = 0;  // since the one before; zero: it does not tell
    };
    // Arrivals over their numbers on the grid.
    struct Grid {
        double period_ns = 0, at_last_ns = 0;  // the latter less the last arrival
    };

    std::int64_t begin(Arrival arrival);
    void learn();
    std::optional<Grid> told_grid();
    [[nodiscard]] std::optional<Grid> likeliest_grid() const;
    [[nodiscard]] double periods_since(const Arrival& arrival) const;

    std::deque<Arrival> arrivals_;
    std::int64_t evened_ns_ = 0;  // of the last of them
    double period_ns_ = 0;
    double lost_part_ = 0;      // of statements, those that came after lost ones
    double own_period_ns_ = 0;  // by the vehicle's own steps: differs where the source is not at real time
};

/// Who leads (FEEDS.md 3.2).
enum class ClockMode {
    realtime,  ///< the run keeps the wall clock; the source is expected to, and is looked up where it is then
    follow,    ///< the run's time is the source's: it stands still and hurries with it
    lock_step  ///< as follow, and the run goes on only as far as the source has said
};

/// Gives the statements of a source their times in the run.
///
/// Real time (FEEDS.md 3.2): delays are never negative, so the lower edge of the differences between arrival and
/// source's time over five seconds is the way between the clocks; its slope is the source's rate. The way in use
/// follows it by at most 2 ms a second, and steps to it beyond 250 ms: at once where the source has leapt ahead. Follow
/// and lock-step: the first statement is the start of the run, and the time since then is the source's own. A source
/// without a clock has its arrivals, evened out by their rhythm.
///
/// Times of the source outside ±127 years are taken as none. State: the differences seen, and the first time of the
/// source.
class SourceClock {
public:
    /// @param start of the run, and the steady clock at it
    SourceClock(ClockMode mode, GpsTime start, std::int64_t start_steady_ns);

    struct Stamp {
        GpsTime time;
        /// The source's clock went back by more than a second, or (follow) forward by more than a minute: it began
        /// anew. In follow and lock-step the run goes on from where it was.
        bool restarted = false;
        bool stepped = false;  ///< the way between the clocks was not followed but set anew, beyond 250 ms
    };
    /// Statements come in the order of their arrival.
    /// @param source_time nothing: the source has no clock
    /// @param own_step of a source without: since its statement before, as it tells itself
    Stamp stamp(std::optional<Nanoseconds> source_time, std::int64_t received_ns,
                std::optional<Nanoseconds> own_step = std::nullopt);
    /// When a time of the source is in the run; nothing before the first statement that had one.
    [[nodiscard]] std::optional<GpsTime> run_time(Nanoseconds source_time) const;
    /// From here on the run is at `now` when the steady clock reads `steady_ns` (real time: after a pause).
    void set_run(GpsTime now, std::int64_t steady_ns);
    /// Seconds of the source in a second of ours, over the last five; nothing before two statements with times that lie
    /// a tenth of a second apart.
    [[nodiscard]] std::optional<double> rate() const;
    [[nodiscard]] ClockMode mode() const { return mode_; }

private:
    // Of all statements that came in one tenth of a second the one that was under way for the shortest time.
    struct Seen {
        std::int64_t source_ns = 0, received_ns = 0;
    };
    // Received less source less base_ns_, ns: a line over the source's time.
    struct Line {
        std::int64_t at_source_ns = 0;
        double offset_ns = 0, slope = 0;
        [[nodiscard]] double offset(std::int64_t source_ns) const {
            return offset_ns + slope * static_cast<double>(source_ns - at_source_ns);
        }
    };

    Stamp stamp_arrival(std::int64_t received_ns, std::optional<Nanoseconds> own_step);
    void begin_source(std::int64_t source_ns, std::int64_t received_ns);
    void forget_way(std::int64_t received_ns);
    [[nodiscard]] bool leaps_ahead(Seen seen) const;
    [[nodiscard]] bool slips_ahead(Seen seen) const;
    bool restarts(std::int64_t source_ns, std::int64_t received_ns);
    void remember(Seen seen);
    void fit();
    bool follow_edge(Seen seen);
    [[nodiscard]] bool has_stepped(std::int64_t now_ns) const;
    [[nodiscard]] double offset_of(Seen seen) const;
    [[nodiscard]] GpsTime at_steady(std::int64_t steady_ns) const;

    ClockMode mode_;
    GpsTime start_;
    std::int64_t start_ns_;
    std::deque<Seen> window_;
    std::int64_t first_received_ns_ = 0;           // of the present window's beginning, for its youth
    std::optional<std::int64_t> first_source_ns_;  // which belongs to first_time_
    GpsTime first_time_;                           // follow, lock-step
    std::optional<std::int64_t> newest_source_ns_;
    std::optional<std::int64_t> base_ns_;  // received less source, of the first; keeps doubles small
    std::optional<Line> edge_;             // the lower one of the window
    bool rate_known_ = false;              // by the edge, from the window alone
    double held_slope_ = 0;                // of the edge, until the window tells one
    std::optional<Line> used_;
    std::int64_t used_received_ns_ = 0;    // when used_ last moved
    std::int64_t newest_received_ns_ = 0;  // when newest_source_ns_ came
    // Of statements without a time; the others of follow and lock-step, before the first with a time.
    ArrivalRhythm rhythm_;
    std::optional<std::int64_t> first_arrival_ns_;
    std::optional<GpsTime> untimed_;  // the newest
};

}  // namespace skyloop::inline motion
