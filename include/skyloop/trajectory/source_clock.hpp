/// The clock of a live source, and how it belongs to that of the run.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "skyloop/base/units.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// Who leads (FEEDS.md 3.2).
enum class ClockMode {
    realtime,  ///< the run keeps the wall clock; the source is expected to, and is looked up where it is then
    follow,    ///< the run's time is the source's: it stands still and hurries with it
    lock_step  ///< as follow, and the run goes on only as far as the source has said
};

/// Gives the statements of a source their times in the run. Real time: of the differences between arrival and source's
/// time the smallest within five seconds is the way between the clocks, since delays are never negative; it is followed
/// by at most 2 ms a second, and stepped to beyond 250 ms. A source without a clock has its arrivals, evened out.
///
/// State: the differences seen, and the first time of the source.
class SourceClock {
public:
    /// @param start of the run, and the steady clock at it
    SourceClock(ClockMode mode, GpsTime start, std::int64_t start_steady_ns);

    struct Stamp {
        GpsTime time;
        bool restarted = false;  ///< the source's clock went back by more than a second: it began anew
    };
    /// Statements come in the order of their arrival.
    /// @param source_time nothing: the source has no clock
    Stamp stamp(std::optional<Nanoseconds> source_time, std::int64_t received_ns);
    /// When a time of the source is in the run; nothing before the first statement that had one.
    [[nodiscard]] std::optional<GpsTime> run_time(Nanoseconds source_time) const;
    /// From here on the run is at `now` when the steady clock reads `steady_ns` (real time: after a pause).
    void set_run(GpsTime now, std::int64_t steady_ns);
    /// Seconds of the source in a second of ours, over the last five; nothing before two statements with times.
    [[nodiscard]] std::optional<double> rate() const;
    [[nodiscard]] ClockMode mode() const { return mode_; }

private:
    struct Seen {
        std::int64_t source_ns = 0, received_ns = 0;
    };
    ClockMode mode_;
    GpsTime start_;
    std::int64_t start_ns_;
    std::deque<Seen> window_;
    std::optional<std::int64_t> first_source_ns_;
    std::optional<double> offset_ns_;  // received less source, as it is used
};

}  // namespace skyloop
