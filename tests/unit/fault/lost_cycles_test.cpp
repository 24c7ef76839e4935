#include "run/fault/fault_kind.hpp"

#include <gtest/gtest.h>

#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

Observations locked_epoch() {
    Observations epoch;
    Observation& o = epoch.signals.emplace_back();
    o.satellite = *parse_satellite("G07");
    o.carrier = Hertz(carrier_frequency_l1);
    o.carrier_phase = 1000;
    o.lock_time = Seconds(100);
    return epoch;
}

GpsTime lost_cycles_time(double s) { return advanced(to_gps_time(2300, 0), Seconds(s)); }

TEST(LostCycles, StayUntilTheSignalIsCountedAnew) {
    for (const bool lost_at_all : {true, false}) {
        LostCycles lost;
        Observations epoch = locked_epoch();
        lost.slip(epoch.signals[0], lost_cycles_time(0), 7, true);
        epoch = locked_epoch();
        lost.follow(epoch);
        lost.apply(epoch, lost_cycles_time(10));
        EXPECT_EQ(epoch.signals[0].carrier_phase, 1007);
        EXPECT_EQ(epoch.signals[0].lock_time, Seconds(10));
        epoch = locked_epoch();
        if (lost_at_all)
            epoch.signals.clear();
        else
            epoch.signals[0].slipped = true;
        lost.follow(epoch);
        EXPECT_TRUE(lost.empty());
    }
}

TEST(LostCycles, ThatNobodySeesLeaveTheLockTime) {
    LostCycles lost;
    Observations epoch = locked_epoch();
    lost.slip(epoch.signals[0], lost_cycles_time(0), 7, false);
    lost.apply(epoch, lost_cycles_time(0));
    EXPECT_EQ(epoch.signals[0].carrier_phase, 1007);
    EXPECT_EQ(epoch.signals[0].lock_time, Seconds(100)) << "it goes on";
}

}  // namespace
}  // namespace skyloop
