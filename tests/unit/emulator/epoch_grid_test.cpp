// When epochs are, also after a client has changed their period.
#include "run/emulator/timing.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime grid_origin = to_gps_time(2400, 100);

TEST(EpochGrid, StandsOnMultiplesOfThePeriod) {
    EpochGrid grid;
    grid.start(grid_origin + 1ns, 250ms);
    EXPECT_EQ(grid.next(), grid_origin + 250ms);
    grid.pass();
    EXPECT_EQ(grid.next(), grid_origin + 500ms);
    grid.start(grid_origin, 250ms);
    EXPECT_EQ(grid.next(), grid_origin) << "the start itself, when it lies on the grid";
}

TEST(EpochGrid, AQuickerPeriodDoesNotWaitForTheOldEpoch) {
    EpochGrid grid;
    grid.start(grid_origin, 60s);
    EXPECT_EQ(grid.next(), grid_origin + 20s) << "of week second 120";
    grid.follow(grid_origin + 3050ms, 100ms);
    EXPECT_EQ(grid.next(), grid_origin + 3100ms);
}

TEST(EpochGrid, ASlowerPeriodLeavesOutEpochsOfTheOldGrid) {
    EpochGrid grid;
    grid.start(grid_origin, 100ms);
    grid.pass();
    grid.follow(grid_origin + 50ms, 1s);
    EXPECT_EQ(grid.next(), grid_origin + 1s);
}

TEST(EpochGrid, NoEpochComesTwice) {
    EpochGrid grid;
    grid.start(grid_origin, 1s);
    grid.pass();
    grid.follow(grid_origin, 200ms);
    EXPECT_EQ(grid.next(), grid_origin + 200ms) << "that of the change has been had";
}

TEST(EpochGrid, TheEpochOfTheChangeItselfMayBeOfTheNewGrid) {
    EpochGrid grid;
    grid.start(grid_origin, 1s);
    grid.follow(grid_origin, 200ms);
    EXPECT_EQ(grid.next(), grid_origin);
}

TEST(EpochGrid, TheSamePeriodChangesNothing) {
    EpochGrid grid;
    grid.start(grid_origin, 1s);
    grid.pass();
    const GpsTime next = grid.next();
    grid.follow(grid_origin + 300ms, 1s);
    EXPECT_EQ(grid.next(), next);
}

TEST(EpochGrid, APeriodOfNothingDoesNotStandStill) {
    EpochGrid grid;
    grid.start(grid_origin, 0ns);
    grid.pass();
    EXPECT_EQ(grid.next(), grid_origin + 1ms);
}

}  // namespace
}  // namespace skyloop
