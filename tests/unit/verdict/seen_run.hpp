/// A run made by hand, as a judge sees it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "run/verdict/expectation.hpp"
#include "run/verdict/judge.hpp"

namespace skyloop::test {

inline constexpr auto passed = Outcome::passed, failed = Outcome::failed, undecided = Outcome::undecided;

inline constexpr GpsTime run_start{std::chrono::seconds(1'400'000'000)};

inline GpsTime at_second(double second) { return advanced(run_start, Seconds(second)); }

inline Expectation expectation_of(std::string_view what, std::string receiver = "") {
    Expectation expectation;
    expectation.what = what;
    expectation.receiver = std::move(receiver);
    const auto sentence = parse_expectation(what);
    EXPECT_TRUE(sentence) << what << ": " << sentence.error().sentence;
    if (sentence) expectation.sentence = *sentence;
    return expectation;
}

/// What a receiver reports at an epoch.
struct SeenFix {
    FixType type = FixType::fix_3d;
    double east_error_m = 0, up_error_m = 0, speed_error_mps = 0, h_acc_m = 3;
    int satellites = 8;
    double cn0 = 45;
    int jamming = 1;
    SpoofingIndication spoofing = SpoofingIndication::none;
    bool valid = true;
    bool told = true;  ///< its messages leave
    bool jamming_hidden = false, jamming_told_elsewhere = false;
};

/// Tells a judge of one sentence what happens; times are seconds of the run.
class SeenRun {
public:
    explicit SeenRun(std::string_view what) : SeenRun({expectation_of(what)}, {"receiver0"}) {}
    SeenRun(std::vector<Expectation> expectations, std::vector<std::string> receivers)
        : judge_(std::move(expectations), JudgedRun{run_start, std::move(receivers)}) {}

    SeenRun& epoch(double second, const SeenFix& fix = {}, std::size_t station = 0) {
        Trace trace;
        trace.truth.geodetic = Geodetic::degrees(47, 8, 500);
        trace.truth.position = to_ecef(trace.truth.geodetic);
        firmware::NavigationState state;
        state.fix_ok = fix.valid;
        state.monitors.upper.jamming_state = fix.jamming;
        state.monitors.jamming_hidden = fix.jamming_hidden;
        state.monitors.told_elsewhere = fix.jamming_told_elsewhere;
        state.monitors.spoofing = fix.spoofing;
        Fix& reported = state.epoch.fix;
        reported.type = fix.type;
        reported.position =
            to_geodetic(LocalFrame(trace.truth.geodetic).to_ecef(Position<Enu>(fix.east_error_m, 0, fix.up_error_m)));
        reported.velocity.north = fix.speed_error_mps;
        reported.horizontal_accuracy = Metres(fix.h_acc_m);
        reported.vertical_accuracy = Metres(2 * fix.h_acc_m);
        reported.dop = {.pdop = 2, .hdop = 1.2, .vdop = 1.6};
        for (int i = 1; i <= fix.satellites; ++i) {
            SatelliteStatus status{{Constellation::gps, i}, {}, {}, DbHz(fix.cn0 + i)};
            status.used = true;
            reported.satellites.push_back(status);
        }
        const auto leaves = fix.told ? std::optional(at_second(second + 0.05)) : std::nullopt;
        judge_.on_epoch({at_second(second), station, trace, state, Nanoseconds{0}, leaves});
        return *this;
    }
    /// An epoch a second, from `first` to `last`.
    SeenRun& epochs(int first, int last, const SeenFix& fix = {}) {
        for (int second = first; second <= last; ++second)
            epoch(second, fix);
        return *this;
    }
    SeenRun& client(double second, std::string_view name, std::size_t payload = 4, std::size_t station = 0) {
        return message(second, name, payload, station, true);
    }
    SeenRun& receiver(double second, std::string_view name) { return message(second, name, 4, 0, false); }
    SeenRun& command_line(double second, std::string_view name) {
        const Bytes bytes(3);
        judge_.on_message({at_second(second), 0, 0, true, StreamKind::command, name, bytes});
        return *this;
    }
    SeenRun& noise(double second) {
        const Bytes bytes(3);
        judge_.on_message({at_second(second), 0, 0, true, StreamKind::noise, "noise", bytes});
        return *this;
    }
    SeenRun& begins(double second, std::string_view name, int occurrence = 1, std::string_view kind = "outage") {
        judge_.on_fault({at_second(second), name, kind, occurrence, true});
        return *this;
    }
    SeenRun& ends(double second, std::string_view name, int occurrence = 1, std::string_view kind = "outage") {
        judge_.on_fault({at_second(second), name, kind, occurrence, false});
        return *this;
    }
    SeenRun& command(double second, std::string_view name, CommandVerb verb) {
        Command command;
        command.verb = verb;
        judge_.on_command({at_second(second), name, command});
        return *this;
    }
    SeenRun& belief(double second, bool trusts) {
        judge_.on_belief({at_second(second), 0, 0, trusts, trusts ? "3d fix" : "no message for 2.0 s"});
        return *this;
    }
    /// What is known of the only expectation so far.
    [[nodiscard]] Verdict so_far() const { return judge_.so_far().at(0); }
    Verdict end(double second) { return judge_.finish(at_second(second)).front(); }
    /// The run was to last longer.
    Verdict cut(double second) { return judge_.finish(at_second(second), RunEnd::cut).front(); }
    Judge& judge() { return judge_; }

private:
    SeenRun& message(double second, std::string_view name, std::size_t payload, std::size_t station, bool client) {
        const Bytes bytes(payload + 8);
        const bool nmea =
            name.find(',') != std::string_view::npos || name.starts_with("PMTK") || name.starts_with("PAIR");
        judge_.on_message(
            {at_second(second), station, 0, client, nmea ? StreamKind::nmea : StreamKind::ubx, name, bytes});
        return *this;
    }
    Judge judge_;
};

inline const SeenFix no_fix{FixType::none, 0, 0, 0, 3, 0, 45, 1, SpoofingIndication::none, false};

}  // namespace skyloop::test
