#include "world/sbas/sbas_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <tuple>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime schedule_begin = to_gps_time(2243, 3600.0);

SbasTraffic egnos_traffic() { return {3, true, {3, 5, 5}, 5, false, 7}; }

// The longest time between two messages of a kind, s.
std::map<std::tuple<int, int, int>, int> longest_gaps(const SbasSchedule& schedule, int seconds) {
    std::map<std::tuple<int, int, int>, int> last, gaps;
    for (int i = 0; i < seconds; ++i) {
        const SbasSlot slot = schedule.at(schedule_begin + i * 1s);
        const std::tuple kind(slot.type, slot.band, slot.block);
        int& gap = gaps[kind];
        gap = std::max(gap, last.contains(kind) ? i - last[kind] : i);
        last[kind] = i;
    }
    for (const auto& [kind, then] : last)
        gaps[kind] = std::max(gaps[kind], seconds - then);
    return gaps;
}

// DO-229, table A-25, longest intervals; of fast corrections, which bring the bounds, that of bounds.
TEST(SbasSchedule, SendsEverythingInTime) {
    const std::map<int, int> longest{{0, 6},    {1, 120},  {2, 6},    {3, 6},   {4, 6},    {5, 6},
                                     {6, 120},  {24, 6},   {7, 120},  {9, 120}, {10, 120}, {17, 300},
                                     {18, 300}, {25, 120}, {26, 300}, {27, 300}};
    SbasTraffic most = egnos_traffic();
    most.mixed_last = false;
    most.grid_blocks = {4, 6, 6, 3};
    SbasTraffic tested = egnos_traffic();
    tested.under_test = true;
    for (const SbasTraffic& traffic : {egnos_traffic(), most, tested, SbasTraffic{}}) {
        const auto gaps = longest_gaps(SbasSchedule(traffic), 900);
        for (const auto& [kind, gap] : gaps) {
            const int type = std::get<0>(kind);
            if (type != 63) {
                EXPECT_LE(gap, longest.at(type)) << type;
            }
        }
        const auto count = [&](int type) {
            return std::ranges::count_if(gaps, [&](const auto& g) { return std::get<0>(g.first) == type; });
        };
        int blocks = 0;
        for (const int n : traffic.grid_blocks)
            blocks += n;
        EXPECT_EQ(count(26), blocks);
        EXPECT_EQ(count(18), static_cast<int>(traffic.grid_blocks.size()));
        EXPECT_EQ(count(25), traffic.long_term_messages);
        for (const int type : {1, 6, 7, 9, 10, 17, 27})
            EXPECT_EQ(count(type), 1) << type;
        EXPECT_EQ(count(0), traffic.under_test ? 1 : 0);
        EXPECT_EQ(count(2), traffic.under_test || traffic.mixed_last && traffic.fast_blocks == 1 ? 0 : 1);
        EXPECT_EQ(count(24), traffic.mixed_last ? 1 : 0);
    }
}

TEST(SbasSchedule, AnEgnosCycleTakesAMinute) {
    for (const auto& [kind, gap] : longest_gaps(SbasSchedule(egnos_traffic()), 900)) {
        const int type = std::get<0>(kind);
        const bool in_each_frame = type == 2 || type == 3 || type == 24;
        EXPECT_GE(gap, in_each_frame ? 6 : 57) << type;
        EXPECT_LE(gap, in_each_frame ? 6 : 63) << type;
    }
}

TEST(SbasSchedule, FastCorrectionsOfAFrameHaveItsNumberAndComeBeforeTheRest) {
    SbasTraffic tested = egnos_traffic();
    tested.under_test = true;
    for (const SbasTraffic& traffic : {egnos_traffic(), tested, SbasTraffic{}}) {
        const SbasSchedule schedule(traffic);
        const int from = schedule.at(schedule_begin).iodf;
        for (int i = 0; i < 300; ++i) {
            const GpsTime time = schedule_begin + i * 1s;
            EXPECT_EQ(SbasSchedule::iodf(time), (from + i / 6) % 3);
            if (i % 6 >= traffic.fast_blocks) continue;
            EXPECT_EQ(schedule.at(time).block, i % 6);
            EXPECT_EQ(schedule.at(time).iodf, SbasSchedule::iodf(time));
        }
    }
}

}  // namespace
}  // namespace skyloop
