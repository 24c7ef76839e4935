// Whose satellites tell the leap seconds, and when, after a cold start.
#include <gtest/gtest.h>

#include <utility>

#include "firmware/core/state_tracker.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum Constellation;

// A receiver with one epoch a second, which knows nothing; it hears satellites from the first epoch on.
struct ColdReceiver {
    explicit ColdReceiver(std::vector<Constellation> systems)
        : board(sample_board(NmeaVersion::v4_10, std::move(systems))) {
        board.timing.cold_start = Seconds(26);
        for (const Constellation system : board.constellations)
            add_satellites(fix, system, 6, 8);
        start(Forgotten::by_mask(0xFFFF));
    }
    void start(const Forgotten& forgotten) { tracker.start(fix.time, forgotten); }
    const TimeKnowledge& step(int epochs = 1) {
        for (int i = 1; i < epochs; ++i)
            update();
        return update();
    }
    const TimeKnowledge& update() {
        fix.time += 1s;
        return tracker.update(Epoch{fix}, receiver_config(store, board), {}).time;
    }

    BoardProfile board;
    ConfigStore store{factory_config(board)};
    StateTracker tracker{board};
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
};

// GLONASS counts UTC itself, within a frame of 30 s; page 10 of BeiDou's subframe 5 ends 314 s into each 720 s of GPST,
// and 12:00:18 lies 18 s into them.
TEST(LeapSecondsOfAStart, ComeOfGlonassAndBeidouToo) {
    for (const auto& [system, expected_s] : {std::pair{glonass, 31}, std::pair{beidou, 296}}) {
        ColdReceiver r({system});
        EXPECT_FALSE(r.step(expected_s - 1).leap_seconds) << expected_s;
        EXPECT_TRUE(r.step().leap_seconds) << expected_s;
        EXPECT_EQ(r.step().leap_source, system);
        r.start({});
        EXPECT_EQ(r.step().leap_source, system) << "stored with the number";
        r.start(Forgotten::by_mask(0xFFFF));
        EXPECT_FALSE(r.step().leap_source);
    }
}

// The last cycle of 12.5 min of GPS's week is cut after 300 s and has no page 18. From 23:59:18 GPST on a Saturday, the
// first one ends 534 s into the next week.
TEST(LeapSecondsOfAStart, DoNotComeWithTheTurnOfAWeek) {
    ColdReceiver r({gps});
    r.fix.time = to_gps_time(UtcTime{2024, 3, 9, 23, 59, 0}, LeapSeconds::announced());
    r.start(Forgotten::by_mask(0xFFFF));
    EXPECT_FALSE(r.step(42 + 533).leap_seconds);
    EXPECT_TRUE(r.step().leap_seconds);
}

TEST(LeapSecondsOfAStart, AreCountedFromTheirOwnSystem) {
    ColdReceiver r({gps, galileo});
    const std::vector<SatelliteStatus> both = r.fix.satellites;
    std::erase_if(r.fix.satellites, [](const auto& s) { return s.id.constellation == galileo; });
    r.step(100);
    r.fix.satellites = both;
    EXPECT_FALSE(r.step(30).leap_seconds) << "GPS was heard for longer, but not Galileo";
    EXPECT_EQ(r.step().leap_source, galileo);
    EXPECT_EQ(r.step(400).leap_source, gps) << "its page has come";
}

}  // namespace
}  // namespace skyloop::firmware
