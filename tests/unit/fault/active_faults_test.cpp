#include "run/fault/active_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/geo/local_frame.hpp"
#include "receiver_bench.hpp"
#include "run/fault/command.hpp"

namespace skyloop::fault_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

GpsTime second_of_faults(double s) { return advanced(to_gps_time(2300, 0), Seconds(s)); }

// What happens to the speed of the receiver: "9600", "back to 9600", "0" for that of before.
class SpeedsOfFaults {
public:
    void begin(std::size_t entry, double baud, double s) {
        faults_.begin(*make_fault("changed_baud", {{"baud", baud}}), {entry, 1, second_of_faults(s)});
    }
    void end(std::size_t entry, double s) { faults_.end(entry, 1, second_of_faults(s)); }
    std::vector<std::string> settled(double s) {
        std::vector<std::string> speeds;
        for (const firmware::ReceiverEvent& event : faults_.settle(second_of_faults(s))) {
            const auto& forced = std::get<firmware::ForceBaud>(event);
            speeds.push_back((forced.given_back ? "back to " : "") + std::to_string(forced.baud));
        }
        return speeds;
    }

private:
    ActiveFaults faults_;
};

TEST(ActiveFaults, LeaveTheLineAtTheSpeedOfTheYoungest) {
    SpeedsOfFaults first_ends_first;
    first_ends_first.begin(0, 9600, 10);
    first_ends_first.begin(1, 19200, 20);
    EXPECT_THAT(first_ends_first.settled(20), ElementsAre("9600", "19200"));
    first_ends_first.end(0, 30);
    EXPECT_THAT(first_ends_first.settled(30), IsEmpty());
    first_ends_first.end(1, 40);
    EXPECT_THAT(first_ends_first.settled(40), ElementsAre("0"));

    SpeedsOfFaults last_ends_first;
    last_ends_first.begin(0, 9600, 10);
    last_ends_first.begin(1, 19200, 20);
    EXPECT_THAT(last_ends_first.settled(20), ElementsAre("9600", "19200"));
    last_ends_first.end(1, 30);
    EXPECT_THAT(last_ends_first.settled(30), ElementsAre("back to 9600"));
    last_ends_first.end(0, 40);
    EXPECT_THAT(last_ends_first.settled(40), ElementsAre("0"));
}

// How high faults of 1000 m at full strength lift a receiver.
double lifted_by(ActiveFaults& faults, double s) {
    Trace trace;
    trace.truth.time = second_of_faults(s);
    trace.epoch.fix.type = FixType::fix_3d;
    static_cast<void>(faults.settle(trace.truth.time));
    faults.edit_epoch(trace);
    return trace.epoch.fix.position.height.above_ellipsoid.value();
}

TEST(ActiveFaults, WorkOnceWhileTheLastOccurrenceFades) {
    ActiveFaults faults;
    const auto begin = [&](int occurrence, double s, double ramp_in) {
        faults.begin(*make_fault("height_bias", {{"height_m", 1000.}}),
                     {0, occurrence, second_of_faults(s), Seconds(ramp_in), Seconds(4)});
    };
    begin(1, 0, 0);
    EXPECT_NEAR(lifted_by(faults, 9), 1000, 1e-6);
    faults.end(0, 1, second_of_faults(10));
    EXPECT_NEAR(lifted_by(faults, 11), 750, 1e-6);
    begin(2, 11, 0);
    for (const double s : {11., 12., 13.9, 14., 15.})
        EXPECT_NEAR(lifted_by(faults, s), 1000, 1e-6) << s;
    faults.end(0, 2, second_of_faults(20));
    begin(3, 20, 4);
    EXPECT_NEAR(lifted_by(faults, 20), 1000, 1e-6) << "what comes has not grown yet";
    EXPECT_NEAR(lifted_by(faults, 22), 500, 1e-6);
    EXPECT_NEAR(lifted_by(faults, 23), 750, 1e-6);
    faults.begin(*make_fault("height_bias", {{"height_m", 1000.}}), {1, 1, second_of_faults(24), {}, {}});
    EXPECT_NEAR(lifted_by(faults, 24), 2000, 1e-6) << "two entries are two faults";
}

// Where position_ramp of 2 m/s north, at most 30 m, has a receiver, and what it tells of its velocity.
std::array<double, 2> ramped_by(ActiveFaults& faults, double s) {
    Trace trace;
    trace.truth.time = second_of_faults(s);
    trace.epoch.fix.type = FixType::fix_3d;
    trace.epoch.fix.position = Geodetic::degrees(47, 8, 500);
    static_cast<void>(faults.settle(trace.truth.time));
    const Geodetic before = trace.epoch.fix.position;
    faults.edit_epoch(trace);
    const auto moved = LocalFrame(before).to_enu(to_ecef(trace.epoch.fix.position)).vector();
    return {moved.y(), trace.epoch.fix.velocity.north};
}

TEST(ActiveFaults, AVelocityIsTheChangeOfThePositionAlongRampsToo) {
    ActiveFaults faults;
    faults.begin(*make_fault("position_ramp", {{"north_mps", 2.0}, {"most_m", 30.0}, {"velocity_too", true}}),
                 {0, 1, second_of_faults(0), Seconds(10), Seconds(8)});
    const auto agree = [&](double s) {
        constexpr double step = 0.01;
        const double slope = (ramped_by(faults, s + step)[0] - ramped_by(faults, s - step)[0]) / (2 * step);
        EXPECT_NEAR(ramped_by(faults, s)[1], slope, 1e-3) << s;
    };
    for (const double s : {2., 5., 9., 11., 14., 16., 19.})
        agree(s);
    EXPECT_NEAR(ramped_by(faults, 5)[1], 2, 1e-9) << "twice as fast as its strength tells";
    EXPECT_EQ(ramped_by(faults, 19)[1], 0) << "at its limit";
    faults.end(0, 1, second_of_faults(20));
    for (const double s : {21., 24., 27.})
        agree(s);
    EXPECT_NEAR(ramped_by(faults, 24)[1], -30.0 / 8, 1e-9) << "back to the true place";
}

// A fault that is there or is not would stay at full strength until its ramp is over, beyond the end that is told.
TEST(RampMistakes, AreThoseOfFaultsWithoutAStrength) {
    const auto mistakes = [](std::string_view kind, const std::string& key) {
        return ramp_mistakes(*find_fault_kind(kind), Parameters({{key, 10.0}})).size();
    };
    for (const char* whole :
         {"receiver_silent", "withheld_messages", "line_break", "unplugged", "one_direction_dead", "power_cut",
          "speed_mismatch", "zero_position", "stale_position", "freeze", "wrong_fix_type", "heading_lost", "unhealthy",
          "week_rollover", "date_unknown", "changed_baud", "refuses_keys", "spoof_flapping"}) {
        EXPECT_EQ(mistakes(whole, "ramp_in_s"), 1U) << whole;
        EXPECT_EQ(mistakes(whole, "ramp_out_s"), 1U) << whole;
        EXPECT_EQ(mistakes(whole, "for_s"), 0U) << whole;
    }
    for (const char* graded : {"outage", "jamming", "position_step", "time_step", "rtk_transition", "slow_answers",
                               "byte_loss", "saturated_uart", "cycle_slips", "dropped_epochs"})
        EXPECT_EQ(mistakes(graded, "ramp_out_s"), 0U) << graded;
    const auto live = [](std::string_view kind) {
        return checked_live_fault({{"kind", std::string(kind)}, {"ramp_out_s", 5.0}}, "test");
    };
    EXPECT_TRUE(live("outage"));
    ASSERT_FALSE(live("line_break"));
    EXPECT_THAT(live("line_break").error().message, HasSubstr("'ramp_out_s' is 5, and line_break is there or is not"));
}

}  // namespace
}  // namespace skyloop::fault_test
